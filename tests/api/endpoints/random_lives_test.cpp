// Random lives of fleets: plan, go on to a random moment in which robots are held, late or beside their
// paths, and plan again, with all members of requests together. Whatever happens, no request is answered by
// `internal_error`, and /v1/plan accepts what /v1/advance returns.
//
// FLEETPLAN_ROUNDS is how often they are planned in all, FLEETPLAN_FIRST_LIFE the seed of the first fleet.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "core/planner.h"
#include "tests/api/support/fleet_json.h"
#include "tests/support/step_limit.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

constexpr int kRoundsOfALife = 5;
/// So many steps may the checks of previous plans outlast the budget.
constexpr std::int64_t kPatience = 100'000;

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

std::vector<core::Zone> zones_for(Dice& dice, const core::Problem& problem) {
  using Type = core::Zone::Type;
  std::vector<core::Zone> zones =
      support::random_zones(dice, problem, {Type::blocked, Type::one_way, Type::speed});
  for (core::Zone& zone : zones) {  // a request has a limit in each, and shares in masks only
    zone.linear_speed_share = core::Zone::kNoLimit;
    const bool has_any = std::min(zone.linear_speed, zone.angular_speed) < core::Zone::kNoLimit;
    if (zone.type == Type::speed && !has_any) zone.angular_speed = 1.0;
  }
  return zones;
}

/// A valid request with all kinds of members.
Json first_request(Dice& dice) {
  while (true) {
    support::FleetRequest request = support::random_request(dice);
    if (dice.chance(0.5)) support::add_loads(dice, request);
    const auto plain = support::problem_of(request);
    if (!plain) continue;
    if (dice.chance(0.4)) request.zones = zones_for(dice, *plain);
    if (dice.chance(0.3)) request.options.horizon = dice.between(1.0, 30.0);
    if (!support::problem_of(request)) continue;
    Json json = json_of(request);
    json["options"]["time_budget_ms"] = 100'000;
    if (dice.chance(0.3)) json["options"]["invalid_robots"] = "report";
    if (dice.chance(0.2)) json["options"]["dependencies"] = true;
    return json;
  }
}

/// The answer of POST /v1/plan if planning, but neither reading nor the check, is ended after so many steps.
Reply planned_in(std::int64_t steps, const Json& request) {
  core::CallerThread executor;
  const Planner planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                              const core::StopCondition& stop, core::Observer* observer) {
    const support::StepLimit limit(steps, kPatience);
    return core::plan(problem, options, stop, executor, observer);
  };
  return plan_with(planner, request.dump(), {});
}

core::Pose pose_of(const Json& pose) {
  const auto number = [&](const char* key) { return pose.at(key).get<double>(); };
  return {core::Position(number("x"), number("y")), number("theta")};
}

/// Where a plan has its robot at a time; none before and after its actions.
std::optional<core::Pose> pose_at(const Json& plan, double t) {
  for (const Json& action : plan.at("actions")) {
    const core::Action one{core::Action::Type::translate, action.at("t_start"), action.at("t_end"),
                           pose_of(action.at("from")), pose_of(action.at("to"))};
    if (one.t_start <= t && t < one.t_end) return support::pose_within(one, t);
  }
  return std::nullopt;
}

/// A fleet from round to round.
class Life {
 public:
  explicit Life(Dice& dice) : dice_(dice), first_(first_request(dice)), request_(first_) {}

  /// Returns false when it has ended.
  bool go_on() {
    if (!plan()) return false;
    const double makespan = answer_.at("makespan");
    return advance(dice_.between(0.0, std::max(1.0, 0.6 * makespan)));
  }

 private:
  bool plan() {
    constexpr std::int64_t kPlenty = 5'000;
    const std::int64_t steps = dice_.chance(0.3) ? dice_.below(2000) : kPlenty;
    const Reply reply = planned_in(steps, request_);
    if (reply.status != 200 && may_be_refused(reply)) return false;
    EXPECT_EQ(reply.status, 200) << steps << " steps: " << reply.body << "\n" << came_from_ << request_;
    if (reply.status != 200) return false;
    answer_ = Json::parse(reply.body);
    EXPECT_EQ(answer_.at("verified"), true);
    return true;
  }

  /// Robots that were measured elsewhere may be in others, or in walls.
  bool may_be_refused(const Reply& reply) const {
    if (reply.status != 422 || !has_measured_) return false;
    const Json problem = Json::parse(reply.body);
    return std::all_of(problem.at("errors").begin(), problem.at("errors").end(), [](const Json& fault) {
      const Json& code = fault.at("code");
      return code == "starts_overlap" || code == "start_in_obstacle" || code == "committed_collision";
    });
  }

  bool advance(double at) {
    Json body{{"request", request_}, {"plans", answer_.at("plans")}, {"at", at}};
    if (dice_.chance(0.5)) body["commit"] = dice_.between(0.0, 6.0);
    body["pose_tolerance"] = 0.1 * request_.at("map").at("resolution").get<double>();
    has_measured_ = false;
    const bool measures = dice_.chance(0.4);
    for (const Json& plan : answer_.at("plans")) {
      if (dice_.chance(0.15)) {
        body["holds"].push_back({{"robot", plan.at("robot")}, {"until", dice_.between(0.0, 20.0)}});
      }
      if (dice_.chance(0.1)) start_anew(body, plan.at("robot"));
      if (measures && dice_.chance(0.3)) measure(body, plan);
    }
    const std::string text = body.dump();
    const Reply reply = advance_endpoint(text, {});
    EXPECT_EQ(reply.status, 200) << reply.body << "\n" << text;
    if (reply.status == 200) request_ = Json::parse(reply.body);
    came_from_ = "advanced from " + text + "\nto ";
    return reply.status == 200;
  }

  /// A robot that keeps its radius begins again with its first goal.
  void start_anew(Json& body, const Json& robot) const {
    for (const Json& one : first_.at("robots")) {
      if (one.at("id") != robot || !one.contains("goals")) continue;
      const auto keeps_radius = [](const Json& goal) { return !goal.contains("radius_after"); };
      if (!std::all_of(one.at("goals").begin(), one.at("goals").end(), keeps_radius)) return;
      body["goals"].push_back({{"robot", robot}, {"goals", one.at("goals")}});
    }
  }

  /// The robot is late, or beside its path, or both.
  void measure(Json& body, const Json& plan) {
    const double late = dice_.chance(0.7) ? dice_.between(0.0, 3.0) : 0.0;
    auto pose = pose_at(plan, std::max(0.0, body.at("at").get<double>() - late));
    if (!pose) return;
    if (dice_.chance(0.5)) {
      const double off = 1.2 * body.at("pose_tolerance").get<double>();
      const double direction = dice_.between(-std::numbers::pi, std::numbers::pi);
      pose->position += dice_.between(0.0, off) * core::Position(std::cos(direction), std::sin(direction));
      pose->theta = core::normalize_angle(pose->theta + dice_.between(-off, off));
    }
    Json measured = json_of(*pose);
    measured["robot"] = plan.at("robot");
    body["poses"].push_back(std::move(measured));
    has_measured_ = true;
  }

  Dice& dice_;
  const Json first_;
  Json request_;
  Json answer_;
  std::string came_from_;
  bool has_measured_ = false;
};

TEST(RandomLives, NeverMeetAnInternalErrorAndGoOnFromAnyMoment) {
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t rounds = from_environment("FLEETPLAN_ROUNDS", 300);
  std::uint64_t done = 0;
  for (std::uint64_t seed = first; done < rounds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    Life life(dice);
    bool goes_on = true;
    for (int round = 0; round < kRoundsOfALife && goes_on; ++round, ++done) goes_on = life.go_on();
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
