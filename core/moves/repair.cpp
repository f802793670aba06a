#include "core/moves/repair.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/moves/ejection_search.h"
#include "core/moves/yielding.h"

namespace fleetplan::core {
namespace {

/// The failures of a robot after which it is given up. In the paper's halls with 300 robots none failed more
/// than 5 times.
constexpr int kMaxFailuresOfRobot = 40;
/// How often robots that yield are asked to make way for one robot. After that, it may be in a cycle with
/// others, which changes of the order break.
constexpr int kMaxAsksForRobot = 5;
/// The failures of a robot after which others are no longer ejected for it. It may be in a cycle that only a
/// start delay breaks. In crowds that fill two fifths of the floor, hardly any robot fails so often.
constexpr int kMaxEjectionsForRobot = 10;
/// The expansions after which a quick search has failed, if they exceed half of the vertices, too: most often
/// there is no path. In the paper's crowds none takes 5,000.
constexpr std::int64_t kMaxQuickExpansions = 20'000;
/// From this number of expansions in all, the time of a large fleet matters more than the last percents of
/// its cost. A search that takes more than kFewExpansions is then made again with the greater weight. 1000
/// robots on den520d then take 0.7 of the time, for 1.02 of the flowtime.
constexpr std::int64_t kManyExpansions = 400'000;
constexpr std::int64_t kFewExpansions = 500;
constexpr double kGreedyWeight = 4.0;
/// The weight once a robot has failed: in crowds, most robots are planned several times.
constexpr double kCrowdWeight = 2.0;
/// Expansions for each robot after which all are planned at once, in steps. Disks that fill two fifths of the
/// paper's crowds take up to 1200; in a warehouse with corridors of one cell, 600 robots take 8000.
constexpr std::int64_t kExpansionsBeforeSteps = 1'500;
/// Expansions for each robot after which steps are tried once a robot has failed, to have a plan whatever
/// happens. With such a plan, repairs end after the second number. Crowds that repairs can plan take at most
/// 270. The paper's halls with walls take up to 1060, but steps mostly fail there.
constexpr std::int64_t kExpansionsBeforeKeeping = 400;
constexpr std::int64_t kExpansionsWithSteps = 1'000;
/// Failures, in addition to one for each robot, after which all robots are planned in steps, too. 400 disks
/// take less than 250, and 800 on 1024 cells come to no end.
constexpr std::int64_t kFailuresBeforeSteps = 100;

constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();

/// Returns the settings of the first search of a robot. It is incomplete: when it fails, others follow.
SearchSettings quick_search(const Lattice& lattice) {
  SearchSettings settings;
  settings.thorough = false;
  settings.max_expansions = std::max<std::int64_t>(kMaxQuickExpansions, lattice.vertex_count() / 2);
  return settings;
}

/// The maximum number of robots outside a cycle whose ranks are shuffled along with it.
constexpr int kMaxExtraRobots = 12;

class Repair {
 public:
  /// `steps`: null if there are none.
  Repair(PlanState& state, PriorityOrder order, FleetSteps* steps, Random& random, const StopCondition& stop,
         ProgressReport& progress, const RepairPace& pace)
      : state_(state),
        reservations_(state.reservations()),
        any_yields_(any_yields(state.instance())),
        order_(std::move(order)),
        steps_(steps),
        random_(random),
        stop_(stop),
        progress_(progress),
        pace_(pace),
        rank_(state.instance().size(), 0),
        lowest_rank_(static_cast<std::int64_t>(order_.size())),
        failures_(state.instance().size(), 0),
        asks_(state.instance().size(), 0),
        cannot_make_way_(state.instance().size(), false),
        ejection_(state, random, stop),
        expansions_(state.expansions()) {
    for (std::size_t k = 0; k < order_.size(); ++k) rank_[order_[k]] = static_cast<std::int64_t>(k);
  }

  void postpone_all() {
    for (const std::size_t robot : order_) postpone(robot);
  }

  void postpone_those_without_trajectory() {
    for (const std::size_t robot : order_) {
      if (!reservations_.trajectory(robot)) postpone(robot);
    }
  }

  /// Returns none as soon as so many attempts have failed.
  std::optional<OrderingResult> run(std::int64_t max_failures = kAnyNumber) {
    while (!pending_.empty() && goes_on()) {
      if (result_.attempts > max_failures) return std::nullopt;
      if (may_be_stuck()) keep_steps();
      if (is_stuck() && plans_all_in_steps()) break;
      progress_.update();
      const std::size_t robot = pending_.begin()->second;
      pending_.erase(pending_.begin());
      reservations_.remove(robot);
      SearchResult result = plan_quickly(robot);
      if (is_held_up(robot, result) && passes_yielding(robot, result)) continue;
      if (result.trajectory) {
        reservations_.follow(robot, std::move(*result.trajectory));
        state_.memory().expect_use(robot, SearchMemory::kHardlyEver);
        continue;
      }
      if (has_failed(robot, result)) {
        if (state_.instance().itinerary(robot).yields()) cannot_make_way_[robot] = true;
        result = plan_failed(robot);
      }
      if (result.trajectory) {
        follow_and_postpone_conflicting(robot, std::move(*result.trajectory));
      } else if (result.complete) {
        give_up(robot);
      } else {
        postpone(robot);
        if (!stop_.met()) break;
      }
    }
    // Repairs may have given up robots that have a plan in steps.
    if (kept_steps_ && result_.given_up.size() > kept_steps_->given_up.size()) follow_kept_steps();
    if (kept_steps_) result_.steps.reset();  // the plan is not in steps
    result_.unsolved = unsolved();
    result_.cut_off = result_.cut_off || !result_.unsolved.empty();
    return std::move(result_);
  }

 private:
  /// A plan in steps of all robots that were not hopeless by then.
  struct KeptSteps {
    FleetReservations::Snapshot reservations;
    std::vector<std::size_t> given_up;
  };

  /// Whether repairs go on; if so, robots are pending.
  bool goes_on() {
    state_.memory().relieve();
    const bool is_due = !kept_steps_ && pace_.is_due && pace_.is_due();
    if (!stop_.met() && !is_due) return true;
    if (kept_steps_) {
      result_.cut_off = true;
      return !follow_kept_steps();
    }
    if (!pace_.on_stop) return false;
    result_.unsolved = unsolved();
    if (!pace_.on_stop(result_)) return false;
    resume_if_changed();
    return !pending_.empty();
  }

  /// Others may have planned robots meanwhile, or stopped some.
  void resume_if_changed() {
    const bool is_changed = std::any_of(pending_.begin(), pending_.end(), [&](const auto& pending) {
      return reservations_.trajectory(pending.second) || reservations_.stays(pending.second);
    });
    if (!is_changed) return;
    pending_.clear();
    for (const std::size_t robot : order_) {
      const auto& given_up = result_.given_up;
      if (std::find(given_up.begin(), given_up.end(), robot) != given_up.end()) continue;
      if (!reservations_.trajectory(robot)) postpone(robot);
    }
  }

  /// Whether failures may have no end.
  bool is_stuck() const {
    if (steps_ == nullptr || result_.attempts < 2) return false;
    const auto robots = static_cast<std::int64_t>(order_.size());
    return result_.attempts > robots + kFailuresBeforeSteps ||
           used_expansions() > robots * (kept_steps_ ? kExpansionsWithSteps : kExpansionsBeforeSteps);
  }

  /// Whether steps are tried before failures have come to that, to have a plan whatever time is left.
  bool may_be_stuck() const {
    if (steps_ == nullptr || result_.attempts < 2 || result_.steps) return false;
    return used_expansions() > kExpansionsBeforeKeeping * std::ssize(order_);
  }

  std::int64_t used_expansions() const { return state_.expansions() - expansions_; }

  /// Keeps a plan of all robots in steps, if there is one, and returns to where repairs were.
  void keep_steps() {
    FleetReservations::Snapshot before = reservations_.snapshot();
    result_.steps = steps_->follow(order_, result_.hopeless, stop_);
    result_.cut_off = result_.cut_off || result_.steps == StepsOutcome::cut_off;
    if (result_.steps != StepsOutcome::followed) return;
    kept_steps_ = KeptSteps{reservations_.snapshot(), result_.hopeless};
    reservations_.restore(std::move(before));
  }

  /// All robots but those that were hopeless by then follow the plan that was kept. Returns true.
  bool follow_kept_steps() {
    ++result_.attempts;
    reservations_.restore(std::move(kept_steps_->reservations));
    result_.given_up = std::move(kept_steps_->given_up);
    result_.hopeless = result_.given_up;
    kept_steps_.reset();
    pending_.clear();
    return true;
  }

  /// Returns whether all robots except the hopeless ones have new trajectories. If not, nothing has changed.
  bool plans_all_in_steps() {
    if (kept_steps_) return follow_kept_steps();
    const StepsOutcome outcome = std::exchange(steps_, nullptr)->follow(order_, result_.hopeless, stop_);
    result_.steps = outcome;
    if (outcome != StepsOutcome::followed) return false;
    ++result_.attempts;
    pending_.clear();
    result_.given_up = result_.hopeless;
    return true;
  }

  /// Returns the robots without a trajectory, by priority.
  std::vector<std::size_t> unsolved() const {
    std::vector<std::size_t> robots;
    robots.reserve(pending_.size());
    for (const auto& [rank, robot] : pending_) robots.push_back(robot);
    return robots;
  }

  void postpone(std::size_t robot) {
    reservations_.reserve_place(robot, state_.instance().options().start_safe_interval);
    pending_.insert({rank_[robot], robot});
  }

  void follow_and_postpone_conflicting(std::size_t robot, Trajectory trajectory) {
    std::vector<std::size_t> conflicting = reservations_.conflicting_robots(robot, trajectory);
    reservations_.follow(robot, std::move(trajectory));
    std::erase_if(conflicting, [&](std::size_t other) { return !reservations_.trajectory(other); });
    if (ejects(robot)) {  // the ejected robots are planned next
      for (const std::size_t other : conflicting) rank_[other] = --highest_rank_;
    } else if (!conflicting.empty()) {
      conflicting = shuffle_ranks(robot, std::move(conflicting));
    }
    for (const std::size_t other : conflicting) postpone(other);
  }

  /// Whether others are ejected for this robot, which failed.
  bool ejects(std::size_t robot) const { return failures_[robot] <= kMaxEjectionsForRobot; }
  /// Whether a robot has failed.
  bool is_crowded() const { return result_.attempts > 1; }

  SearchSettings quick_search_of(std::size_t robot) const {
    return quick_search(state_.instance().lattice(robot));
  }

  SearchResult plan_quickly(std::size_t robot) {
    SearchSettings settings = quick_search_of(robot);
    if (is_crowded()) settings.heuristic_weight = kCrowdWeight;
    if (state_.expansions() < kManyExpansions) return state_.plan(robot, settings, stop_);
    settings.max_expansions = kFewExpansions;
    SearchResult result = state_.plan(robot, settings, stop_);
    if (result.trajectory || result.complete || result.expansions < kFewExpansions) return result;
    settings = quick_search_of(robot);
    settings.heuristic_weight = kGreedyWeight;
    return state_.plan(robot, settings, stop_);
  }

  /// Whether a search ended without a trajectory, but not because the time or the memory is spent.
  bool has_failed(std::size_t robot, const SearchResult& result) const {
    return !result.trajectory &&
           (result.complete || result.expansions >= quick_search_of(robot).max_expansions);
  }

  /// The cost of making way, about, seconds: there and back over a few radii, with two turns.
  double cost_of_making_way(std::size_t robot) const {
    constexpr double kRadii = 4.0;
    const Body& body = state_.instance().body(robot);
    return body.translation_time(kRadii * body.pair_radius) + 2.0 * body.rotation_time(0.0, std::numbers::pi);
  }

  /// Whether robots that yield may be what keeps this one from its goals, or makes it late.
  bool is_held_up(std::size_t robot, const SearchResult& result) {
    if (!any_yields_ || asks_[robot] >= kMaxAsksForRobot) return false;
    if (!result.trajectory) return has_failed(robot, result);
    if (result.trajectory->gains_nothing) return true;
    const double in_time = state_.ways().estimated_alone(robot, stop_) + cost_of_making_way(robot);
    return result.trajectory->cost > in_time;
  }

  /// The most that the robot may cost past robots that yield, so that moving one of them is worth it.
  double max_cost(std::size_t robot, const SearchResult& in_place) const {
    if (!in_place.trajectory || in_place.trajectory->gains_nothing) return kForever;
    return in_place.trajectory->cost - cost_of_making_way(robot);
  }

  /// Whether the robots that would have to make way can do so, as far as is known, and cost less than it is
  /// worth. `saved`: seconds.
  bool is_worth(double saved, const std::vector<std::size_t>& asked) const {
    for (const std::size_t other : asked) {
      if (cannot_make_way_[other]) return false;
      saved -= cost_of_making_way(other);
    }
    return saved >= 0.0;
  }

  /// Plans a robot past robots that yield, if that is worth it compared to its trajectory around them. The
  /// yielding robots in its way are planned again. Among them, robots without goals of their own come after
  /// all others. Returns whether the robot has a plan now.
  bool passes_yielding(std::size_t robot, const SearchResult& in_place) {
    ++asks_[robot];
    SearchSettings settings = quick_search_of(robot);
    settings.bound = max_cost(robot, in_place);
    SearchResult result = plan_past_yielding(state_, robot, settings, stop_);
    if (!result.trajectory || result.trajectory->gains_nothing) return false;
    const std::vector<std::size_t> asked = reservations_.conflicting_robots(robot, *result.trajectory);
    const bool needs = settings.bound == kForever;
    if (!needs && !is_worth(in_place.trajectory->cost - result.trajectory->cost, asked)) return false;
    if (comes_after(robot, asked, settings.bound)) return true;
    reservations_.follow(robot, std::move(*result.trajectory));
    for (const std::size_t other : asked) {
      if (!reservations_.trajectory(other)) continue;
      if (state_.instance().itinerary(other).is_idle) rank_[other] = ++lowest_rank_;
      postpone(other);
    }
    return true;
  }

  /// Plans others so that they leave the goal of this robot once they have been served, and then plans this
  /// robot. So it does not wait in their way out. Returns whether it has a plan now; if not, nothing has
  /// changed.
  bool comes_after(std::size_t robot, const std::vector<std::size_t>& others, double max_cost) {
    std::vector<std::pair<std::size_t, Trajectory>> before;
    for (const std::size_t other : others) {
      if (!reservations_.trajectory(other) || state_.instance().itinerary(other).is_idle) continue;
      SearchResult leaving = plan_making_way(state_, other, robot, quick_search_of(other), stop_);
      if (!leaving.trajectory) continue;
      before.emplace_back(other, *reservations_.trajectory(other));
      reservations_.follow(other, std::move(*leaving.trajectory));
    }
    if (before.empty()) return false;
    SearchResult result = plan_quickly(robot);
    if (result.trajectory && !result.trajectory->gains_nothing && result.trajectory->cost < max_cost) {
      reservations_.follow(robot, std::move(*result.trajectory));
      return true;
    }
    for (auto& [other, trajectory] : before) reservations_.follow(other, std::move(trajectory));
    return false;
  }

  /// Plans a robot that failed among all others. The one whose whole way is planned gives way only if all
  /// others do not suffice.
  SearchResult plan_failed(std::size_t robot) {
    ++result_.attempts;
    progress_.next_attempt();
    if (++failures_[robot] > kMaxFailuresOfRobot) return {};
    const auto& whole = state_.whole_way_of();
    if (whole && *whole != robot && reservations_.trajectory(*whole)) {
      keeps_its_way_ = *whole;
      SearchResult result = make_way_for(robot);
      keeps_its_way_.reset();
      if (result.trajectory) return result;
    }
    return make_way_for(robot);
  }

  SearchResult make_way_for(std::size_t robot) {
    if (!ejects(robot)) return plan_among_fewer(robot);
    return ejection_.plan(robot, planned_robots([](std::size_t) { return true; }), failures_);
  }

  /// Plans a robot among fewer others; see repair_all(). Smaller robots are ignored before larger ones,
  /// because they find another path more easily.
  SearchResult plan_among_fewer(std::size_t robot) {
    const double radius = state_.instance().body(robot).pair_radius;
    const auto is_lower = [&](std::size_t other) { return rank_[other] > rank_[robot]; };
    const auto lower = planned_robots(is_lower);
    const auto lower_or_smaller = planned_robots([&](std::size_t other) {
      return is_lower(other) || state_.instance().body(other).pair_radius < radius;
    });
    const auto all = planned_robots([](std::size_t) { return true; });
    if (!lower.empty()) {
      SearchResult result = state_.plan_ignoring(robot, lower, quick_search_of(robot), stop_);
      if (!has_failed(robot, result)) return result;
    }
    rank_[robot] = --highest_rank_;
    if (lower_or_smaller.size() > lower.size() && lower_or_smaller.size() < all.size()) {
      SearchResult result = state_.plan_ignoring(robot, lower_or_smaller, quick_search_of(robot), stop_);
      if (!has_failed(robot, result)) return result;
    }
    // A delay gives the others time to get out of its way.
    const double delay = random_start_delay(state_.instance(), order_, random_);
    SearchResult result = state_.plan_ignoring(robot, all, {.start_delay = delay}, stop_);
    if (!has_failed(robot, result)) return result;
    return state_.plan_ignoring(robot, all, {}, stop_);
  }

  /// Returns the robots with a trajectory that satisfy the condition and may give way, by order.
  template <class Condition>
  std::vector<std::size_t> planned_robots(Condition&& condition) const {
    std::vector<std::size_t> found;
    for (const std::size_t other : order_) {
      if (reservations_.trajectory(other) && other != keeps_its_way_ && condition(other))
        found.push_back(other);
    }
    return found;
  }

  /// Breaks a cycle: the robots that conflict with `robot`, and the more others the longer the cycle lasts,
  /// exchange their ranks at random. Returns all of them.
  std::vector<std::size_t> shuffle_ranks(std::size_t robot, std::vector<std::size_t> robots) {
    int extra = std::min(failures_[robot] - kMaxEjectionsForRobot, kMaxExtraRobots);
    for (; extra > 0; --extra) {
      const std::size_t other = order_[random_.below(order_.size())];
      const bool known = std::find(robots.begin(), robots.end(), other) != robots.end();
      if (!known && other != robot && reservations_.trajectory(other)) robots.push_back(other);
    }
    for (std::size_t i = robots.size(); i > 1; --i) {
      std::swap(rank_[robots[i - 1]], rank_[robots[random_.below(i)]]);
    }
    return robots;
  }

  void give_up(std::size_t robot) {
    reservations_.stay_in_place(robot);
    for (const std::size_t other : reservations_.robots_crossing_place(robot)) {
      if (reservations_.trajectory(other)) postpone(other);
    }
    if (state_.instance().itinerary(robot).is_idle) return;  // it need not move
    const bool others_may_move = result_.hopeless.size() < result_.given_up.size();
    if (failures_[robot] <= kMaxFailuresOfRobot && !others_may_move) result_.hopeless.push_back(robot);
    result_.given_up.push_back(robot);
  }

  PlanState& state_;
  FleetReservations& reservations_;
  const bool any_yields_;
  const PriorityOrder order_;
  FleetSteps* steps_;  // null if there are none, or none any more
  Random& random_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  const RepairPace& pace_;
  std::vector<std::int64_t> rank_;  // by robot; a smaller rank is a higher priority
  std::int64_t highest_rank_ = 0;
  std::int64_t lowest_rank_;
  std::vector<int> failures_;                 // by robot
  std::vector<int> asks_;                     // by robot: how often others were asked to make way for it
  std::vector<bool> cannot_make_way_;         // by robot: it was asked, and failed
  std::optional<std::size_t> keeps_its_way_;  // a robot that gives way to nobody
  std::optional<KeptSteps> kept_steps_;
  EjectionSearch ejection_;
  const std::int64_t expansions_;                           // before these repairs
  std::set<std::pair<std::int64_t, std::size_t>> pending_;  // rank, robot
  OrderingResult result_;
};

}  // namespace

OrderingResult repair_all(PlanState& state, const PriorityOrder& order, FleetSteps& steps, Random& random,
                          const StopCondition& stop, ProgressReport& progress, const RepairPace& pace) {
  return *repair_unless(kAnyNumber, state, order, steps, random, stop, progress, pace);
}

std::optional<OrderingResult> repair_unless(std::int64_t max_failures, PlanState& state,
                                            const PriorityOrder& order, FleetSteps& steps, Random& random,
                                            const StopCondition& stop, ProgressReport& progress,
                                            const RepairPace& pace) {
  progress.next_attempt();
  Repair repair(state, order, &steps, random, stop, progress, pace);
  repair.postpone_all();
  return repair.run(max_failures);
}

OrderingResult repair_around(PlanState& state, const PriorityOrder& order, Random& random,
                             const StopCondition& stop, ProgressReport& progress, const RepairPace& pace) {
  progress.next_attempt();
  Repair repair(state, order, nullptr, random, stop, progress, pace);
  repair.postpone_those_without_trajectory();
  return *repair.run();
}

}  // namespace fleetplan::core
