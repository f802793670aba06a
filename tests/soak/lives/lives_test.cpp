// Random lives of fleets with everything that requests may have, together: plan, validate the answer, go on
// to a random moment, and plan again. Code of the test computes from the JSON what robots do. It checks that
//
// - /v1/plan accepts what /v1/advance returns,
// - robots that execute their commitments meet only robots that are named,
// - loads, goals and profiles are kept.
//
// FLEETPLAN_ROUNDS is how often they are planned in all, FLEETPLAN_FIRST_LIFE the seed of the first fleet.
// FLEETPLAN_RECORD names a file to which all requests are written.

#include "tests/api/support/lives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/request/parse_request.h"
#include "tests/api/support/life_requests.h"
#include "tests/api/support/moved.h"
#include "tests/soak/lives/features.h"
#include "tests/soak/lives/own_motion.h"
#include "tests/soak/lives/recorded.h"
#include "tests/soak/lives/tight_fleets.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr int kRoundsOfALife = 5;
constexpr double kRounding = 1e-6;

Json* robot_of(Json& request, const Json& id) {
  for (Json& robot : request.at("robots")) {
    if (robot.at("id") == id) return &robot;
  }
  return nullptr;
}

/// Whether a list of a body has an entry of the robot.
bool has_entry(const Json& body, const char* list, const Json& id) {
  const Json entries = body.value(list, Json::array());
  return std::any_of(entries.begin(), entries.end(), [&](const Json& one) { return one.at("robot") == id; });
}

using Pair = std::pair<std::string, std::string>;

std::set<Pair> named_pairs(const Json& request) {
  std::set<Pair> named;
  for (const Json& meeting : request.value("unavoidable", Json::array())) {
    if (!meeting.contains("robots")) continue;
    const std::string a = meeting.at("robots").at(0);
    const std::string b = meeting.at("robots").at(1);
    named.insert({a, b});
    named.insert({b, a});
  }
  return named;
}

/// Robots that execute what is committed, and then stand, do not overlap, as their JSON has it.
void expect_that_commitments_do_not_meet(const Json& request, const core::Problem& problem) {
  constexpr double kOverlap = 1e-5;
  const Json& robots = request.at("robots");
  const std::set<Pair> named = named_pairs(request);
  std::vector<OwnMotion> motions;
  double until = 0.0;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    motions.emplace_back(robots[k], robots[k].value("committed", Json::array()));
    until = std::max(until, motions.back().until());
  }
  const double step = std::max(0.04, until / 400.0);
  std::vector<double> x(robots.size());
  std::vector<double> y(robots.size());
  for (double t = 0.0; t <= until + step; t += step) {
    for (std::size_t k = 0; k < robots.size(); ++k) motions[k].place_at(t, x[k], y[k]);
    for (std::size_t a = 0; a < robots.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double reach = motions[a].radius_at(t) + motions[b].radius_at(t) - kOverlap;
        if (std::hypot(x[a] - x[b], y[a] - y[b]) >= reach) continue;
        const bool is_known = named.contains({robots[a].at("id"), robots[b].at("id")}) ||
                              problem.robots()[a].invalid || problem.robots()[b].invalid;
        ASSERT_TRUE(is_known) << robots[a].at("id") << robots[b].at("id") << " overlap at " << t;
      }
    }
  }
}

/// By the visits of a plan: how many goals are behind at a time, and the load then. None where that is a
/// matter of rounding.
struct Past {
  std::size_t goals = 0;
  OwnLoad load;
  bool has_served_last = false;
};

std::optional<Past> past_of(const Json& robot, const Json& plan, double at) {
  const Json goals = own_goals(robot);
  Past past{0, OwnLoad::of(robot)};
  for (const Json& visit : plan.value("visits", Json::array())) {
    const std::size_t number = visit.at("goal");
    if (visit.at("t_arrive").is_null() || number >= goals.size()) break;
    const Json& goal = goals[number];
    const bool is_last = number + 1 == goals.size();
    const double arrives = visit.at("t_arrive");
    const bool has_end = !visit.at("t_leave").is_null();
    double end = std::max(arrives, goal.value("not_before", 0.0)) + goal.value("service", 0.0);
    if (has_end) end = visit.at("t_leave");
    // The service at the last goal ends with the commitment at the earliest.
    if (!has_end && robot.contains("committed")) {
      end = std::max(end, robot.at("committed").back().at("t_end").get<double>());
    }
    if (std::abs(end - at) < kRounding) return std::nullopt;
    if (end > at) break;
    past.load = past.load.after(goal);
    past.goals = number + 1;
    past.has_served_last = is_last;
  }
  return past;
}

/// A fleet from round to round.
class EverythingLife {
 public:
  EverythingLife(Dice& dice, Meetings& meetings) : dice_(dice), meetings_(meetings), tight_(dice) {
    is_tight_ = dice_.chance(0.6);
    do {
      first_ = is_tight_ ? full_request(dice_, tight_) : first_request(dice_);
      add_more(dice_, first_);
    } while (!parse_request(first_.dump(), {}, unbounded_work()));
    if (dice_.chance(0.6)) {
      const double far = std::pow(10.0, dice_.between(1.0, 6.0));
      const bool is_simple = dice_.chance(0.5);
      x_ = is_simple ? dice_.below(200) - 100 : dice_.between(-far, far);
      y_ = is_simple ? dice_.below(200) - 100 : dice_.between(-far, far);
    }
    first_ = moved(first_, x_, y_);
    request_ = first_;
  }

  /// Returns false when it has ended.
  bool go_on() {
    if (!plan()) return false;
    expect_that_it_is_valid();
    return advance(dice_.between(0.0, std::max(1.0, 0.6 * answer_.at("makespan").get<double>())));
  }

 private:
  double resolution() const { return first_.at("map").value("resolution", 1.0); }

  bool plan() {
    constexpr std::int64_t kPlenty = 5'000;
    const std::int64_t steps = dice_.chance(0.3) ? dice_.below(2000) : kPlenty;
    record("/v1/plan", request_);
    const Reply reply = planned_in(steps, request_);
    EXPECT_EQ(reply.status, 200) << steps << " steps: " << reply.body << "\n" << came_from_ << request_;
    if (reply.status != 200) return false;
    answer_ = Json::parse(reply.body);
    EXPECT_EQ(answer_.at("verified"), true);
    return true;
  }

  void expect_that_it_is_valid() const {
    Json whole = request_;
    whole.erase("unavoidable");  // of the request before
    whole.update(answer_);
    record("/v1/validate", whole);
    const Reply reply = validate_endpoint(whole.dump(), {});
    ASSERT_EQ(reply.status, 200) << reply.body << "\n" << whole;
    EXPECT_EQ(Json::parse(reply.body).at("violations"), Json::array()) << whole;
  }

  bool advance(double at) {
    Json body{{"request", request_}, {"plans", answer_.at("plans")}, {"at", at}};
    if (dice_.chance(0.5)) body["commit"] = dice_.between(0.0, dice_.chance(0.3) ? 30.0 : 6.0);
    body["pose_tolerance"] = 0.1 * resolution();
    const bool observes = dice_.chance(0.6);
    releases_ = dice_.chance(0.4);
    for (const Json& robot : request_.at("robots")) {
      const Json plan = plan_of(robot.at("id"));
      if (dice_.chance(0.15)) hold(body, robot.at("id"));
      if (dice_.chance(0.15)) set_goals(body, robot);
      const Json actions = plan.is_null() ? robot.value("committed", Json::array()) : plan.at("actions");
      if (observes && dice_.chance(0.4)) observe(body, robot.at("id"), actions);
    }
    record("/v1/advance", body);
    const std::string text = body.dump();
    const Reply reply = advance_endpoint(text, {});
    EXPECT_EQ(reply.status, 200) << reply.body << "\n" << text;
    if (reply.status != 200) return false;
    came_from_ = "advanced from " + text + "\nto ";
    Json next = Json::parse(reply.body);
    SCOPED_TRACE(came_from_ + reply.body);
    meetings_.add(features_of(request_, body));
    const auto parsed = parse_request(reply.body, {}, unbounded_work());
    if (!parsed && body.contains("goals") && are_of_goals(parsed.failure().faults)) return false;
    EXPECT_TRUE(parsed) << parsed.failure().detail;
    if (!parsed) return false;
    expect_that_commitments_do_not_meet(next, parsed->problem);
    for (const Json& robot : request_.at("robots")) expect_that_it_is_kept(robot, body, next);
    request_ = std::move(next);
    return true;
  }

  static bool are_of_goals(const std::vector<Fault>& faults) {
    return std::all_of(faults.begin(), faults.end(), [](const Fault& fault) {
      return fault.code == std::string(fault::kGoalsOverlap) ||
             fault.code == std::string(fault::kGoalInObstacle);
    });
  }

  /// Null for a robot without one.
  Json plan_of(const Json& id) const {
    for (const Json& plan : answer_.at("plans")) {
      if (plan.at("robot") == id) return plan;
    }
    return nullptr;
  }

  /// Robots that were not disturbed are as planned: the load, the goals that are left, and the rest of the
  /// plan.
  void expect_that_it_is_kept(const Json& robot, const Json& body, Json& next) const {
    const Json& id = robot.at("id");
    const Json plan = plan_of(id);
    if (plan.is_null() || has_entry(body, "poses", id) || has_entry(body, "states", id)) return;
    const double at = body.at("at");
    const auto past = past_of(robot, plan, at);
    if (!past) return;
    const Json& left = *robot_of(next, id);
    const OwnLoad load = OwnLoad::of(left);
    EXPECT_EQ(load.radius, past->load.radius) << id;
    EXPECT_EQ(load.linear_speed, past->load.linear_speed) << id;
    EXPECT_EQ(load.acceleration, past->load.acceleration) << id;
    EXPECT_EQ(load.deceleration, past->load.deceleration) << id;
    if (has_entry(body, "goals", id)) return expect_that_passed_loads_are_kept(robot, plan, at, left);
    if (own_goals(robot).empty()) return;  // then a robot that returns has a goal at its start
    const bool goes =
        past->has_served_last && (robot.value("idle", "") == "stay" || robot.value("idle", "") == "yield");
    const std::size_t count =
        own_goals(robot).size() - past->goals + (past->has_served_last && !goes ? 1 : 0);
    EXPECT_EQ(own_goals(left).size(), count) << id;
    if (has_entry(body, "holds", id) || body.contains("states")) return;
    expect_that_the_plan_is_kept(plan, at, robot, left, next);
  }

  static void expect_that_the_plan_is_kept(const Json& plan, double at, const Json& robot, const Json& left,
                                           const Json& next) {
    for (const auto& [first, second] : named_pairs(next)) {
      if (left.at("id") == first || left.at("id") == second) return;  // it could not stop
    }
    bool has_all_profiles = true;
    for (const Json& action : plan.at("actions")) {
      if (action.at("t_end") <= at || action.at("type") == "wait") continue;
      const char* const limit =
          action.at("type") == "translate" ? "linear_acceleration" : "angular_acceleration";
      if (robot.contains(limit) && !action.contains("profile")) has_all_profiles = false;  // measured
    }
    if (!has_all_profiles) return;
    ASSERT_TRUE(left.contains("previous")) << left;
    const Json& previous = left.at("previous");
    const Json& actions = plan.at("actions");
    const double end = actions.empty() ? 0.0 : actions.back().at("t_end").get<double>() - at;
    const double kept = previous.empty() ? 0.0 : previous.back().at("t_end").get<double>();
    EXPECT_GE(kept, end - kRounding) << left;
    const double profiles = with_profile(actions, at + kRounding);
    EXPECT_GE(with_profile(previous, kRounding), profiles) << left;
  }

  static double with_profile(const Json& actions, double t) {
    return static_cast<double>(std::count_if(actions.begin(), actions.end(), [&](const Json& action) {
      return action.at("t_end") > t && action.at("type") == "translate" && action.contains("profile");
    }));
  }

  /// A robot that has got new goals still changes its load where it is committed to do so.
  static void expect_that_passed_loads_are_kept(const Json& robot, const Json& plan, double at,
                                                const Json& left) {
    const Json committed = left.value("committed", Json::array());
    if (committed.empty()) return;
    const double until = at + committed.back().at("t_end").get<double>();
    const Json goals = own_goals(robot);
    const Json goals_left = own_goals(left);
    std::optional<std::size_t> first;
    for (const Json& visit : plan.value("visits", Json::array())) {
      const std::size_t number = visit.at("goal");
      if (number >= goals.size() || visit.at("t_leave").is_null() || visit.at("t_arrive").is_null()) break;
      const double leaves = visit.at("t_leave");
      if (leaves <= at) continue;
      if (!first) first = number;
      if (leaves > until - kRounding || has_moved(plan, left, at)) return;
      if (!changes_own_load(goals[number])) continue;
      ASSERT_GT(goals_left.size(), number - *first) << left;
      const Json& passed = goals_left[number - *first];
      for (const char* load : {"radius_after", "linear_speed_after", "linear_acceleration_after"}) {
        EXPECT_EQ(passed.value(load, 0.0), goals[number].value(load, 0.0)) << left;
      }
    }
  }

  /// Whether the committed actions differ from the plan: the robot is held.
  static bool has_moved(const Json& plan, const Json& left, double at) {
    const Json& last = left.at("committed").back();
    const double t = at + last.at("t_end").get<double>();
    for (const Json& action : plan.at("actions")) {
      if (action.at("t_start") > t + kRounding || action.at("t_end") < t - kRounding) continue;
      const double x = action.at("to").at("x");
      const double y = action.at("to").at("y");
      const bool is_there = std::abs(x - last.at("to").at("x").get<double>()) < 1e-3 &&
                            std::abs(y - last.at("to").at("y").get<double>()) < 1e-3;
      if (is_there) return false;
    }
    return true;
  }

  void hold(Json& body, const Json& id) {
    const double until = dice_.chance(0.1) ? 1e8 : dice_.between(0.0, 20.0);
    body["holds"].push_back({{"robot", id}, {"until", until}});
    if (until == 1e8) body["holds"].back()["until"] = 1e8 - dice_.between(0.0, 1.0);
  }

  /// Other goals. In a tight fleet, any goals, with the last one where it was. Otherwise, goals of the first
  /// request, if it has no loads.
  void set_goals(Json& body, const Json& robot) {
    Json* first = robot_of(first_, robot.at("id"));
    const Json goals = own_goals(*first);
    if (goals.empty()) return;
    const bool yields = first->value("idle", "") == "yield";
    if (!is_tight_) {
      if (first_.dump().find("any_of") != std::string::npos) return;
      if (std::any_of(goals.begin(), goals.end(), changes_own_load)) return;
      body["goals"].push_back({{"robot", robot.at("id")}, {"goals", goals}});
      return;
    }
    if (goals.back().contains("any_of") && !yields) return;
    Json last = yields ? moved(tight_.cell(), x_, y_) : goals.back();
    for (const char* member : {"due", "not_before", "radius_after", "linear_speed_after",
                               "linear_acceleration_after", "linear_deceleration_after"}) {
      last.erase(member);
    }
    last = moved(last, -x_, -y_);
    Json other = moved(tight_.goals(last), x_, y_);
    if (dice_.chance(0.4)) add_tight_loads(dice_, other, *first);
    for (Json& goal : other) {
      if (&goal == &other.back() && !yields) continue;
      if (!dice_.chance(0.25)) continue;
      const Json place{{"x", goal.at("x")}, {"y", goal.at("y")}};
      for (const char* member : {"x", "y", "theta"}) goal.erase(member);
      goal["any_of"] = Json::array({moved(tight_.cell(), x_, y_), place});
    }
    body["goals"].push_back({{"robot", robot.at("id")}, {"goals", other}});
  }

  /// The robot may drive some way already.
  Json released_from(const Json& state, const Json& actions) {
    Json released{{"action", state.at("action")}, {"progress", state.at("progress")}};
    const auto number = state.at("action").get<std::size_t>();
    const std::size_t ahead = actions.size() - 1 - number;
    if (ahead > 0 && dice_.chance(0.6)) {
      released["action"] =
          number + 1 +
          static_cast<std::size_t>(dice_.below(static_cast<int>(std::min<std::size_t>(ahead, 4))));
      released["progress"] = dice_.chance(0.5) ? 1.0 : dice_.between(0.0, 1.0);
    } else if (dice_.chance(0.5)) {
      released["progress"] = dice_.between(state.at("progress"), 1.0);
    }
    return released;
  }

  /// The robot is late, early, or beside its path, which its pose tells, or a state, or both.
  void observe(Json& body, const Json& id, const Json& actions) {
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
    observed["robot"] = id;
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
  Meetings& meetings_;
  TightFleet tight_;
  bool is_tight_ = false;
  double x_ = 0.0, y_ = 0.0;  // the origin
  Json first_;
  Json request_;
  Json answer_;
  std::string came_from_;
  bool releases_ = false;
};

TEST(Lives, WithEverythingTogetherGoOnFromAnyMoment) {
  constexpr std::uint64_t kLeast = 50;  // how often two features meet in so many rounds
  constexpr std::uint64_t kRounds = 20'000;
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t rounds = from_environment("FLEETPLAN_ROUNDS", kRounds);
  Meetings meetings;
  std::uint64_t done = 0;
  for (std::uint64_t seed = first; done < rounds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    EverythingLife life(dice, meetings);
    bool goes_on = true;
    for (int round = 0; round < kRoundsOfALife && goes_on; ++round, ++done) goes_on = life.go_on();
  }
  meetings.print();
  for (const std::string& pair : meetings.rarer_than(kLeast * rounds / kRounds)) ADD_FAILURE() << pair;
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
