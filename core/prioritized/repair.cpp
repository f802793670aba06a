#include "core/prioritized/repair.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace fleetplan::core {
namespace {

/// A robot that failed more often than this may be in a cycle of robots that raise each other.
constexpr int kPatience = 3;
/// A robot that failed more often than this is given up. In the paper's halls with 300 robots none failed
/// more than 5 times.
constexpr int kHopeless = 40;
/// After so many failures, of any robots, it is quicker to start again with the larger ones first: measured
/// in the paper's hall with rectangles and 240 to 300 robots, where 10 to 20 made no difference.
constexpr std::int64_t kMostFailures = 15;
/// For a first look: there are other ways out when it fails.
constexpr SearchLimits kQuick{.thorough = false};
/// At most so many uninvolved robots are taken back along with a cycle.
constexpr int kMostExtra = 12;

class Repair {
 public:
  Repair(PlanState& state, PriorityOrder order, Random& random, const StopCondition& stop,
         ProgressReport& progress)
      : state_(state),
        order_(std::move(order)),
        random_(random),
        stop_(stop),
        progress_(progress),
        rank_(state.instance().size(), 0),
        failures_(state.instance().size(), 0) {
    for (std::size_t k = 0; k < order_.size(); ++k) {
      rank_[order_[k]] = static_cast<std::int64_t>(k);
      take_back(order_[k]);
    }
  }

  /// None if there are more than `most_failures` before it is done.
  std::optional<RepairResult> run(std::int64_t most_failures) {
    while (!pending_.empty() && !stop_.met()) {
      if (result_.attempts > most_failures) return std::nullopt;
      progress_.update();
      const std::size_t robot = pending_.begin()->second;
      pending_.erase(pending_.begin());
      state_.leave(robot);
      SearchResult result = state_.plan(robot, kQuick, stop_);
      if (result.trajectory) {
        state_.follow(robot, std::move(*result.trajectory));
        continue;
      }
      if (result.complete) result = after_failure(robot);
      if (result.trajectory) {
        settle(robot, std::move(*result.trajectory));
      } else if (result.complete) {
        give_up(robot);
      } else {
        take_back(robot);
        break;
      }
    }
    for (const auto& [rank, robot] : pending_) result_.unsolved.push_back(robot);
    return std::move(result_);
  }

 private:
  void take_back(std::size_t robot) {
    state_.block_start(robot, state_.instance().options().start_safe_interval);
    pending_.insert({rank_[robot], robot});
  }

  /// Follows the trajectory and takes back whatever it crosses.
  void settle(std::size_t robot, Trajectory trajectory) {
    std::vector<std::size_t> crossed = state_.conflicting_robots(robot, trajectory);
    state_.follow(robot, std::move(trajectory));
    std::erase_if(crossed, [&](std::size_t other) { return !state_.trajectory(other); });
    if (!crossed.empty() && failures_[robot] > kPatience) shuffle_ranks(robot, crossed);
    for (const std::size_t other : crossed) take_back(other);
  }

  /// Plans a robot that found no way among all others: among the higher ranked; or else raised to the top,
  /// among the larger ones of them, since the smaller more easily find another way; or else among nobody.
  SearchResult after_failure(std::size_t robot) {
    ++result_.attempts;
    progress_.next_attempt();
    if (++failures_[robot] > kHopeless) return {};
    const double radius = state_.instance().motion(robot).radius;
    const auto is_lower = [&](std::size_t other) { return rank_[other] > rank_[robot]; };
    const auto lower = followers(is_lower);
    const auto yielding = followers([&](std::size_t other) {
      return is_lower(other) || state_.instance().motion(other).radius < radius;
    });
    const auto all = followers([](std::size_t) { return true; });
    if (!lower.empty()) {
      SearchResult result = state_.plan_ignoring(lower, robot, kQuick, stop_);
      if (result.trajectory || !result.complete) return result;
    }
    rank_[robot] = --top_;
    if (yielding.size() > lower.size() && yielding.size() < all.size()) {
      SearchResult result = state_.plan_ignoring(yielding, robot, kQuick, stop_);
      if (result.trajectory || !result.complete) return result;
    }
    if (failures_[robot] > kPatience) {  // those in its way may need time to get out of it
      SearchResult result = state_.plan_ignoring(
          all, robot, {.start_delay = random_start_delay(state_.instance(), order_, random_)}, stop_);
      if (result.trajectory || !result.complete) return result;
    }
    return state_.plan_ignoring(all, robot, {}, stop_);
  }

  /// The robots with a trajectory that fulfil the condition, by order.
  template <class Condition>
  std::vector<std::size_t> followers(Condition&& condition) const {
    std::vector<std::size_t> found;
    for (const std::size_t other : order_) {
      if (state_.trajectory(other) && condition(other)) found.push_back(other);
    }
    return found;
  }

  /// Breaks a cycle: the robots involved, and some others the longer it lasts, exchange their ranks at
  /// random.
  void shuffle_ranks(std::size_t robot, std::vector<std::size_t>& crossed) {
    for (int extra = std::min(failures_[robot] - kPatience, kMostExtra); extra > 0; --extra) {
      const std::size_t other = order_[random_.below(order_.size())];
      const bool known = std::find(crossed.begin(), crossed.end(), other) != crossed.end();
      if (!known && other != robot && state_.trajectory(other)) crossed.push_back(other);
    }
    for (std::size_t i = crossed.size(); i > 1; --i) {
      std::swap(rank_[crossed[i - 1]], rank_[crossed[random_.below(i)]]);
    }
  }

  void give_up(std::size_t robot) {
    result_.given_up.push_back(robot);
    state_.stand_for_ever(robot);
    for (const std::size_t other : state_.robots_conflicting_with_standing(robot)) {
      if (state_.trajectory(other)) take_back(other);
    }
  }

  PlanState& state_;
  const PriorityOrder order_;
  Random& random_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  std::vector<std::int64_t> rank_;  // by robot; smaller is higher
  std::int64_t top_ = 0;
  std::vector<int> failures_;                               // by robot
  std::set<std::pair<std::int64_t, std::size_t>> pending_;  // rank, robot
  RepairResult result_;
};

bool differ_in_size(const Instance& instance, const PriorityOrder& order) {
  return std::any_of(order.begin(), order.end(), [&](std::size_t robot) {
    return instance.motion(robot).radius != instance.motion(order.front()).radius;
  });
}

PriorityOrder larger_first(const Instance& instance, PriorityOrder order) {
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return instance.motion(a).radius > instance.motion(b).radius;
  });
  return order;
}

}  // namespace

RepairResult plan_with_repair(PlanState& state, const PriorityOrder& order, Random& random,
                              const StopCondition& stop, ProgressReport& progress) {
  constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();
  progress.next_attempt();
  if (!differ_in_size(state.instance(), order)) {
    return *Repair(state, order, random, stop, progress).run(kAnyNumber);
  }
  if (auto result = Repair(state, order, random, stop, progress).run(kMostFailures))
    return std::move(*result);
  RepairResult result =
      *Repair(state, larger_first(state.instance(), order), random, stop, progress).run(kAnyNumber);
  result.attempts += kMostFailures;
  return result;
}

}  // namespace fleetplan::core
