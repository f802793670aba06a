#include "core/lns/neighbourhood.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

bool contains(const std::vector<std::size_t>& robots, std::size_t robot) {
  return std::find(robots.begin(), robots.end(), robot) != robots.end();
}

Position position_at(const Trajectory& trajectory, double time) {
  for (const TimedSegment& move : trajectory.moves) {
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
  for (const TimedSegment& move : trajectory.moves) {
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
      return nearest_to(first, size, distances_at(random.unit() * state_.trajectory(first)->cost, first));
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
        state_.conflicting_robots(selected[k], trajectory_alone(selected[k]));
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
  const Position center = position_at(*state_.trajectory(first), time);
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double distance = (position_at(*state_.trajectory(robot), time) - center).norm();
    distances.push_back(distance - state_.instance().motion(robot).pair_radius);
  }
  return distances;
}

std::vector<double> NeighbourhoodSelection::distances_to_goal(std::size_t first, Random& random) const {
  const Position goal = state_.trajectory(first)->end();
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double distance = distance_to(goal, *state_.trajectory(robot));
    distances.push_back((0.5 + random.unit()) * distance);  // varied at random
  }
  return distances;
}

const Trajectory& NeighbourhoodSelection::trajectory_alone(std::size_t robot) {
  std::optional<Trajectory>& trajectory = trajectories_alone_[robot];
  if (!trajectory) trajectory = state_.plan_alone(robot, stop_);
  return *trajectory;
}

}  // namespace fleetplan::core
