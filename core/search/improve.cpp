#include "core/search/improve.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace fleetplan::core {
namespace {

constexpr std::size_t kLargestNeighbourhood = 8;
/// A gain below this is rounding, seconds.
constexpr double kLeastGain = 1e-9;

struct Value {
  double flowtime = 0.0;
  double makespan = 0.0;
};

class Improving {
 public:
  Improving(FleetState& state, std::vector<std::size_t> planned, const TautBounds& bounds, Random& random,
            const StopCondition& stop)
      : state_(state),
        makespan_first_(state.fleet().options().objective == PlanOptions::Objective::makespan),
        planned_(std::move(planned)),
        random_(random),
        stop_(stop),
        bound_(bounds) {}

  Improvement run(std::optional<std::int64_t> max_iterations) {
    Improvement result;
    for (std::int64_t i = 0; !max_iterations || i < *max_iterations; ++i) {
      if (at_lower_bound()) return result;
      if (stop_.met()) {
        result.cut_off = true;
        return result;
      }
      if (try_neighbourhood(choose_neighbourhood())) ++result.improvements;
    }
    result.cut_off = stop_.met();  // perhaps in the last neighbourhood
    return result;
  }

 private:
  double cost(std::size_t robot) const { return state_.trajectory(robot)->cost; }
  double delay(std::size_t robot) const { return cost(robot) - bound_[robot]; }

  bool at_lower_bound() const {
    return std::all_of(planned_.begin(), planned_.end(),
                       [&](std::size_t robot) { return delay(robot) <= kLeastGain; });
  }

  Value value() const {
    Value value;
    for (const std::size_t robot : planned_) {
      value.flowtime += cost(robot);
      value.makespan = std::max(value.makespan, cost(robot));
    }
    return value;
  }

  /// A delayed robot, more likely the more delayed it is; for the makespan, often the last one to arrive.
  std::size_t choose_delayed() {
    const auto by_cost = [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); };
    if (makespan_first_ && random_.below(2) == 0)
      return *std::max_element(planned_.begin(), planned_.end(), by_cost);
    double total = 0.0;
    for (const std::size_t robot : planned_) total += delay(robot);
    double left = random_.unit() * total;
    for (const std::size_t robot : planned_) {
      left -= delay(robot);
      if (left < 0.0) return robot;
    }
    return planned_.back();
  }

  /// A delayed robot, those in the way of the path it would take alone, and some at random.
  std::vector<std::size_t> choose_neighbourhood() {
    const std::size_t size = std::min(planned_.size(), 2 + random_.below(kLargestNeighbourhood - 1));
    std::vector<std::size_t> chosen{choose_delayed()};
    std::vector<std::size_t> in_the_way =
        state_.in_the_way(chosen.front(), state_.alone(chosen.front(), stop_));
    random_.shuffle(in_the_way);
    for (const std::size_t robot : in_the_way) {
      if (chosen.size() < size && state_.trajectory(robot)) chosen.push_back(robot);
    }
    while (chosen.size() < size) {
      const std::size_t robot = planned_[random_.below(planned_.size())];
      if (std::find(chosen.begin(), chosen.end(), robot) == chosen.end()) chosen.push_back(robot);
    }
    return chosen;
  }

  bool try_neighbourhood(std::vector<std::size_t> robots) {
    const Value before = value();
    std::vector<std::pair<std::size_t, Trajectory>> old;
    double old_cost = 0.0;
    double least_cost = 0.0;
    for (const std::size_t robot : robots) {
      old_cost += cost(robot);
      least_cost += bound_[robot];
      old.emplace_back(robot, *state_.trajectory(robot));
      state_.leave(robot);
    }
    random_.shuffle(robots);
    if (replan(robots, old_cost, least_cost, before.makespan) && better(value(), before)) return true;
    for (const std::size_t robot : robots) state_.leave(robot);
    for (auto& [robot, trajectory] : old) state_.follow(robot, std::move(trajectory));
    return false;
  }

  /// Plans the robots again in this order; false as soon as it is clear that nothing is gained.
  bool replan(const std::vector<std::size_t>& robots, double budget, double least, double makespan) {
    for (const std::size_t robot : robots) {
      least -= bound_[robot];
      const double bound = makespan_first_ ? makespan + kLeastGain : budget - least;
      SearchResult result = state_.plan(
          robot, {.bound = bound, .greed = 1.0, .suboptimality = 0.0, .impatience = 0.0, .coarseness = 0.0},
          stop_);
      if (!result.trajectory) return false;
      budget -= result.trajectory->cost;
      state_.follow(robot, std::move(*result.trajectory));
    }
    return true;
  }

  bool better(const Value& a, const Value& b) const {
    if (!makespan_first_) return a.flowtime < b.flowtime - kLeastGain;
    if (a.makespan < b.makespan - kLeastGain) return true;
    return a.makespan <= b.makespan && a.flowtime < b.flowtime - kLeastGain;
  }

  FleetState& state_;
  bool makespan_first_;
  std::vector<std::size_t> planned_;
  Random& random_;
  const StopCondition& stop_;
  const TautBounds& bound_;
};

}  // namespace

Improvement improve(FleetState& state, const std::vector<std::size_t>& movers, const TautBounds& bounds,
                    Random& random, const StopCondition& stop) {
  std::vector<std::size_t> planned;
  for (const std::size_t robot : movers) {
    if (state.trajectory(robot)) planned.push_back(robot);
  }
  return Improving(state, std::move(planned), bounds, random, stop)
      .run(state.fleet().options().max_iterations);
}

}  // namespace fleetplan::core
