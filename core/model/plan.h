#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model/action.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// A list of robots by index that may contain all robots: its first few entries, and its length. So lists for
/// every robot are not quadratic in the robots.
class RobotList {
 public:
  static constexpr std::size_t kMaxListed = 20;

  using value_type = std::size_t;
  using const_iterator = std::vector<std::size_t>::const_iterator;

  RobotList() = default;
  RobotList(std::initializer_list<std::size_t> all) : RobotList(std::vector<std::size_t>(all)) {}
  RobotList(std::vector<std::size_t> all)  // NOLINT: implicit
      : total_(all.size()) {
    if (all.size() > kMaxListed) all = std::vector<std::size_t>(all.begin(), all.begin() + kMaxListed);
    listed_ = std::move(all);
  }

  const_iterator begin() const { return listed_.begin(); }
  const_iterator end() const { return listed_.end(); }
  std::size_t operator[](std::size_t index) const { return listed_[index]; }
  std::size_t size() const { return listed_.size(); }
  bool empty() const { return listed_.empty(); }
  /// The size of the whole list.
  std::size_t total() const { return total_; }
  bool operator==(const RobotList&) const = default;

 private:
  std::vector<std::size_t> listed_;
  std::size_t total_ = 0;
};

/// The plan of one robot. Its actions are contiguous in time and space. They begin at t = 0 in the start pose
/// with the committed actions, and end at `cost` in the last goal's pose, where the robot stays. A robot that
/// does not need to move has no actions and cost 0.
///
/// `lower_bound` is a lower bound of the robot's cost alone on the static map, and never exceeds `cost`. The
/// checker ignores it.
struct RobotPlan {
  std::size_t robot = 0;  // index into the problem's robots
  double cost = 0.0;      // seconds
  std::vector<Action> actions;
  double lower_bound = 0.0;        // seconds
  std::vector<Visit> visits = {};  // one for each goal, in their order; the last one has no end
  /// Seconds, if the plan stops at the horizon (PlanOptions::horizon), where the robot may rest for good:
  /// `cost` plus an estimate of the static way that is left. kForever if robots that stay close that way.
  ///
  /// `visits` then has the visits before the horizon, and `estimated_visits` the goals that are left.
  std::optional<double> estimated_cost = {};
  std::vector<Visit> estimated_visits = {};
  /// Whether the plan stops at the horizon, and one of these holds:
  ///
  /// - The robot gains nothing on the way to its goals until then.
  /// - It would come and go for ever, because it and the robots that block it cannot all arrive.
  bool is_stuck = false;
  RobotList blocked_by = {};  // the robots in the way of a robot that is stuck, as far as they were found
};

/// A robot without a plan. It executes its committed actions, if any, and stays at their end. The plans of
/// other robots keep clear of it.
struct Unplanned {
  enum class Reason {
    start_blocked,
    goal_blocked,
    goal_unreachable,
    blocked_by_robots,
    budget_exhausted,
    committed_in_the_way,  // committed motion of another or an obstacle passes there: Plan::unavoidable
    invalid,               // see Robot::invalid
  };
  std::size_t robot = 0;
  Reason reason = Reason::budget_exhausted;
  std::string detail;    // a sentence for people, without robot indices
  RobotList blocked_by;  // the blocking robots, ascending
};

/// Why a robot with Robot::invalid has no plan.
inline Unplanned unplanned_invalid(std::size_t robot) {
  return {
      robot, Unplanned::Reason::invalid, "The robot's geometry is at fault, so it stays where it is.", {}};
}

/// The number of reasons; Reason::invalid is the last one.
inline constexpr std::size_t kUnplannedReasons = static_cast<std::size_t>(Unplanned::Reason::invalid) + 1;

/// A collision that no plan prevents. For example, a robot cannot leave its place before the committed motion
/// of another robot, or an obstacle, passes there. The check of a plan exempts these pairs.
struct UnavoidableCollision {
  std::size_t robot = 0;
  std::optional<std::size_t> other;     // another robot, or
  std::optional<std::size_t> obstacle;  // index into the problem's obstacles
  double t = 0.0;                       // seconds; the begin of the overlap
};

/// The most unavoidable collisions of one robot that a plan lists; later ones are not listed. If a robot has
/// so many, later collisions of its certain motion are exempt, too. So the list grows only with the number of
/// robots.
inline constexpr std::size_t kMaxUnavoidableOfRobot = 8;

/// Flowtime and makespan, seconds: the sum and the maximum of the planned robots' costs, or of their lower
/// bounds.
struct Objectives {
  double flowtime = 0.0;
  double makespan = 0.0;
};

/// The objectives with the cost of one more robot.
inline Objectives including(const Objectives& objectives, double cost) {
  return {objectives.flowtime + cost, std::max(objectives.makespan, cost)};
}

/// How plans are made and improved.
///
/// - priorities: one robot after the other, with repairs and other orders.
/// - steps: all robots at once, step by step.
/// - room: two robots that meet get room to pass each other.
/// - smoothing: paths leave the lattice.
/// - improvement: robots get other plans.
enum class Method : std::uint8_t { priorities, steps, room, smoothing, improvement };
/// Method::improvement is the last one.
inline constexpr std::size_t kMethods = static_cast<std::size_t>(Method::improvement) + 1;

/// How many robots a method tried to plan. A robot counts each time.
struct MethodCounts {
  std::int64_t tried = 0;
  std::int64_t served = 0;           // robots with a plan of this method, or with a plan that it may change
  std::int64_t could_not_serve = 0;  // for what they or the request ask for, it is not made
};

/// Counts of the search for a plan.
struct SearchStatistics {
  std::int64_t attempts = 0;                   // priority orders tried
  std::int64_t expansions = 0;                 // search labels expanded
  std::int64_t improvements = 0;               // improvements found in mode `anytime`
  std::array<MethodCounts, kMethods> moves{};  // by Method
  /// More time would change nothing. In mode `anytime`: no robot can become cheaper, or no further attempt
  /// can plan an unplanned robot.
  bool exhausted = false;
};

/// The result of the planner. `plans` and `unplanned` are in the order of the problem's robots; every robot
/// is in exactly one of them.
struct Plan {
  std::vector<RobotPlan> plans;
  std::vector<Unplanned> unplanned;
  std::vector<UnavoidableCollision> unavoidable =
      {};                         // by time; at most kMaxUnavoidableOfRobot for each robot
  bool unavoidable_known = true;  // false if finding them was given up: then the plan cannot be checked
  Objectives objectives;
  std::optional<Objectives> estimated =
      {};  // with a horizon: the objectives by RobotPlan::estimated_cost, of robots that have a way
  Objectives lower_bound;
  bool deterministic = true;  // false if the clock or the load influenced the plan
  SearchStatistics search;
};

/// The objectives of the estimates, without robots that have no estimate.
inline Objectives estimated_objectives(const Plan& plan) {
  Objectives estimated;
  for (const RobotPlan& robot : plan.plans) {
    const double cost = robot.estimated_cost.value_or(robot.cost);
    if (cost < kForever) estimated = including(estimated, cost);
  }
  return estimated;
}

}  // namespace fleetplan::core
