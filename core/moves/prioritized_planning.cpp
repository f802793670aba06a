#include "core/moves/prioritized_planning.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <new>
#include <optional>
#include <utility>

#include "core/moves/expected_arrivals.h"
#include "core/moves/fleet_steps.h"
#include "core/moves/making_room.h"
#include "core/moves/orderings.h"
#include "core/moves/place_steps.h"
#include "core/moves/repair.h"
#include "core/moves/safe_plan.h"
#include "core/moves/yielding.h"
#include "core/runtime/budget.h"

namespace fleetplan::core {
namespace {

/// The most robots for which all orders are tried. Unlike repair, that ends where there is no solution, and
/// proves it for prioritized planning.
constexpr std::size_t kFewRobots = 4;
/// Attempts in random orders, each with repairs, if no deadline ends them.
constexpr int kMaxOrdersWithoutDeadline = 10;
/// The most robots that are planned again, one after the other, after a plan in steps.
constexpr std::size_t kMaxReplanned = 16;
/// Vertices times robots up to which the distances for steps take only some tenths of a second.
constexpr std::int64_t kFewDistances = 10'000'000;
/// Metres that are added to the way of each robot, in estimates of the time that its plan takes.
constexpr double kLeastWay = 1.0;
/// How many times as long as estimated the rest of planning may take.
constexpr double kReserve = 1.15;
/// Planning ends soon if its rest takes at most this fraction (1 / kTimesSoon) of the time that is left.
constexpr int kTimesSoon = 4;
/// With more than one failure for this many robots, the robots are a crowd. Its last robots take longer than
/// estimated.
constexpr std::int64_t kRobotsPerFailure = 50;
/// The failed attempts after which robots of different sizes are planned again in the order of sizes, if they
/// were planned in another order.
constexpr std::int64_t kMaxFailures = 15;

/// Plans every robot once, in the given order.
OrderingResult plan_each_once(PlanState& state, const PriorityOrder& order, const StopCondition& stop,
                              ProgressReport& progress) {
  FleetReservations& reservations = state.reservations();
  progress.next_attempt();
  const double reserved = state.instance().options().start_safe_interval;
  OrderingResult result;
  for (const std::size_t robot : order) reservations.reserve_place(robot, reserved);
  for (const std::size_t robot : order) {
    SearchResult search;
    reservations.remove(robot);
    if (!stop.met()) search = state.plan(robot, {}, stop);
    if (search.trajectory) {
      reservations.follow(robot, std::move(*search.trajectory));
      progress.update();
    } else {
      reservations.reserve_place(robot, reserved);
      result.unsolved.push_back(robot);
    }
  }
  result.cut_off = stop.met();
  return result;
}

bool differ_in_size(const Instance& instance, const PriorityOrder& order) {
  return std::any_of(order.begin(), order.end(), [&](std::size_t robot) {
    return instance.body(robot).pair_radius != instance.body(order.front()).pair_radius;
  });
}

PrioritizedResult all_unplanned(const std::vector<std::size_t>& movers) {
  PrioritizedResult result;
  result.cut_off = true;
  for (const std::size_t robot : movers) {
    result.unplanned.push_back({robot,
                                Unplanned::Reason::budget_exhausted,
                                "The time budget ended before planning could begin.",
                                {}});
  }
  return result;
}

class PrioritizedPlanning {
  using Clock = StopCondition::Clock;

 public:
  PrioritizedPlanning(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                      const PlanningTime& time, ProgressReport& progress)
      : state_(state),
        random_(random),
        time_(time),
        progress_(progress),
        order_(initial_order(state.instance(), movers, random)),
        steps_(state.reservations(), random, progress),
        stop_(restarts() ? time.first_part : time.keeping),
        begin_(Clock::now()),
        half_(after_share(time.all, budget::kShareBeforeSafePlanOfCrowd)),
        next_look_(after_share(time.all, budget::kShareOfLook)) {
    if (is_by_arrival()) order_by_arrival();
    const bool may_stop = state.instance().options().horizon && !order_.empty();
    if (may_stop && state.instance().itinerary(order_.front()).goal_age > 0.0) {
      state.set_whole_way_of(order_.front());
    }
  }

  PrioritizedResult run() {
    OrderingResult ordering = plan_in_orders();
    progress_.count_by_priorities(order_);
    result_.attempts += ordering.attempts;
    result_.cut_off =
        result_.cut_off || ordering.cut_off || best_.has_value() || ordering.steps == StepsOutcome::cut_off;
    result_.is_limited = ordering.steps == StepsOutcome::limited;
    if (solved(ordering)) {
      if (ordering.steps == StepsOutcome::followed) replan_after_steps(order_);
      if (const auto robot = shuttling_robot()) plan_whole_ways(*robot);
      return std::move(result_);
    }
    if (may_need_room(ordering) && give_way(ordering.hopeless, ordering.steps.has_value())) {
      ordering.unsolved.clear();
      ordering.given_up = ordering.hopeless;
      if (solved(ordering)) return std::move(result_);
    }
    const bool may_try_again = !ordering.cut_off && other_orders_may_help(ordering);
    if (may_try_again || !best_ || !ordering.cut_off) {
      keep_if_better(ordering.unsolved, ordering.given_up, may_try_again ? Effort::brief : Effort::full,
                     time_.all);
    }
    if (may_try_again) try_other_orders(ordering.hopeless);
    return_to(state_.reservations(), *best_, time_.all);
    PartialPlan partial = explain(state_, best_->plan, time_.all);
    result_.cut_off = result_.cut_off || partial.cut_off;
    result_.unplanned = std::move(partial.unplanned);
    return std::move(result_);
  }

 private:
  static bool solved(const OrderingResult& ordering) {
    return ordering.unsolved.empty() && ordering.given_up.empty();
  }

  OrderingResult plan_in_orders() {
    const auto reordering = state_.instance().options().reordering;
    if (reordering == PlanOptions::Reordering::none) return plan_each_once(state_, order_, stop_, progress_);
    const OnStop keep_plan = [this](const OrderingResult& so_far) { return keep_safe_plan(so_far); };
    const RepairPace pace{keep_plan, [this] { return !best_ && next_look_.met(); }};
    if (restarts()) {
      return plan_with_restarts(state_, order_, random_, stop_, progress_, keep_plan);
    }
    if (!is_by_arrival() && !state_.instance().options().horizon &&
        differ_in_size(state_.instance(), order_)) {
      if (auto result =
              repair_unless(kMaxFailures, state_, order_, steps_, random_, stop_, progress_, pace)) {
        return std::move(*result);
      }
      result_.attempts += kMaxFailures;
      order_by_arrival();
    }
    begin_ = Clock::now();
    next_look_ = after_share(time_.all, budget::kShareOfLook);
    return repair_all(state_, order_, steps_, random_, stop_, progress_, pace);
  }

  /// Whether robots come in the order of their expected arrivals from the beginning.
  bool is_by_arrival() const {
    const PlanOptions& options = state_.instance().options();
    return options.priority == PlanOptions::Priority::shortest_first && !options.horizon;
  }

  void order_by_arrival() {
    ExpectedOrder expected =
        order_by_expected_arrival(state_, order_, after_share(time_.all, budget::kShareOfOrder));
    order_ = std::move(expected.robots);
    result_.cut_off = result_.cut_off || expected.cut_off;
  }

  /// Decides whether planning one by one goes on. It does as long as all robots are expected to have a plan
  /// in time. At the end of the first part of the time, a safe plan is kept before. Where the time will not
  /// suffice, a safe plan is made at once, and planning goes on from it.
  bool keep_safe_plan(const OrderingResult& so_far) {
    if (best_ || time_.all.met()) return false;
    const bool is_crowded = so_far.attempts > 1 + std::ssize(order_) / kRobotsPerFailure;
    const auto is_late = [&] { return time_.keeping.deadline() - Clock::now() <= time_left_to_plan(so_far); };
    const bool is_due = is_crowded ? half_.met() : time_.first_part.met() && !ends_soon(so_far);
    if (!is_late() && !is_due && !stop_.met()) {
      next_look_ = after_share(time_.all, budget::kShareOfLook);
      return true;
    }
    if (may_move_in_steps(so_far) && moves_in_steps(so_far)) return false;
    const Clock::duration left = time_left_to_plan(so_far);
    const bool is_in_time = !is_late();
    const FleetReservations::Snapshot before = state_.reservations().snapshot();
    keep_if_better(so_far.unsolved, so_far.given_up, Effort::brief,
                   is_in_time && !is_crowded ? time_.all.until(before_the_rest(left)) : time_.keeping);
    if (best_->plan.staying.empty()) return false;
    const bool may_still_end = left < time_.all.deadline() - Clock::now();
    if (is_in_time && may_still_end) state_.reservations().restore(before);
    stop_ = time_.all;
    return !stop_.met();
  }

  /// Whether planning is expected to end in a small part of the time that is left.
  bool ends_soon(const OrderingResult& so_far) const {
    return time_left_to_plan(so_far) * kTimesSoon < time_.keeping.deadline() - Clock::now();
  }

  /// When a safe plan has to be there if planning, which needs so long, goes on afterwards.
  Clock::time_point before_the_rest(Clock::duration left) const {
    return std::min(after_share(time_.all, budget::kShareOfKeeping).deadline(), time_.all.deadline() - left);
  }

  /// Whether steps are worth a try: after a failure, or where they do not take long to prepare.
  bool may_move_in_steps(const OrderingResult& so_far) const {
    const std::int64_t vertices = state_.instance().lattice(order_.front()).vertex_count();
    return so_far.attempts > 1 || std::ssize(order_) * vertices <= kFewDistances;
  }

  /// Returns whether it keeps a plan in which all robots but those that are given up move in steps.
  bool moves_in_steps(const OrderingResult& so_far) {
    if (!steps_succeed(so_far.given_up, time_.keeping)) return false;
    keep_if_better({}, so_far.given_up, Effort::brief, time_.keeping);
    return true;
  }

  /// The expected time of planning the robots without a plan. The effort for a robot grows faster than its
  /// way: searches take longer, and meet more robots.
  Clock::duration time_left_to_plan(const OrderingResult& so_far) const {
    const auto effort = [&](const auto& robots) {
      double sum = 0.0;
      for (const std::size_t robot : robots) {
        const double way = state_.instance().itinerary(robot).direct_way + kLeastWay;
        sum += way * std::sqrt(way);
      }
      return sum;
    };
    const double left = effort(so_far.unsolved);
    const double done = std::max(effort(order_) - left, kLeastWay);
    return std::chrono::duration_cast<Clock::duration>((Clock::now() - begin_) * (kReserve * left / done));
  }

  bool steps_succeed(const std::vector<std::size_t>& staying, const StopCondition& stop) {
    const StepsOutcome outcome = steps_.follow(order_, staying, stop);
    result_.cut_off = result_.cut_off || outcome == StepsOutcome::cut_off;
    result_.is_limited = outcome == StepsOutcome::limited;
    if (outcome == StepsOutcome::followed) ++result_.attempts;
    return outcome == StepsOutcome::followed;
  }

  void keep_if_better(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up,
                      Effort effort, const StopCondition& stop) {
    SafePlan plan = make_safe(state_, unsolved, given_up, effort, stop, progress_);
    if (best_ && best_->plan.staying.size() <= plan.staying.size()) return;
    best_ = PlanSnapshot{std::move(plan), state_.reservations().snapshot()};
  }

  /// A robot that may come and go for ever with plans up to the horizon. The robot whose goal is the oldest
  /// has no plan beyond the horizon, because others would have to go back a long way. Or a robot that has
  /// arrived leaves its goal and does not come back. Robots whose goals lie in each other's way would come
  /// and leave in turn.
  std::optional<std::size_t> shuttling_robot() const {
    if (!state_.instance().options().horizon || order_.empty()) return std::nullopt;
    if (order_.size() > FleetSteps::kMaxWholeWays) return std::nullopt;
    if (state_.instance().itinerary(order_.front()).goal_age > 0.0 && !state_.whole_way_of() &&
        stops_at_horizon(order_.front())) {
      return order_.front();
    }
    const auto leaving = std::find_if(order_.begin(), order_.end(), [&](std::size_t robot) {
      const Itinerary& itinerary = state_.instance().itinerary(robot);
      return !itinerary.yields() && has_arrived(itinerary) && stops_at_horizon(robot);
    });
    return leaving == order_.end() ? std::nullopt : std::optional(*leaving);
  }

  bool stops_at_horizon(std::size_t robot) const {
    const auto& trajectory = state_.reservations().trajectory(robot);
    return trajectory && trajectory->stops_at;
  }

  /// Plans all robots in steps, to their goals, beyond the horizon. This plan is kept until any robot has a
  /// new goal, so that all robots arrive. If there is no such plan, says so of this robot.
  void plan_whole_ways(std::size_t robot) {
    if (steps_succeed({}, stop_) || result_.is_limited || result_.cut_off) return;
    PrioritizedResult::Shuttling shuttling{robot, {}};
    for (const std::size_t other : order_) {
      if (other != robot && cannot_both_arrive(robot, other)) shuttling.others.push_back(other);
    }
    if (shuttling.others.empty()) {
      std::copy_if(order_.begin(), order_.end(), std::back_inserter(shuttling.others),
                   [&](std::size_t other) { return other != robot; });
    }
    std::sort(shuttling.others.begin(), shuttling.others.end());
    result_.shuttling = std::move(shuttling);
  }

  /// Whether steps of these two lead nowhere, even if the others are absent.
  bool cannot_both_arrive(std::size_t robot, std::size_t other) {
    const IgnoredRobots others(state_.reservations(), order_);
    try {
      PlaceSteps steps(state_.reservations(), {robot, other}, random_);
      steps.run(stop_);
      result_.cut_off = result_.cut_off || stop_.met();
      return steps.has_no_way();
    } catch (const std::bad_alloc&) {  // not granted to the job
      return false;
    }
  }

  /// Steps cost more than it takes: they let one robot move at a time, and only from vertex to vertex.
  void replan_after_steps(const std::vector<std::size_t>& robots) {
    if (state_.instance().options().horizon || robots.size() > kMaxReplanned) return;
    replan_for_less(state_, robots, stop_);
    result_.cut_off = result_.cut_off || stop_.met();
  }

  bool has_few_robots() const { return order_.size() <= kFewRobots; }
  /// Whether other orders are tried from the beginning. Robots that yield make way for others in no order:
  /// they are asked to in repairs.
  bool restarts() const {
    const auto reordering = state_.instance().options().reordering;
    return !any_yields(state_.instance()) &&
           (reordering == PlanOptions::Reordering::random || has_few_robots());
  }

  /// Whether robots may have a plan although repair, or all orders of few robots, have failed.
  bool may_need_room(const OrderingResult& ordering) const {
    return state_.instance().options().reordering != PlanOptions::Reordering::none && !ordering.cut_off &&
           ordering.hopeless.size() < ordering.unsolved.size() + ordering.given_up.size();
  }

  /// Plans the robots that are not hopeless in steps or, few of them, so that they make room for each other.
  /// Returns whether they follow the better plan of the two; if there is none, no reservation has changed.
  bool give_way(const std::vector<std::size_t>& hopeless, bool tried_steps) {
    FleetReservations& reservations = state_.reservations();
    std::vector<std::size_t> robots = order_;
    std::erase_if(robots, [&](std::size_t robot) {
      return std::find(hopeless.begin(), hopeless.end(), robot) != hopeless.end();
    });
    double least = kForever;
    std::optional<FleetReservations::Snapshot> best;
    const auto keep_if_better = [&] {
      double cost = 0.0;
      for (const std::size_t robot : robots) cost += reservations.trajectory(robot)->cost;
      if (cost < least) best = reservations.snapshot();
      least = std::min(least, cost);
    };
    if (!tried_steps && steps_succeed(hopeless, stop_)) {
      replan_after_steps(robots);
      keep_if_better();
    }
    if (has_few_robots() && makes_room(robots)) {
      ++result_.attempts;
      keep_if_better();
    }
    result_.cut_off = result_.cut_off || stop_.met();
    if (best) reservations.restore(std::move(*best));
    return best.has_value();
  }

  bool makes_room(const std::vector<std::size_t>& robots) {
    const bool succeeds = make_room(state_, robots, stop_, progress_);
    const auto with_loads = std::count_if(robots.begin(), robots.end(), [&](std::size_t robot) {
      return state_.instance().views(robot).change();
    });
    progress_.count(Method::room,
                    {std::ssize(robots), succeeds ? std::ssize(robots) : 0, succeeds ? 0 : with_loads});
    return succeeds;
  }

  bool other_orders_may_help(const OrderingResult& ordering) const {
    const auto reordering = state_.instance().options().reordering;
    return reordering == PlanOptions::Reordering::raise_failed &&
           (!has_few_robots() || any_yields(state_.instance())) &&
           ordering.hopeless.size() < ordering.given_up.size();
  }

  /// Plans in random orders as long as a robot that is not hopeless stays.
  void try_other_orders(std::vector<std::size_t> hopeless) {
    const bool has_deadline = time_.all.deadline() != StopCondition::Clock::time_point::max();
    PriorityOrder order = order_;
    for (int k = 0; has_deadline || k < kMaxOrdersWithoutDeadline; ++k) {
      std::erase_if(order, [&](std::size_t robot) {
        return std::find(hopeless.begin(), hopeless.end(), robot) != hopeless.end();
      });
      if (best_->plan.staying.size() <= hopeless.size()) return;
      if (time_.all.met()) break;
      for (const std::size_t robot : order) state_.reservations().remove(robot);
      for (const std::size_t robot : hopeless) state_.reservations().stay_in_place(robot);
      random_.shuffle(order);
      OrderingResult ordering = repair_all(state_, order, steps_, random_, time_.all, progress_);
      result_.attempts += ordering.attempts;
      ordering.given_up.insert(ordering.given_up.end(), hopeless.begin(), hopeless.end());
      hopeless.insert(hopeless.end(), ordering.hopeless.begin(), ordering.hopeless.end());
      keep_if_better(ordering.unsolved, ordering.given_up, Effort::brief, time_.all);
    }
    result_.cut_off = result_.cut_off || has_deadline;
  }

  PlanState& state_;
  Random& random_;
  const PlanningTime& time_;
  ProgressReport& progress_;
  PriorityOrder order_;
  FleetSteps steps_;
  StopCondition stop_;       // ends the first attempt
  Clock::time_point begin_;  // of planning in this order
  const StopCondition half_;
  StopCondition next_look_;  // when to estimate next whether the time suffices
  std::optional<PlanSnapshot> best_;
  PrioritizedResult result_;
};

}  // namespace

PlanningTime PlanningTime::until(const StopCondition& stop) {
  return {after_share(stop, budget::kShareBeforeSafePlan), after_share(stop, budget::kShareWithSafePlan),
          stop};
}

PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const PlanningTime& time, ProgressReport& progress) {
  if (time.all.met()) return all_unplanned(movers);
  return PrioritizedPlanning(state, movers, random, time, progress).run();
}

}  // namespace fleetplan::core
