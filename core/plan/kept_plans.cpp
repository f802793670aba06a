#include "core/plan/kept_plans.h"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

#include "core/bounds/lower_bound.h"
#include "core/compile/instance.h"
#include "core/explain/unavoidable_collisions.h"
#include "core/fleet/fleet_reservations.h"
#include "core/geometry/segment.h"
#include "core/model/body.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/moves/orderings.h"
#include "core/runtime/random.h"
#include "core/verify/check_rules.h"
#include "core/verify/verify.h"

namespace fleetplan::core {
namespace {

/// Returns the itinerary that the robot would have if all its previous actions were committed.
Itinerary as_committed(const Robot& robot) {
  Robot follower = robot;
  follower.committed = previous_actions(robot);
  return itinerary_of(follower);
}

}  // namespace

bool have_previous_plans(const std::vector<Robot>& robots) {
  return std::any_of(robots.begin(), robots.end(),
                     [](const Robot& robot) { return robot.previous.has_value(); });
}

RobotPlan previous_plan(std::size_t index, const Robot& robot) {
  const std::vector<Action>& actions = previous_actions(robot);
  return {index, actions.empty() ? 0.0 : actions.back().t_end, actions, 0.0};
}

Trajectory previous_trajectory(const Robot& robot) {
  Itinerary all = as_committed(robot);
  Trajectory trajectory = std::move(all.committed);
  const std::size_t first = itinerary_of(robot).first_goal;
  for (const Visit& visit : all.visited) {
    if (visit.goal >= first) trajectory.visits.push_back(visit);
  }
  if (robot.goal && changes_radius(robot)) trajectory.last_served = previous_service_end(robot);
  trajectory.is_previous = true;
  return trajectory;
}

namespace {

/// Leaves out previous plans until the checker accepts the rest.
class PlansThatHold {
 public:
  PlansThatHold(const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                LeftOut left_out, std::vector<bool> candidates)
      : robots_(problem.robots()),
        problem_(problem),
        options_(options),
        stop_(stop),
        left_out_(left_out),
        kept_(std::move(candidates)) {}

  KeptPlans run() {
    while (true) {
      const auto report = check();
      if (!report) return {std::vector<bool>(robots_.size(), false), true};
      const bool left_some_out = leave_out(*report);
      // A robot that need not stay conflicts with no other once its plan is left out.
      const bool is_final =
          left_out_ == LeftOut::unknown && is_complete(*report) && !has_margins(*report) && !is_inflated();
      if (!left_some_out || is_final) return {std::move(kept_), false};
    }
  }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;

  /// Robots whose inflated disks overlap at first may be near each other until these are clear. Their bare
  /// disks may not, so that these have to be checked, too.
  bool is_inflated() const { return options_.inflation > 0.0; }

  std::optional<VerifyReport> check() const {
    auto report = check(options_.inflation);
    return report && report->valid() && is_inflated() ? check(0.0) : report;
  }

  std::optional<VerifyReport> check(double inflation) const {
    std::vector<RobotPlan> plans;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (kept_[i]) plans.push_back(previous_plan(i, robots_[i]));
    }
    CheckRules rules;
    rules.tolerances = plan_tolerances(problem_.grid(), robots_, plans);
    rules.inflation = inflation;
    rules.interval_margin = options_.interval_margin;
    rules.wait_before_move = options_.wait_before_move;
    rules.start_overlap = options_.start_overlap;
    rules.goal_overlap = options_.goal_overlap;
    rules.exact_commitments = true;
    return verify({problem_.grid(), robots_, problem_.obstacles(), &problem_.zones()}, plans, rules, stop_);
  }

  static bool is_complete(const VerifyReport& report) {
    return report.violations.size() == report.violation_count && report.violation_count < kMaxCollisions;
  }

  /// Whether a margin is violated. Only the deepest such violation of each pair is listed, so a conflict with
  /// committed motion may be hidden.
  static bool has_margins(const VerifyReport& report) {
    return std::any_of(report.violations.begin(), report.violations.end(),
                       [](const Violation& found) { return found.kind == Violation::Kind::margin; });
  }

  bool may_move(std::size_t robot) const { return robots_[robot].goal && !robots_[robot].invalid; }
  bool stays(std::size_t robot) const {
    return !may_move(robot) || (left_out_ == LeftOut::stay && !kept_[robot]);
  }

  /// Leaves out plans that cause the violations. Returns whether there were any.
  bool leave_out(const VerifyReport& report) {
    const auto before = std::count(kept_.begin(), kept_.end(), true);
    std::vector<Pair> staying;
    std::vector<Pair> conflicts;
    for (const Violation& violation : report.violations) {
      if (violation.robots.size() == 1) continue;
      const Pair pair{violation.robots[0], violation.robots[1]};
      if (is_unavoidable(violation, pair.first, pair.second) ||
          is_unavoidable(violation, pair.second, pair.first))
        continue;
      (stays(pair.first) || stays(pair.second) ? staying : conflicts).push_back(pair);
    }
    for (const Violation& violation : report.violations) leave_out_alone(violation);
    for (const Pair& pair : staying) kept_[pair.first] = kept_[pair.second] = false;
    leave_out_lower(conflicts);
    return std::count(kept_.begin(), kept_.end(), true) < before;
  }

  /// Leaves out a plan that breaks a rule on its own, or conflicts with what another robot is committed to.
  void leave_out_alone(const Violation& violation) {
    const std::size_t robot = violation.robots.front();
    if (violation.robots.size() == 1) {
      kept_[robot] = false;
      return;
    }
    const std::size_t other = violation.robots[1];
    if (is_with_commitment(violation, other)) kept_[robot] = false;
    if (is_with_commitment(violation, robot)) kept_[other] = false;
  }

  /// Whether one robot is in the way of what the other is committed to, with or without its plan. A plan that
  /// comes nearer than that is the cause itself.
  bool is_unavoidable(const Violation& violation, std::size_t staying, std::size_t committed) const {
    const double until = robots_[committed].committed_until();
    return stays(staying) && violation.t_begin && *violation.t_begin >= robots_[staying].committed_until() &&
           *violation.t_begin < until && violation.t <= until + kMaxTolerance;
  }

  /// Whether the violation is about what the robot does in any case. It is a violation of its commitment, or
  /// of a margin. The margin is kept from everything that a robot without a plan does, except where it stays.
  bool is_with_commitment(const Violation& violation, std::size_t robot) const {
    if (violation.kind == Violation::Kind::margin && !kept_[robot]) return true;
    return violation.t_begin.value_or(violation.t) < robots_[robot].committed_until();
  }

  /// Keeps, of conflicting plans, the plans with the higher priorities.
  void leave_out_lower(std::vector<Pair> conflicts) {
    const std::vector<std::size_t> rank = ranks();
    for (auto& [higher, lower] : conflicts) {
      if (rank[lower] < rank[higher]) std::swap(higher, lower);
    }
    // In the order of the lower robot, so that the higher robot is already decided.
    std::sort(conflicts.begin(), conflicts.end(), [&](const Pair& a, const Pair& b) {
      return std::pair(rank[a.second], rank[a.first]) < std::pair(rank[b.second], rank[b.first]);
    });
    for (const auto& [higher, lower] : conflicts) {
      if (kept_[higher]) kept_[lower] = false;
    }
  }

  std::vector<std::size_t> ranks() const {
    std::vector<std::size_t> movers;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (may_move(i)) movers.push_back(i);
    }
    Random random(options_.seed);  // as in planning, so that the order is the same
    const PriorityOrder order = initial_order(itineraries_of(robots_), options_, std::move(movers), random);
    std::vector<std::size_t> ranks(robots_.size(), order.size());
    for (std::size_t k = 0; k < order.size(); ++k) ranks[order[k]] = k;
    return ranks;
  }

  const std::vector<Robot>& robots_;
  const Problem& problem_;
  const PlanOptions& options_;
  const StopCondition& stop_;
  const LeftOut left_out_;
  std::vector<bool> kept_;  // by robot
};

}  // namespace

KeptPlans keep_previous_plans(const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                              LeftOut left_out) {
  if (!have_previous_plans(problem.robots())) return {};
  std::vector<bool> all;
  for (const Robot& robot : problem.robots()) all.push_back(robot.goal.has_value() && !robot.invalid);
  return PlansThatHold(problem, options, stop, left_out, std::move(all)).run();
}

KeptPlans keep_if_others_stay(const Problem& problem, const PlanOptions& options, const KeptPlans& previous,
                              const StopCondition& stop) {
  return PlansThatHold(problem, options, stop, LeftOut::stay, previous.kept).run();
}

std::size_t follow_kept_plans(FleetReservations& reservations, const KeptPlans& previous,
                              const KeptPlans& certain) {
  const std::vector<Robot>& robots = reservations.instance().problem().robots();
  std::size_t followed = 0;
  for (std::size_t robot = 0; robot < previous.kept.size(); ++robot) {
    if (!previous.kept[robot]) continue;
    Trajectory trajectory = previous_trajectory(robots[robot]);
    // The checker has accepted all kept plans together, and against what all robots are committed to.
    const auto is_kept = [&](std::size_t other) { return bool(previous.kept[other]); };
    const std::vector<std::size_t> others = reservations.conflicting_robots(robot, trajectory);
    if (!certain.contains(robot) && !std::all_of(others.begin(), others.end(), is_kept)) continue;
    reservations.follow(robot, std::move(trajectory));
    ++followed;
  }
  return followed;
}

void finish_with_kept_plans(FleetReservations& reservations, const std::vector<std::size_t>& movers) {
  const std::vector<Robot>& robots = reservations.instance().problem().robots();
  FleetReservations::Snapshot wanted = reservations.snapshot();
  for (const std::size_t robot : movers) {
    wanted.trajectories[robot] = previous_trajectory(robots[robot]);
  }
  reservations.set_without_table(std::move(wanted));
}

namespace {

/// Returns the previous plans that hold if all other robots stay; none where the memory does not suffice for
/// the check.
KeptPlans plans_that_are_safe(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  try {
    return keep_previous_plans(problem, options, stop, LeftOut::stay);
  } catch (const std::bad_alloc&) {
    return {};
  }
}

double bound_of(const Robot& robot, const PlanOptions& options) {
  const Itinerary itinerary = itinerary_of(robot);
  return lower_bound(itinerary, bodies_of(robot, options, itinerary.first_goal));
}

}  // namespace

Plan plan_without_search(const Problem& problem, const PlanOptions& options, const char* detail,
                         const StopCondition& stop) {
  const KeptPlans previous = plans_that_are_safe(problem, options, stop);
  Plan plan;
  std::vector<bool> planned(problem.robots().size(), false);
  for (std::size_t index = 0; index < problem.robots().size(); ++index) {
    const Robot& robot = problem.robots()[index];
    if (robot.invalid) {
      plan.unplanned.push_back(unplanned_invalid(index));
      continue;
    }
    if (robot.goal && !robot.is_idle() && !previous.contains(index)) {
      plan.unplanned.push_back({index, Unplanned::Reason::budget_exhausted, detail, {}});
      continue;
    }
    RobotPlan kept = previous_plan(index, robot);
    kept.visits = visits_of(robot, kept.actions);
    kept.lower_bound = robot.goal ? std::min(kept.cost, bound_of(robot, options)) : kept.cost;
    planned[index] = robot.goal.has_value();
    plan.objectives.flowtime += kept.cost;
    plan.objectives.makespan = std::max(plan.objectives.makespan, kept.cost);
    plan.lower_bound.flowtime += kept.lower_bound;
    plan.lower_bound.makespan = std::max(plan.lower_bound.makespan, kept.lower_bound);
    plan.plans.push_back(std::move(kept));
  }
  UnavoidableCollisions found =
      unavoidable_collisions(problem, itineraries_of(problem.robots()), planned, stop);
  plan.unavoidable = std::move(found.collisions);
  plan.unavoidable_known = found.finished;
  plan.deterministic = false;
  return plan;
}

}  // namespace fleetplan::core
