// Random lives of fleets: plan, go on to a random moment, and plan again, with all members of requests
// together. At the moment, robots are held, late, early or beside their paths, measured or reported. Whatever
// happens:
//
// - No request is answered by `internal_error`.
// - /v1/plan accepts what /v1/advance returns.
// - Robots that execute only their commitments and then stand meet no other robot. Exceptions are robots that
//   overlap already or cannot stop in time; these are named.
//
// FLEETPLAN_ROUNDS is how often they are planned in all, FLEETPLAN_FIRST_LIFE the seed of the first fleet.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/request/parse_request.h"
#include "core/geometry/tolerance.h"
#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/api/support/expect_actions.h"
#include "tests/api/support/life_requests.h"
#include "tests/api/support/lives.h"
#include "tests/support/sanitized.h"
#include "tests/support/summary.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

constexpr int kRoundsOfALife = 5;

using Pair = std::pair<std::string, std::string>;  // ids, in the order of the request

/// Robots that overlap already, or cannot stop in time.
std::set<Pair> named_pairs(const Json& request) {
  std::set<Pair> named;
  for (const Json& meeting : request.value("unavoidable", Json::array())) {
    named.emplace(meeting.at("robots").at(0), meeting.at("robots").at(1));
  }
  return named;
}

/// All robots execute what is committed, and stay. The starts are as the request allows.
void expect_that_all_may_stop(const Json& request, const core::Problem& problem,
                              const core::PlanOptions& options) {
  std::vector<core::Robot> robots = problem.robots();
  std::vector<core::RobotPlan> stops;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    core::Robot& robot = robots[k];
    // Without a plan, it rests at its last goal with the radius with which it arrives.
    if (robot.goal) robot.goal->radius_after.reset();
    if (!robot.committed.empty()) stops.push_back({k, robot.committed_until(), robot.committed});
  }
  core::CheckRules rules;
  rules.tolerances.assign(robots.size(), core::Tolerance::of_all(core::kMaxTolerance));
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  rules.horizon = 0.0;  // with goals left
  const auto report = core::verify({problem.grid(), robots, {}, &problem.zones()}, stops, rules,
                                   core::StopCondition::never());
  const std::set<Pair> named = named_pairs(request);
  for (const core::Violation& violation : report->violations) {
    const bool is_named = violation.kind == core::Violation::Kind::robot_collision &&
                          named.contains({robots[violation.robots[0]].id, robots[violation.robots[1]].id});
    EXPECT_TRUE(is_named) << support::text(*report);
  }
}

/// The state that a robot has reported; null if it has not.
const Json* state_of(const Json& body, const Json& robot) {
  if (!body.contains("states")) return nullptr;
  for (const Json& state : body.at("states")) {
    if (state.at("robot") == robot) return &state;
  }
  return nullptr;
}

/// Exactly the robots that overlap at the moment are named, and some of the robots that need some way to
/// stop.
void expect_that_the_overlapping_are_named(const Json& request, const core::Problem& problem,
                                           const Json& body) {
  const std::set<Pair> named = named_pairs(request);
  constexpr double kRounding = 1e-9;
  const auto& robots = problem.robots();
  const auto needs_way = [&](std::size_t robot) {
    const Json* state = state_of(body, robots[robot].id);
    const bool stands = state != nullptr && state->value("speed", 1.0) == 0.0;
    const Json& one = request.at("robots").at(robot);
    if (one.contains("linear_acceleration") || one.contains("angular_acceleration")) return true;
    return !stands && one.value("stop_distance", 0.0) > 0.0;
  };
  for (std::size_t j = 0; j < robots.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const double gap = (robots[i].start.position - robots[j].start.position).norm() - robots[i].radius -
                         robots[j].radius + core::kContactTolerance;
      const bool is_named = named.contains({robots[i].id, robots[j].id});
      if (std::abs(gap) < kRounding || (gap > 0.0 && (needs_way(i) || needs_way(j)))) continue;
      EXPECT_EQ(is_named, gap < 0.0) << robots[i].id << robots[j].id;
    }
  }
}

double length(const Json& action) {
  return (pose_of(action.at("to")).position - pose_of(action.at("from")).position).norm();
}

/// The metres from an action on that a robot drives in one line without a stop.
double driven(const Json& actions, std::size_t first) {
  double metres = 0.0;
  for (std::size_t k = first; k < actions.size() && actions[k].at("type") == "translate"; ++k) {
    const bool goes_on =
        k == first || (actions[k].value("reverse", false) == actions[first].value("reverse", false) &&
                       actions[k].at("t_start") == actions[k - 1].at("t_end"));
    if (!goes_on) break;
    metres += length(actions[k]);
  }
  return metres;
}

/// A robot at this progress that drives and is not named drives for as long as it needs to stop.
void expect_that_it_can_stop(const Json& robot, const Json& actions, std::size_t action, double progress) {
  constexpr double kRounding = 1e-6;
  if (actions[action].at("type") != "translate" || progress == 1.0) return;
  if (actions[action].contains("profile")) return;  // it brakes with its deceleration
  const double left = driven(actions, action) - progress * length(actions[action]);
  const double needs = std::min(robot.value("stop_distance", 0.0), left);
  EXPECT_GE(driven(robot.value("committed", Json::array()), 0), needs - kRounding) << robot;
}

/// Where a robot with these actions is at a time, once they have begun.
core::Position position_at(const Json& robot, const Json& actions, double t) {
  if (const auto under = under_way(actions, t)) return under->pose.position;
  const Json& end = actions.empty() ? robot.at("start") : actions.back().at("to");
  return core::Position(end.at("x").get<double>(), end.at("y").get<double>());
}

/// Robots are at the poses that their visits name, and an independent check finds no fault with the answer.
void expect_that_choices_hold(Json request, const Json& answer) {
  constexpr double kRounding = 1e-6;  // metres
  bool any = false;
  for (const Json& plan : answer.at("plans")) {
    Json robot;
    for (const Json& one : request.at("robots")) {
      if (one.at("id") == plan.at("robot")) robot = one;
    }
    const std::vector<Json*> goals = goals_of(robot);
    for (const Json& visit : plan.value("visits", Json::array())) {
      const Json& goal = *goals[visit.at("goal").get<std::size_t>()];
      EXPECT_EQ(visit.contains("choice"), goal.contains("any_of"));
      if (!visit.contains("choice")) continue;
      any = true;
      if (visit.at("t_arrive").is_null()) continue;
      const Json& pose = goal.at("any_of").at(visit.at("choice").get<std::size_t>());
      const core::Position chosen(pose.at("x").get<double>(), pose.at("y").get<double>());
      const double away = (position_at(robot, plan.at("actions"), visit.at("t_arrive")) - chosen).norm();
      EXPECT_LE(away, kRounding) << plan;
    }
  }
  if (!any || answer.contains("unavoidable")) return;
  request.update(answer);
  const Reply reply = validate_endpoint(request.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(Json::parse(reply.body).at("violations"), Json::array()) << request;
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
    EXPECT_EQ(reply.status, 200) << steps << " steps: " << reply.body << "\n" << came_from_ << request_;
    if (reply.status != 200) return false;
    answer_ = Json::parse(reply.body);
    EXPECT_EQ(answer_.at("verified"), true);
    expect_that_choices_hold(request_, answer_);
    expect_that_services_are_marked();
    return true;
  }

  void expect_that_services_are_marked() const {
    for (const Json& plan : answer_.at("plans")) {
      for (const Json& robot : request_.at("robots")) {
        if (robot.at("id") != plan.at("robot")) continue;
        SCOPED_TRACE(came_from_ + request_.dump());
        expect_that_marks_follow_visits(robot, plan);
      }
    }
  }

  bool advance(double at) {
    Json body{{"request", request_}, {"plans", answer_.at("plans")}, {"at", at}};
    if (dice_.chance(0.5)) body["commit"] = dice_.between(0.0, 6.0);
    body["pose_tolerance"] = 0.1 * request_.at("map").at("resolution").get<double>();
    const bool observes = dice_.chance(0.6);
    releases_ = dice_.chance(0.3);
    for (const Json& plan : answer_.at("plans")) {
      if (dice_.chance(0.15)) {
        body["holds"].push_back({{"robot", plan.at("robot")}, {"until", dice_.between(0.0, 20.0)}});
      }
      if (dice_.chance(0.1)) start_anew(body, plan.at("robot"));
      if (observes && dice_.chance(0.4)) observe(body, plan.at("robot"), plan.at("actions"));
    }
    for (const Json& robot : request_.at("robots")) {
      if (observes && robot.contains("committed") && !is_planned(robot)) {
        observe(body, robot.at("id"), robot.at("committed"));
      }
    }
    const std::string text = body.dump();
    const Reply reply = advance_endpoint(text, {});
    EXPECT_EQ(reply.status, 200) << reply.body << "\n" << text;
    came_from_ = "advanced from " + text + "\nto ";
    if (reply.status != 200) return false;
    request_ = Json::parse(reply.body);
    SCOPED_TRACE(came_from_ + reply.body);
    const auto parsed = parse_request(reply.body, {}, unbounded_work());
    EXPECT_TRUE(parsed) << parsed.failure().detail;
    if (!parsed) return false;
    expect_that_all_may_stop(request_, parsed->problem, parsed->options);
    expect_that_the_overlapping_are_named(request_, parsed->problem, body);
    expect_that_they_can_stop(body);
    return true;
  }

  /// Robots that were not measured, that are not named, and that say nothing of where they stop.
  void expect_that_they_can_stop(const Json& body) const {
    constexpr double kSetOut = 1e-6;  // less of an action may be about to begin
    std::set<std::string> others;
    for (const auto& [first, second] : named_pairs(request_)) others.insert({first, second});
    for (const Json& observed : body.value("poses", Json::array())) others.insert(observed.at("robot"));
    for (const Json& plan : answer_.at("plans")) {
      const auto is_of_plan = [&](const Json& robot) { return robot.at("id") == plan.at("robot"); };
      const Json& robots = request_.at("robots");
      const auto robot = std::find_if(robots.begin(), robots.end(), is_of_plan);
      if (others.contains(plan.at("robot"))) continue;
      const Json& actions = plan.at("actions");
      if (const Json* state = state_of(body, plan.at("robot"))) {
        const double progress = state->at("progress");
        const bool drives = state->contains("speed") ? state->at("speed") != 0.0 : progress > kSetOut;
        if (state->contains("x") || state->contains("released") || !drives) continue;
        expect_that_it_can_stop(*robot, actions, state->at("action"), progress);
      } else if (const auto under = under_way(actions, body.at("at")); under && under->progress > kSetOut) {
        expect_that_it_can_stop(*robot, actions, under->action, under->progress);
      }
    }
  }

  bool is_planned(const Json& robot) const {
    const Json& plans = answer_.at("plans");
    return std::any_of(plans.begin(), plans.end(),
                       [&](const Json& plan) { return plan.at("robot") == robot.at("id"); });
  }

  /// A robot that keeps its radius begins again with its first goal. If goals are open, another robot may
  /// have taken its last goal.
  void start_anew(Json& body, const Json& robot) const {
    if (first_.dump().find("any_of") != std::string::npos) return;
    for (const Json& one : first_.at("robots")) {
      if (one.at("id") != robot || !one.contains("goals")) continue;
      const auto keeps_radius = [](const Json& goal) { return !goal.contains("radius_after"); };
      if (!std::all_of(one.at("goals").begin(), one.at("goals").end(), keeps_radius)) return;
      body["goals"].push_back({{"robot", robot}, {"goals", one.at("goals")}});
    }
  }

  /// The robot may drive some way already.
  Json released_from(const Json& state, const Json& actions) {
    Json released{{"action", state.at("action")}, {"progress", state.at("progress")}};
    const auto last = actions.size() - 1;
    if (state.at("action").get<std::size_t>() < last && dice_.chance(0.5)) {
      released["action"] = state.at("action").get<std::size_t>() + 1;
      released["progress"] = dice_.between(0.0, 1.0);
    } else if (dice_.chance(0.5)) {
      released["progress"] = dice_.between(state.at("progress"), 1.0);
    }
    return released;
  }

  /// The robot is late, early, or beside its path, which its pose tells, or a state, or both.
  void observe(Json& body, const Json& robot, const Json& actions) {
    const double late = dice_.chance(0.7) ? dice_.between(-0.5, 3.0) : 0.0;
    auto under = under_way(actions, std::max(0.0, body.at("at").get<double>() - late));
    if (!under) return;
    if (dice_.chance(0.5)) {
      const double tolerance = body.at("pose_tolerance").get<double>();
      const double off = (dice_.chance(0.1) ? 12.0 : 1.2) * tolerance;
      const double direction = dice_.between(-std::numbers::pi, std::numbers::pi);
      under->pose.position +=
          dice_.between(0.0, off) * core::Position(std::cos(direction), std::sin(direction));
      under->pose.theta = core::normalize_angle(under->pose.theta + dice_.between(-off, off));
    }
    const bool reports = dice_.chance(0.6);
    Json observed = !reports || dice_.chance(0.5) ? json_of(under->pose) : Json::object();
    observed["robot"] = robot;
    if (reports) {
      observed["action"] = under->action;
      observed["progress"] = dice_.chance(0.1) ? dice_.below(2) : under->progress;
      const bool serves = actions.at(under->action).contains("goal");
      if (serves && dice_.chance(0.5)) observed["service_left"] = dice_.between(0.0, 6.0);
      if (dice_.chance(0.4)) observed["speed"] = dice_.chance(0.5) ? 0.0 : 1.0;
      if (releases_) observed["released"] = released_from(observed, actions);
    }
    body[reports ? "states" : "poses"].push_back(std::move(observed));
  }

  Dice& dice_;
  const Json first_;
  Json request_;
  Json answer_;
  std::string came_from_;
  bool releases_ = false;  // robots that report are told how far they may drive
};

TEST(RandomLives, GoOnFromAnyMomentAndMayStopWhereTheirCommitmentsEnd) {
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t rounds = from_environment("FLEETPLAN_ROUNDS", support::kSanitized ? 100 : 300);
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
