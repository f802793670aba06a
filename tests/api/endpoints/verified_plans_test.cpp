// What POST /v1/plan returns as verified is valid for POST /v1/validate, also in extreme but accepted
// requests. Its result can be planned from again.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "core/verify/check_rules.h"
#include "tests/api/support/requests.h"
#include "tests/support/random_problem.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

double power_between(Dice& dice, double least, double most) {
  return least * std::pow(most / least, dice.between(0.0, 1.0));
}

template <class T>
T one_of(Dice& dice, const std::vector<T>& values) {
  return values[static_cast<std::size_t>(dice.below(static_cast<int>(values.size())))];
}

/// Up to five robots of any speeds on a small map of any scale, anywhere in the world.
Json random_small_request(Dice& dice) {
  const double resolution = one_of(dice, std::vector<double>{0.001, 0.05, 0.5, 1.0, 1e3, 1e5});
  const double x = one_of(dice, std::vector<double>{0.0, -7.5, 691'234.567, 9e8});
  const double y = one_of(dice, std::vector<double>{0.0, 5'334'999.789, -9e8});
  Json request;
  std::vector<std::string> rows(8, std::string(10, '.'));
  for (int k = dice.below(12); k > 0; --k) {
    rows[static_cast<std::size_t>(dice.below(8))][static_cast<std::size_t>(dice.below(10))] = '#';
  }
  request["map"] = {{"rows", rows}, {"resolution", resolution}, {"origin", {{"x", x}, {"y", y}}}};
  request["options"] = {{"seed", dice.below(100)}, {"max_iterations", 3}};
  if (dice.chance(0.2)) request["options"]["start_safe_interval"] = power_between(dice, 1.0, 1e8);
  if (dice.chance(0.2)) request["options"]["wait_before_move"] = power_between(dice, 1e-3, 1e6);
  if (dice.chance(0.2)) request["options"]["mode"] = "anytime";
  const auto place = [&] {
    const auto cell = [&](double origin, int count) {
      return origin + (dice.below(count) + 0.5) * resolution;
    };
    Json pose = {{"x", cell(x, 10)}, {"y", cell(y, 8)}};
    if (dice.chance(0.5)) pose["theta"] = dice.between(-3.0, 3.0);
    return pose;
  };
  const bool extreme = dice.chance(0.7);
  request["robots"] = Json::array();
  for (int k = 1 + dice.below(5); k > 0; --k) {
    Json robot = {{"id", std::to_string(k)},
                  {"radius", resolution * one_of(dice, std::vector<double>{0.5, 0.3})}};
    robot["linear_speed"] = extreme ? power_between(dice, 1e-3, 1e3) : 1.0;
    robot["angular_speed"] = extreme ? power_between(dice, 1e-3, 1e6) : 3.0;
    robot["start"] = place();
    if (dice.chance(0.9)) robot["goal"] = place();
    request["robots"].push_back(robot);
  }
  return request;
}

class VerifiedPlans : public testing::TestWithParam<int> {};

TEST_P(VerifiedPlans, AreValidAtTheDefaultTolerance) {
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (int k = 0; k < 10;) {
    Json request = random_small_request(dice);
    if (!brief_faults_of(request).empty()) continue;  // starts in walls or on each other
    ++k;
    SCOPED_TRACE(request.dump());
    const Reply reply = plan_endpoint(request.dump(), {});
    ASSERT_EQ(reply.status, 200) << reply.body;
    Json answer = json_of(reply);
    EXPECT_EQ(answer["verified"], true);
    request.update(answer);
    const Reply verdict = validate_endpoint(request.dump(), {});
    ASSERT_EQ(verdict.status, 200) << verdict.body;
    EXPECT_EQ(json_of(verdict)["violations"], Json::array());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, VerifiedPlans, testing::Range(0, 40));

TEST(Tolerances, DoNotDependOnTheSpeedOfOtherRobots) {
  // The checker itself: an overlap of a micrometre is a violation, however fast another robot turns.
  Json request = Json::parse(R"({"map": {"rows": ["......", "......"]},
    "robot_defaults": {"radius": 0.4, "linear_speed": 0.001, "angular_speed": 1e6},
    "robots": [{"id": "slow", "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 5.5, "y": 0.5}},
               {"id": "fast", "linear_speed": 1000, "start": {"x": 1.5, "y": 1.5}, "goal": {"x": 4.5, "y": 1.5}}]})");
  const core::Problem problem = std::move(parse_request(request.dump(), {}, unbounded_work())->problem);
  std::vector<core::RobotPlan> plans{{0, 5000.0, {}, 0.0}, {1, 5000.0, {}, 0.0}};
  for (const core::Tolerance& tolerance : core::plan_tolerances(problem.grid(), problem.robots(), plans)) {
    EXPECT_LE(tolerance.metres, core::kMaxTolerance);
    EXPECT_LE(tolerance.radians, 1e-8);
    EXPECT_LE(tolerance.seconds, 1e-8);
  }
}

/// Two robots in an aisle, as an earlier plan left them: their disks overlap by 5.0e-10 m.
Json contact_request() {
  return Json::parse(R"({
    "map": {"rows": ["....................", "....................", "....................", "....................",
                     "....................", "...................."], "resolution": 0.5},
    "robot_defaults": {"radius": 0.2, "linear_speed": 1.5, "angular_speed": 3.141592653589793},
    "robots": [
      {"id": "a", "start": {"x": 4.393505230245237, "y": 1.89123692438691, "theta": -1.1902899496825317},
       "goal": {"x": 4.25, "y": 0.25}},
      {"id": "b", "start": {"x": 4.352669257817222, "y": 1.493326855456946, "theta": -1.1902899496825317},
       "goal": {"x": 7.75, "y": 0.75}}]})");
}

TEST(Contact, OfAnEarlierPlanCanBeLeft) {
  const Json request = contact_request();
  const double distance =
      std::hypot(4.393505230245237 - 4.352669257817222, 1.89123692438691 - 1.493326855456946);
  ASSERT_LT(distance - 0.4, -4.9e-10);
  EXPECT_EQ(json_of(plan_endpoint(request.dump(), {}))["status"], "solved");
}

TEST(Contact, OfAnEarlierPlanCanBeLeftInWorldCoordinates) {
  for (const double origin : {5e6, 9e7, 9e8}) {
    Json request = contact_request();
    request["map"]["origin"] = {{"x", origin}, {"y", origin}};
    for (Json& robot : request["robots"]) {
      for (const char* pose : {"start", "goal"}) {
        for (const char* axis : {"x", "y"}) robot[pose][axis] = robot[pose][axis].get<double>() + origin;
      }
    }
    const Json answer = json_of(plan_endpoint(request.dump(), {}));
    EXPECT_EQ(answer["status"], "solved") << answer.dump();
  }
}

TEST(Contact, WithAWallAndAtAGoalCanBeLeftAndReached) {
  Json request = contact_request();
  request["robots"][0]["start"] = {{"x", 0.2 - 4e-7}, {"y", 0.2 - 4e-7}};
  request["robots"][1]["goal"] = {{"x", 10.0 - 0.2 + 4e-7}, {"y", 0.2 - 3e-7}};
  request["robots"][0]["goal"] = {{"x", 9.4 + 3e-7}, {"y", 0.2}};
  const Json answer = json_of(plan_endpoint(request.dump(), {}));
  EXPECT_EQ(answer["status"], "solved") << answer.dump();
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
