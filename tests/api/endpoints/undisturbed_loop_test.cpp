// Fleets that nothing disturbs, planned again and again: every robot does exactly what is planned. Wherever
// commitments end, all robots may stop there by their own brakes. The next plan has nothing unavoidable, and
// leaves no robot out because of commitments of others.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "api/request/parse_request.h"
#include "core/geometry/tolerance.h"
#include "core/verify/verify.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/expect_actions.h"
#include "tests/api/support/fleet_json.h"
#include "tests/api/support/lives.h"
#include "tests/support/sanitized.h"
#include "tests/support/summary.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

/// Many robots that need some way to stop, on a small field with a few walls, with far goals.
Json dense_fleet(Dice& dice) {
  const int columns = 9 + dice.below(5);
  const int rows = 8 + dice.below(4);
  core::OccupancyGrid grid(columns, rows, 1.0);
  for (int walls = dice.below(8); walls > 0; --walls) grid.block({dice.below(columns), dice.below(rows)});
  std::vector<core::Position> places;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      if (!grid.blocked({column, row})) places.push_back(grid.center({column, row}));
    }
  }
  const auto take = [&] {
    const auto index = static_cast<std::size_t>(dice.below(static_cast<int>(places.size())));
    const core::Position place = places[index];
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(index));
    return place;
  };
  Json request{{"map", json_of(grid)}, {"options", {{"time_budget_ms", 100'000}}}};
  const double inflation = dice.chance(0.3) ? dice.between(0.0, 0.1) : 0.0;
  request["options"]["inflation"] = inflation;
  if (dice.chance(0.5)) request["options"]["horizon"] = dice.between(8.0, 20.0);
  if (dice.chance(0.3)) request["options"]["replan"] = "where_needed";
  for (int k = 8 + dice.below(10); k > 0; --k) {
    Json robot{{"id", "r" + std::to_string(k)}, {"radius", dice.between(0.25, 0.49) - inflation}};
    robot["linear_speed"] = dice.between(0.6, 1.5);
    robot["angular_speed"] = dice.between(1.0, 3.0);
    if (dice.chance(0.85)) robot["linear_acceleration"] = dice.between(0.2, 1.5);
    if (robot.contains("linear_acceleration") && dice.chance(0.3))
      robot["linear_deceleration"] = dice.between(0.2, 1.5);
    if (dice.chance(0.3)) robot["angular_acceleration"] = dice.between(0.5, 4.0);
    robot["start"] = json_of(core::Pose{take(), dice.between(-3.0, 3.0)});
    robot["goals"] = Json::array();
    if (dice.chance(0.4)) robot["goals"].push_back(json_of(core::Goal{take(), {}, dice.between(0.0, 3.0)}));
    robot["goals"].push_back(json_of(core::Goal{take(), {}}));
    request["robots"].push_back(std::move(robot));
  }
  return request;
}

/// Of every length; also to where an action of the first plan, or a phase of one, ends.
Json random_commit(Dice& dice, const Json& answer, double at) {
  switch (dice.below(6)) {
    case 0:
      return 0.0;
    case 1:
      return std::pow(10.0, dice.between(-12.0, -3.0));
    case 2:
      return 0.5;
    case 3:
      return dice.between(0.0, 6.0);
    case 4:
      return nullptr;  // the action under way
    default:
      break;
  }
  for (const Json& plan : answer.at("plans")) {
    for (const Json& action : plan.at("actions")) {
      if (action.at("t_end") > at && dice.chance(0.3)) return action.at("t_end").get<double>() - at;
    }
  }
  return 0.5;
}

/// All robots do what is committed, and then stand, by the independent check.
void expect_that_all_may_stop(const Json& request) {
  const auto parsed = parse_request(request.dump(), {}, unbounded_work());
  ASSERT_TRUE(parsed) << parsed.failure().detail << request;
  const std::vector<core::Robot>& robots = parsed->problem.robots();
  std::vector<core::RobotPlan> stops;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (!robots[k].committed.empty()) stops.push_back({k, robots[k].committed_until(), robots[k].committed});
  }
  core::CheckRules rules;
  rules.tolerances.assign(robots.size(), core::Tolerance::of_all(core::kMaxTolerance));
  rules.horizon = 0.0;
  const auto report =
      core::verify({parsed->problem.grid(), robots, {}}, stops, rules, core::StopCondition::never());
  EXPECT_TRUE(report->violations.empty()) << support::text(*report) << request;
}

/// A robot that needs time to stop has a profile wherever it translates, and stands in the end. Its start has
/// the speed with which it begins.
void expect_that_they_brake(const Json& request) {
  for (const Json& robot : request.at("robots")) {
    const Json committed = robot.value("committed", Json::array());
    if (!robot.contains("linear_acceleration") || committed.empty()) continue;
    double speed = 0.0;
    for (const Json& action : committed) {
      if (action.at("type") != "translate") continue;
      ASSERT_TRUE(action.contains("profile")) << robot;
      speed = action.at("profile").at("end");
    }
    EXPECT_EQ(speed, 0.0) << robot;
    const Json& first = committed.front();
    const double begins = first.at("type") == "translate" ? first.at("profile").value("start", 0.0) : 0.0;
    EXPECT_EQ(robot.at("start").value("speed", 0.0), begins) << robot;
  }
}

void expect_that_nobody_is_left_out(const Json& answer, const Json& request) {
  EXPECT_EQ(answer.value("unavoidable", Json::array()), Json::array()) << request;
  for (const Json& robot : answer.at("unplanned")) {
    EXPECT_NE(robot.at("reason"), "committed_in_the_way") << request;
  }
}

TEST(UndisturbedLoops, NeverMeetWhatTheyCannotAvoid) {
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t lives = from_environment("FLEETPLAN_LIVES", support::kSanitized ? 8 : 40);
  for (std::uint64_t seed = first; seed < first + lives; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    Json request = dense_fleet(dice);
    for (int round = 0; round < 5; ++round) {
      const Reply reply = planned_in(3'000, request);
      ASSERT_EQ(reply.status, 200) << reply.body << request;
      const Json answer = json_of(reply);
      expect_that_nobody_is_left_out(answer, request);
      const double makespan = answer.at("makespan");
      const double at = dice.chance(0.2) ? 0.0 : dice.between(0.0, std::clamp(0.5 * makespan, 0.1, 8.0));
      Json more = Json::object();
      const Json commit = random_commit(dice, answer, at);
      if (!commit.is_null()) more["commit"] = commit;
      const Json before = request;
      request = advanced(request, answer, at, more);
      SCOPED_TRACE(testing::Message() << "at " << at << ", " << more << " of " << before << answer);
      EXPECT_EQ(request.value("unavoidable", Json::array()), Json::array());
      expect_that_all_may_stop(request);
      expect_that_they_brake(request);
      for (const Json& robot : request.at("robots")) {
        expect_no_small_actions(robot.value("committed", Json::array()));
        expect_no_small_actions(robot.value("previous", Json::array()));
      }
      if (testing::Test::HasFailure()) return;
    }
  }
}

/// One robot along a hall, with or without an acceleration.
Json hall(bool has_inertia) {
  Json request = Json::parse(R"({
    "map": {"rows": ["..............", "..............", ".............."]},
    "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.57},
    "robots": [{"id": "a", "start": {"x": 0.5, "y": 1.5}, "goal": {"x": 13.5, "y": 1.5}}]})");
  if (has_inertia) request["robot_defaults"]["linear_acceleration"] = 0.5;
  return request;
}

/// The robot's place and speed at a time of its only action.
struct Under {
  double x;
  double speed;
};

Under under_way_in_hall(bool has_inertia, double t) {
  if (!has_inertia) return {0.5 + t, 1.0};
  return t < 2.0 ? Under{0.5 + 0.25 * t * t, 0.5 * t} : Under{0.5 + t - 1.0, 1.0};
}

TEST(Obstacles, EndCommitmentsWhereTheRobotCanStopAtLast) {
  for (const bool has_inertia : {false, true}) {
    for (const double at : {0.5, 1.5, 3.0, 5.0}) {
      for (const double ahead : {0.75, 1.2, 1.71, 2.5, 4.0}) {
        SCOPED_TRACE(testing::Message() << has_inertia << " at " << at << ", ahead " << ahead);
        const auto [x, speed] = under_way_in_hall(has_inertia, at);
        Json request = hall(has_inertia);
        const Json answer = plan_of(request);
        Json pallet{{"id", "pallet"}, {"radius", 0.3}, {"after", "stays"}};
        pallet["motion"].push_back({{"t", at}, {"x", x + ahead}, {"y", 1.5}});
        request["obstacles"].push_back(pallet);
        const Json next = advanced(request, answer, at);
        const Json& robot = next["robots"][0];
        const double needs = has_inertia ? speed * speed : 0.0;  // metres to stop
        const Json committed = robot.value("committed", Json::array());
        const double end = committed.empty() ? x : committed.back()["to"]["x"].get<double>();
        EXPECT_NEAR(end - x, std::max(needs, ahead - 0.7), 1e-6);
        const Json plan = plan_of(next);
        EXPECT_EQ(plan.contains("unavoidable"), needs > ahead - 0.7 + 1e-6) << plan;
      }
    }
  }
}

/// Somebody crosses the way. Where the robot drives until it stands, it does not touch them.
TEST(Obstacles, ThatCrossTheWayAreNotTouchedBeforeARobotStands) {
  Dice dice(1);
  int cut = 0;
  for (int run = 0; run < 200; ++run) {
    SCOPED_TRACE(run);
    const bool has_inertia = dice.chance(0.7);
    Json request = hall(has_inertia);
    const Json answer = plan_of(request);
    const double at = dice.between(0.0, 8.0);
    const Under now = under_way_in_hall(has_inertia, at);
    const double x = now.x + 0.71 + dice.between(0.0, 5.0);
    const double begin = at + dice.between(0.0, 3.0);
    const double end = begin + dice.between(1.0, 8.0);
    Json person{{"id", "person"}, {"radius", 0.3}};
    person["motion"].push_back({{"t", begin}, {"x", x}, {"y", 0.0}});
    person["motion"].push_back({{"t", end}, {"x", x}, {"y", 3.0}});
    request["obstacles"].push_back(person);
    Json more = Json::object();
    if (dice.chance(0.5)) more["commit"] = dice.between(0.0, 6.0);
    const Json committed = advanced(request, answer, at, more)["robots"][0].value("committed", Json::array());
    if (committed.empty()) continue;
    ++cut;
    const double stands = committed.back()["t_end"];
    const double first_stop = has_inertia ? 2.0 * now.speed : 0.0;  // seconds
    if (stands < first_stop + 1e-6) continue;
    for (double t = 0.0; t < stands; t += 1e-3) {
      const double there = (t + at - begin) / (end - begin) * 3.0;
      if (there < 0.0 || there > 3.0) continue;
      double mine = 0.0;
      for (const Json& action : committed) {
        const core::Action one{core::Action::Type::translate, action["t_start"], action["t_end"],
                               pose_of(action["from"]), pose_of(action["to"])};
        core::Action timed = one;
        if (action.contains("profile")) {
          const Json& profile = action["profile"];
          timed.profile = core::SpeedProfile{profile["start"], profile["cruise"], profile["end"], {2.0, 2.0}};
        }
        if (t < one.t_start || t > one.t_end) continue;
        mine =
            one.from.position.x() + core::share_at(timed, t) * (one.to.position.x() - one.from.position.x());
      }
      EXPECT_GE(std::hypot(mine - x, there - 1.5), 0.7 - 1e-5) << t << committed;
    }
  }
  EXPECT_GT(cut, 50);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
