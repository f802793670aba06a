#include "core/moves/plan_around_kept.h"

#include <algorithm>
#include <utility>

#include "core/moves/fleet_steps.h"
#include "core/moves/orderings.h"
#include "core/moves/repair.h"
#include "core/moves/safe_plan.h"
#include "core/runtime/budget.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {
namespace {

bool has_time_for_two_parts(const PlanningTime& time) {
  return time.first_part.deadline() - StopCondition::Clock::now() >= budget::kLeastFirstPart;
}

class PlanningAroundKept {
 public:
  PlanningAroundKept(PlanState& state, const std::vector<std::size_t>& movers,
                     const std::vector<bool>& certain, Random& random, const PlanningTime& time,
                     ProgressReport& progress)
      : state_(state),
        reservations_(state.reservations()),
        movers_(movers),
        is_certain_(certain),
        random_(random),
        end_(time.all),
        time_(returns_robots() ? PlanningTime::until(after_share(time.all, budget::kShareAroundKept)) : time),
        progress_(progress),
        stop_(has_time_for_two_parts(time_) ? time_.first_part : time_.keeping),
        kept_(reservations_.snapshot()) {}

  PrioritizedResult run() {
    for (const std::size_t robot : movers_) {
      if (!reservations_.trajectory(robot)) others_.push_back(robot);
    }
    if (others_.empty()) {
      pass_those_in_the_way();
      return std::move(result_);
    }
    keep_without_search();
    const bool all_planned = !time_.all.met() && (repaired() || planned_anew());
    if (all_planned) {
      pass_those_in_the_way();
    } else {
      explain_best();
    }
    if (returns_robots() && !end_.is_over()) return_to_kept();
    return std::move(result_);
  }

 private:
  /// Keeps the plan that needs no search: robots that can do so follow their trajectories, all others stay.
  void keep_without_search() {
    const std::vector<bool> stays = robots_that_may_have_to_stay();
    best_ = PlanSnapshot{{}, kept_};
    for (const std::size_t robot : movers_) {
      if (!stays[robot]) {
        certain_.push_back(robot);
        continue;
      }
      best_.plan.staying.push_back({robot, false});
      best_.reservations.trajectories[robot].reset();
      best_.reservations.holds_place_for[robot] = kForever;
    }
  }

  std::vector<bool> robots_that_may_have_to_stay() const {
    std::vector<bool> stays(state_.instance().size(), false);
    if (!is_certain_.empty()) {
      for (const std::size_t robot : movers_)
        stays[robot] = !is_certain_[robot] || !kept_.trajectories[robot];
      return stays;
    }
    std::vector<std::size_t> staying = others_;
    for (const std::size_t robot : staying) stays[robot] = true;
    // Bounded: each robot begins to stay once.
    for (std::size_t k = 0; k < staying.size(); ++k) {  // staying grows
      for (const std::size_t crossing : reservations_.robots_crossing_place(staying[k])) {
        if (stays[crossing] || !reservations_.trajectory(crossing)) continue;
        stays[crossing] = true;
        staying.push_back(crossing);
      }
    }
    return stays;
  }

  /// Repairs the plan. Returns whether all robots are planned.
  bool repaired() {
    const RepairPace pace{[this](const OrderingResult& so_far) { return keep_safe_plan(so_far); }, {}};
    const OrderingResult ordering = repair_around(state_, order(), random_, stop_, progress_, pace);
    progress_.count_by_priorities(others_);
    result_.attempts = ordering.attempts;
    result_.cut_off = ordering.cut_off || in_second_part_;
    if (ordering.unsolved.empty() && ordering.given_up.empty()) return true;
    if (move_in_steps(ordering)) return true;
    keep_if_better(
        make_safe(state_, ordering.unsolved, ordering.given_up, Effort::full, time_.all, progress_));
    others_may_help_ = ordering.hopeless.size() < ordering.given_up.size() || !ordering.unsolved.empty();
    return best_.plan.staying.empty();
  }

  /// Plans the robots that have no plan in steps, among the plans of the others. Returns whether all have
  /// one.
  bool move_in_steps(const OrderingResult& ordering) {
    std::vector<std::size_t> failed = ordering.unsolved;
    failed.insert(failed.end(), ordering.given_up.begin(), ordering.given_up.end());
    if (failed.size() > FleetSteps::kMaxWholeWays || ordering.cut_off) return false;
    const auto outcome = FleetSteps(reservations_, random_, progress_).follow(failed, {}, time_.all);
    result_.cut_off = result_.cut_off || outcome == StepsOutcome::cut_off;
    return outcome == StepsOutcome::followed;
  }

  /// Returns the robots by priority. Robots with trajectories come first.
  PriorityOrder order() {
    PriorityOrder order = initial_order(state_.instance(), movers_, random_);
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t robot) { return reservations_.trajectory(robot).has_value(); });
    return order;
  }

  /// Keeps a safe plan at the end of the first part of the time, and returns to where planning was. Returns
  /// whether planning goes on.
  bool keep_safe_plan(const OrderingResult& so_far) {
    if (in_second_part_ || time_.all.met()) return false;
    in_second_part_ = true;
    const FleetReservations::Snapshot before = reservations_.snapshot();
    keep_if_better(
        make_safe(state_, so_far.unsolved, so_far.given_up, Effort::brief, time_.keeping, progress_));
    if (best_.plan.staying.empty()) return false;
    reservations_.restore(before);
    stop_ = time_.all;
    return !stop_.met();
  }

  /// Keeps the plan in the state if it plans more robots, among them all that are certain.
  void keep_if_better(SafePlan plan) {
    result_.cut_off = result_.cut_off || plan.cut_off;
    if (best_.plan.staying.size() <= plan.staying.size() || !plans_all_certain()) return;
    best_ = PlanSnapshot{std::move(plan), reservations_.snapshot()};
  }

  bool plans_all_certain() const {
    return std::all_of(certain_.begin(), certain_.end(),
                       [&](std::size_t robot) { return reservations_.trajectory(robot).has_value(); });
  }

  /// Plans all robots from the beginning, without regard to earlier trajectories. Returns whether all are
  /// planned.
  bool planned_anew() {
    if (!others_may_help_ || time_.all.met()) return false;
    for (const std::size_t robot : movers_) reservations_.remove(robot);
    const PrioritizedResult anew =
        plan_prioritized(state_, movers_, random_, PlanningTime::until(time_.all), progress_);
    result_.attempts += anew.attempts;
    result_.cut_off = result_.cut_off || anew.cut_off;
    result_.is_limited = anew.is_limited;
    result_.shuttling = anew.shuttling;
    SafePlan plan;
    for (const Unplanned& robot : anew.unplanned) {
      plan.staying.push_back({robot.robot, robot.reason == Unplanned::Reason::blocked_by_robots});
    }
    keep_if_better(std::move(plan));
    return best_.plan.staying.empty();
  }

  /// Returns to the best plan, plans more robots in it while there is time, and tells why the rest stays.
  void explain_best() {
    if (return_to(reservations_, best_, end_) && !time_.all.met()) {
      std::vector<std::size_t> staying;
      staying.reserve(best_.plan.staying.size());
      for (const SafePlan::Staying& robot : best_.plan.staying) staying.push_back(robot.robot);
      SafePlan more = make_safe(state_, {}, staying, Effort::full, time_.all, progress_);
      result_.cut_off = result_.cut_off || more.cut_off;
      // The search keeps slightly larger distances than the check that found certain plans to hold.
      if (plans_all_certain()) {
        best_ = PlanSnapshot{std::move(more), reservations_.snapshot()};
      } else {
        return_to(reservations_, best_, end_);
      }
    }
    PartialPlan partial = explain(state_, best_.plan, time_.all);
    result_.cut_off = result_.cut_off || partial.cut_off;
    result_.unplanned = std::move(partial.unplanned);
  }

  /// Plans all robots in steps, to their goals, if a robot has gained nothing for as long as the horizon and
  /// gains nothing now. Robots that keep their plans do not make way for it.
  void pass_those_in_the_way() {
    const auto& horizon = state_.instance().options().horizon;
    if (!horizon || movers_.size() > FleetSteps::kMaxWholeWays || time_.all.met()) return;
    const bool is_any_passed_over = std::any_of(movers_.begin(), movers_.end(), [&](std::size_t robot) {
      return reservations_.trajectory(robot)->gains_nothing &&
             state_.instance().itinerary(robot).goal_age >= *horizon;
    });
    if (!is_any_passed_over) return;
    const auto outcome = FleetSteps(reservations_, random_, progress_).follow(order(), {}, time_.all);
    result_.cut_off = result_.cut_off || outcome == StepsOutcome::cut_off;
  }

  /// Returns the robots whose trajectory differs from their first one.
  std::vector<std::size_t> robots_that_gave_way() const {
    std::vector<std::size_t> robots;
    for (const std::size_t robot : movers_) {
      const auto& now = reservations_.trajectory(robot);
      if (kept_.trajectories[robot] && now && !now->is_previous) robots.push_back(robot);
    }
    return robots;
  }

  bool returns_robots() const {
    return state_.instance().options().replan == PlanOptions::Replan::where_needed;
  }

  /// Gives robots that gave way their first trajectories back where these are free again.
  void return_to_kept() {
    reservations_.resume();
    return_together();
    for (const std::size_t robot : robots_that_gave_way()) {
      if (end_.met()) return;
      const Trajectory& first = *kept_.trajectories[robot];
      if (reservations_.conflicting_robots(robot, first).empty()) reservations_.follow(robot, first);
    }
  }

  /// Gives as many robots as possible at a time their first trajectories back.
  void return_together() {
    std::vector<std::size_t> changed = robots_that_gave_way();
    while (!changed.empty() && !end_.met()) {
      const FleetReservations::Snapshot before = reservations_.snapshot();
      const std::size_t count = changed.size();
      const bool all_planned = returned_together(changed);
      changed = robots_that_gave_way();
      if (!all_planned) reservations_.restore(before);
      if (!all_planned || changed.size() >= count) break;
    }
  }

  /// Plans robots again. Robots whose first trajectories are free follow them; the others are planned around
  /// these. Returns whether all are planned.
  bool returned_together(const std::vector<std::size_t>& robots) {
    for (const std::size_t robot : robots) reservations_.remove(robot);
    std::vector<std::size_t> left;
    for (const std::size_t robot : robots) {
      const Trajectory& first = *kept_.trajectories[robot];
      if (reservations_.conflicting_robots(robot, first).empty()) {
        reservations_.follow(robot, first);
      } else {
        left.push_back(robot);
      }
    }
    for (const std::size_t robot : left) {
      SearchResult result = state_.plan(robot, {.thorough = false}, end_);
      if (!result.trajectory) return false;
      reservations_.follow(robot, std::move(*result.trajectory));
    }
    return true;
  }

  PlanState& state_;
  FleetReservations& reservations_;
  const std::vector<std::size_t>& movers_;
  const std::vector<bool>& is_certain_;  // by robot; may be empty
  Random& random_;
  const StopCondition end_;
  const PlanningTime time_;  // ends when robots that gave way return
  ProgressReport& progress_;
  StopCondition stop_;                      // ends the repairs
  const FleetReservations::Snapshot kept_;  // reservations at first
  std::vector<std::size_t> others_;         // robots without a trajectory at first
  std::vector<std::size_t> certain_;        // robots that remain planned in every case
  PlanSnapshot best_;
  bool in_second_part_ = false;   // the second part of the time has begun
  bool others_may_help_ = false;  // another order may plan more robots
  PrioritizedResult result_;
};

}  // namespace

PrioritizedResult plan_around_kept(PlanState& state, const std::vector<std::size_t>& movers,
                                   const std::vector<bool>& certain, Random& random, const PlanningTime& time,
                                   ProgressReport& progress) {
  return PlanningAroundKept(state, movers, certain, random, time, progress).run();
}

}  // namespace fleetplan::core
