#include "core/lns/neighbourhood.h"

#include <algorithm>
#include <utility>

#include "core/lns/smoothing.h"
#include "core/model/objective_share.h"

namespace fleetplan::core {
namespace {

bool contains(const std::vector<std::size_t>& robots, std::size_t robot) {
  return std::find(robots.begin(), robots.end(), robot) != robots.end();
}

Position position_at(const Trajectory& trajectory, double time) {
  for (const TimedMove& move : trajectory.moves) {
    if (time < move.t_start) return move.path.from;
    if (time < move.t_end) {
      const double fraction = (time - move.t_start) / move.duration();
      return move.path.from + fraction * (move.path.to - move.path.from);
    }
  }
  return trajectory.end();
}

double distance_to(const Position& point, const Trajectory& trajectory) {
  double least = (trajectory.start - point).norm();
  for (const TimedMove& move : trajectory.moves) {
    least = std::min(least, distance_to_segment(point, move.path));
  }
  return least;
}

}  // namespace

std::vector<std::size_t> NeighbourhoodSelection::select(std::size_t first, Neighbourhood kind,
                                                        std::size_t size, Random& random) {
  size = std::min(size, planned_.size());
  if (size == 1) return {first};
  switch (kind) {
    case Neighbourhood::conflicting:
      return conflicting_with(first, size, random);
    case Neighbourhood::nearest:
      return nearest_to(first, size,
                        distances_at(random.unit() * state_.reservations().trajectory(first)->cost, first));
    case Neighbourhood::at_goal:
      return nearest_to(first, size, distances_to_goal(first, random));
    case Neighbourhood::random:
      return random_with(first, size, random);
  }
  return {first};
}

std::vector<std::size_t> NeighbourhoodSelection::conflicting_with(std::size_t first, std::size_t size,
                                                                  Random& random) {
  std::vector<std::size_t> selected{first};
  // Bounded: `size` robots, each with its conflicts.
  for (std::size_t k = 0; k < selected.size() && selected.size() < size; ++k) {  // selected grows
    std::vector<std::size_t> conflicting =
        state_.reservations().conflicting_robots(selected[k], trajectory_alone(selected[k]));
    random.shuffle(conflicting);
    for (const std::size_t robot : conflicting) {
      const bool full = selected.size() == size;
      if (!full && is_planned_[robot] && !contains(selected, robot)) selected.push_back(robot);
    }
  }
  return selected;
}

/// Returns `first` and the robots of the least `distances`, which are in the order of planned_.
std::vector<std::size_t> NeighbourhoodSelection::nearest_to(std::size_t first, std::size_t size,
                                                            const std::vector<double>& distances) const {
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t k = 0; k < planned_.size(); ++k) {
    if (planned_[k] != first) others.emplace_back(distances[k], planned_[k]);
  }
  const auto end = others.begin() + static_cast<std::ptrdiff_t>(size - 1);
  std::partial_sort(others.begin(), end, others.end());
  std::vector<std::size_t> selected{first};
  for (auto it = others.begin(); it != end; ++it) selected.push_back(it->second);
  return selected;
}

std::vector<std::size_t> NeighbourhoodSelection::random_with(std::size_t first, std::size_t size,
                                                             Random& random) const {
  std::vector<std::size_t> selected{first};
  while (selected.size() < size) {
    const std::size_t robot = planned_[random.below(planned_.size())];
    if (!contains(selected, robot)) selected.push_back(robot);
  }
  return selected;
}

std::vector<double> NeighbourhoodSelection::distances_at(double time, std::size_t first) const {
  const Position center = position_at(*state_.reservations().trajectory(first), time);
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double distance = (position_at(*state_.reservations().trajectory(robot), time) - center).norm();
    distances.push_back(distance - state_.instance().body(robot).pair_radius);
  }
  return distances;
}

std::vector<double> NeighbourhoodSelection::distances_to_goal(std::size_t first, Random& random) const {
  const Position goal = state_.reservations().trajectory(first)->end();
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double distance = distance_to(goal, *state_.reservations().trajectory(robot));
    distances.push_back((0.5 + random.unit()) * distance);  // varied at random
  }
  return distances;
}

const Trajectory& NeighbourhoodSelection::trajectory_alone(std::size_t robot) {
  std::optional<Trajectory>& trajectory = trajectories_alone_[robot];
  if (!trajectory) trajectory = state_.plan_alone(robot, stop_);
  return *trajectory;
}

namespace {

/// A gain below this is rounding, weighted seconds.
constexpr double kLeastGain = 1e-9;
/// The share by which estimates of the cost to go may be too high, about. A search that accepts no
/// suboptimality uses them only to discard what exceeds its bound by this share.
constexpr double kEstimateError = 0.1;
/// The effort of a search before its first expansion, and of smoothing a path: at first, and for each path
/// that is timed; in expansions.
constexpr double kSearchEffort = 20.0;
constexpr double kSmoothingEffort = 20.0;
constexpr double kTimedEffort = 1.0;
/// By how much of its cost a path is expected to be smoothed at most.
constexpr double kMaxSmoothed = 0.1;

class NeighbourhoodPlanning {
 public:
  NeighbourhoodPlanning(PlanState& state, const std::vector<std::size_t>& robots,
                        const TautPathBounds& bounds, const NeighbourhoodOptions& options, Random& random,
                        const StopCondition& stop)
      : state_(state),
        instance_(state.instance()),
        objective_(instance_.options().objective),
        bounds_(bounds),
        options_(options),
        random_(random),
        stop_(stop),
        unplanned_(robots),
        queue_{robots.front()} {}

  NeighbourhoodResult run() {
    const bool accepted = options_.settings ? plan_queue() : smooth_first();
    for (const Change::Part& part : before_) state_.reservations().remove(part.robot);
    for (Change::Part& part : before_) state_.reservations().follow(part.robot, std::move(part.trajectory));
    NeighbourhoodResult result{std::nullopt, expansions_, effort_ + static_cast<double>(expansions_)};
    if (accepted) result.change = std::move(change_);
    return result;
  }

 private:
  double share(std::size_t robot, const Trajectory& trajectory) const {
    return share_of(instance_.itinerary(robot), objective_, trajectory);
  }
  double share(std::size_t robot) const { return share(robot, *state_.reservations().trajectory(robot)); }
  double least_share(std::size_t robot) const {
    return core::least_share(instance_.itinerary(robot), objective_, bounds_[robot]);
  }

  bool plan_queue() {
    for (std::size_t k = 0; k < queue_.size(); ++k) {  // the queue grows
      const std::size_t robot = queue_[k];
      SearchResult result = search(k);
      if (!result.trajectory) return false;
      const double gained = share(robot) - share(robot, *result.trajectory);
      if (k == 0 || options_.gain == NeighbourhoodOptions::Gain::sum) change_.gain += gained;
      std::erase(unplanned_, robot);
      enqueue_conflicting(robot, *result.trajectory);
      change_.parts.push_back({robot, std::move(*result.trajectory)});
      if (k + 1 < queue_.size()) follow_for_now(change_.parts.back());
    }
    return change_.gain > kLeastGain - options_.max_loss;
  }

  bool smooth_first() {
    const std::size_t robot = queue_.front();
    Trajectory trajectory = *state_.reservations().trajectory(robot);
    smooth_path(robot, trajectory);
    change_.gain = share(robot) - share(robot, trajectory);
    change_.parts.push_back({robot, std::move(trajectory)});
    return change_.gain > least_gain(robot);
  }

  void smooth_path(std::size_t robot, Trajectory& trajectory) {
    if (!may_smooth(instance_.options())) return;
    Smoothed smoothed = smooth(state_, robot, trajectory, options_.tries, random_, stop_);
    effort_ += kSmoothingEffort + kTimedEffort * static_cast<double>(smoothed.timed);
    if (smoothed.trajectory) trajectory = std::move(*smoothed.trajectory);
  }

  /// Plans the robot at this position of the queue. At first only the robots in the queue are ignored.
  SearchResult search(std::size_t position) {
    SearchSettings settings = *options_.settings;
    settings.bound = std::min(options_.cost_limit, cost_bound(position));
    if (position > 0) {
      const auto waiting = queue_.begin() + static_cast<std::ptrdiff_t>(position);
      SearchResult result = search({waiting, queue_.end()}, queue_[position], settings);
      const bool all_in_queue = queue_.size() - position == unplanned_.size();
      if (result.trajectory || all_in_queue) return result;
    }
    return search(unplanned_, queue_[position], settings);
  }

  SearchResult search(const std::vector<std::size_t>& ignored, std::size_t robot,
                      const SearchSettings& settings) {
    SearchSettings loose = settings;
    const Trajectory& now = *state_.reservations().trajectory(robot);
    // What it finds may be smoothed as much.
    loose.bound += std::min(now.smoothed_by, kMaxSmoothed * now.cost);
    if (settings.suboptimality == 0.0) loose.bound *= 1.0 + kEstimateError;
    SearchResult result = state_.plan_ignoring(robot, ignored, loose, stop_);
    effort_ += kSearchEffort;
    expansions_ += result.expansions;
    if (!result.trajectory) return result;
    const IgnoredRobots absent(state_.reservations(), ignored);
    smooth_path(robot, *result.trajectory);
    if (result.trajectory->cost >= settings.bound) result.trajectory.reset();
    return result;
  }

  /// What the first robot has to gain.
  double least_gain(std::size_t first) const {
    return std::max(kLeastGain, options_.min_gain_share * (share(first) - least_share(first)));
  }

  /// The least cost at which the robot at this position of the queue would make the change unacceptable.
  double cost_bound(std::size_t position) const {
    const std::size_t robot = queue_[position];
    const double now = share(robot);
    double max_share = now;
    if (position == 0) {  // the change is for its sake, so it has to gain itself
      max_share = now - least_gain(robot);
    } else {
      if (options_.gain == NeighbourhoodOptions::Gain::first) return kForever;
      double possible_gain = 0.0;  // by the robots that follow in the queue
      for (std::size_t k = position + 1; k < queue_.size(); ++k) {
        possible_gain += std::max(0.0, share(queue_[k]) - least_share(queue_[k]));
      }
      max_share = now + change_.gain + possible_gain + options_.max_loss - kLeastGain;
    }
    return cost_with_share(instance_.itinerary(robot), objective_, max_share);
  }

  void enqueue_conflicting(std::size_t robot, const Trajectory& trajectory) {
    if (unplanned_.empty()) return;
    for (const std::size_t other : state_.reservations().conflicting_robots(robot, trajectory)) {
      const bool may_change = std::find(unplanned_.begin(), unplanned_.end(), other) != unplanned_.end();
      if (may_change && std::find(queue_.begin(), queue_.end(), other) == queue_.end()) {
        queue_.push_back(other);
      }
    }
  }

  void follow_for_now(const Change::Part& part) {
    before_.push_back({part.robot, *state_.reservations().trajectory(part.robot)});
    state_.reservations().follow(part.robot, part.trajectory);
  }

  PlanState& state_;
  const Instance& instance_;
  const PlanOptions::Objective objective_;
  const TautPathBounds& bounds_;
  const NeighbourhoodOptions& options_;
  Random& random_;
  const StopCondition& stop_;
  std::vector<std::size_t> unplanned_;  // robots of the neighbourhood without a new trajectory
  std::vector<std::size_t> queue_;      // robots to plan, and robots planned already
  std::vector<Change::Part> before_;    // trajectories that are replaced for now
  Change change_;
  std::int64_t expansions_ = 0;
  double effort_ = 0.0;  // without expansions
};

}  // namespace

NeighbourhoodResult plan_neighbourhood(PlanState& state, const std::vector<std::size_t>& robots,
                                       const TautPathBounds& bounds, const NeighbourhoodOptions& options,
                                       Random& random, const StopCondition& stop) {
  return NeighbourhoodPlanning(state, robots, bounds, options, random, stop).run();
}

}  // namespace fleetplan::core
