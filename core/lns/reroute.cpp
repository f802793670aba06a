#include "core/lns/reroute.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// A gain below this is rounding, seconds.
constexpr double kLeastGain = 1e-9;

class Reroute {
 public:
  Reroute(PlanState& state, const std::vector<std::size_t>& robots, const TautBounds& bounds, const Aim& aim,
          const StopCondition& stop)
      : state_(state), bounds_(bounds), aim_(aim), stop_(stop), free_(robots), queue_{robots.front()} {}

  Rerouting run() {
    const bool found = plan_queue();
    for (const Change::Part& part : before_) state_.remove(part.robot);
    for (Change::Part& part : before_) state_.follow(part.robot, std::move(part.trajectory));
    Rerouting result{std::nullopt, searches_, expansions_};
    if (found) result.change = std::move(change_);
    return result;
  }

 private:
  double cost(std::size_t robot) const { return state_.trajectory(robot)->cost; }

  bool plan_queue() {
    for (std::size_t k = 0; k < queue_.size(); ++k) {  // the queue grows
      const std::size_t robot = queue_[k];
      SearchResult result = search(k);
      if (!result.trajectory) return false;
      const double gained = cost(robot) - result.trajectory->cost;
      if (k == 0 || aim_.gain == Aim::Gain::sum) change_.gain += gained;
      std::erase(free_, robot);
      enqueue_hit(robot, *result.trajectory);
      change_.parts.push_back({robot, std::move(*result.trajectory)});
      if (k + 1 < queue_.size()) try_out(change_.parts.back());
    }
    return change_.gain > kLeastGain;
  }

  SearchResult search(std::size_t place) {
    SearchLimits limits = aim_.limits;
    limits.bound = std::min(aim_.ceiling, most(place));
    if (place > 0) {
      const auto waiting = queue_.begin() + static_cast<std::ptrdiff_t>(place);
      SearchResult result = search({waiting, queue_.end()}, queue_[place], limits);
      const bool all_wait = queue_.size() - place == free_.size();
      if (result.trajectory || all_wait) return result;
    }
    return search(free_, queue_[place], limits);
  }

  SearchResult search(const std::vector<std::size_t>& ignored, std::size_t robot,
                      const SearchLimits& limits) {
    SearchResult result = state_.plan_ignoring(ignored, robot, limits, stop_);
    ++searches_;
    expansions_ += result.expansions;
    return result;
  }

  /// The least cost that would spoil the change for the robot of this place in the queue.
  double most(std::size_t place) const {
    const double now = cost(queue_[place]);
    if (place == 0) {  // if it gains nothing, why begin with it
      return now - std::max(kLeastGain, aim_.ambition * (now - bounds_[queue_[place]]));
    }
    if (aim_.gain == Aim::Gain::first) return kForever;
    double hope = 0.0;
    for (std::size_t k = place + 1; k < queue_.size(); ++k) {
      hope += std::max(0.0, cost(queue_[k]) - bounds_[queue_[k]]);
    }
    return now + change_.gain + hope - kLeastGain;
  }

  void enqueue_hit(std::size_t robot, const Trajectory& trajectory) {
    if (free_.empty()) return;
    for (const std::size_t hit : state_.conflicting_robots(robot, trajectory)) {
      const bool free = std::find(free_.begin(), free_.end(), hit) != free_.end();
      if (free && std::find(queue_.begin(), queue_.end(), hit) == queue_.end()) queue_.push_back(hit);
    }
  }

  void try_out(const Change::Part& part) {
    before_.push_back({part.robot, *state_.trajectory(part.robot)});
    state_.follow(part.robot, part.trajectory);
  }

  PlanState& state_;
  const TautBounds& bounds_;
  const Aim& aim_;
  const StopCondition& stop_;
  std::vector<std::size_t> free_;   // may still be hit
  std::vector<std::size_t> queue_;  // robots to plan, and those planned already
  std::vector<Change::Part> before_;
  Change change_;
  std::int64_t searches_ = 0;
  std::int64_t expansions_ = 0;
};

}  // namespace

Rerouting reroute(PlanState& state, const std::vector<std::size_t>& robots, const TautBounds& bounds,
                  const Aim& aim, const StopCondition& stop) {
  return Reroute(state, robots, bounds, aim, stop).run();
}

}  // namespace fleetplan::core
