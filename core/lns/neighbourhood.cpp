#include "core/lns/neighbourhood.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

void add(std::vector<std::size_t>& chosen, std::size_t robot) {
  if (std::find(chosen.begin(), chosen.end(), robot) == chosen.end()) chosen.push_back(robot);
}

Position position_at(const Trajectory& trajectory, double time) {
  for (const TimedSegment& move : trajectory.moves) {
    if (time < move.t_start) return move.path.from;
    if (time < move.t_end) {
      const double way = (time - move.t_start) / move.duration();
      return move.path.from + way * (move.path.to - move.path.from);
    }
  }
  return trajectory.end();
}

double distance_to(const Position& point, const Segment& path) {
  const Position d = path.to - path.from;
  const double way = std::clamp((point - path.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (path.from + way * d - point).norm();
}

double distance_to(const Position& point, const Trajectory& trajectory) {
  double least = (trajectory.start - point).norm();
  for (const TimedSegment& move : trajectory.moves) least = std::min(least, distance_to(point, move.path));
  return least;
}

}  // namespace

std::vector<std::size_t> Neighbourhoods::around(std::size_t first, Neighbourhood kind, std::size_t size,
                                                Random& random) {
  size = std::min(size, planned_.size());
  std::vector<std::size_t> chosen{first};
  if (size == 1) return chosen;
  switch (kind) {
    case Neighbourhood::conflicting:
      add_those_in_the_way(chosen, size, random);
      break;
    case Neighbourhood::meeting:
      add_nearest(chosen, size, distances_at(random.unit() * state_.trajectory(first)->cost, first));
      break;
    case Neighbourhood::at_goal:
      add_nearest(chosen, size, distances_to_goal(first, random));
      break;
    case Neighbourhood::anybody:
      while (chosen.size() < size) add(chosen, planned_[random.below(planned_.size())]);
      break;
  }
  return chosen;
}

void Neighbourhoods::add_those_in_the_way(std::vector<std::size_t>& chosen, std::size_t size,
                                          Random& random) {
  for (std::size_t k = 0; k < chosen.size() && chosen.size() < size; ++k) {  // chosen grows
    std::vector<std::size_t> conflicting_robots = state_.conflicting_robots(chosen[k], alone(chosen[k]));
    random.shuffle(conflicting_robots);
    for (const std::size_t robot : conflicting_robots) {
      if (chosen.size() < size && state_.trajectory(robot)) add(chosen, robot);
    }
  }
}

/// `distances` as in planned_.
void Neighbourhoods::add_nearest(std::vector<std::size_t>& chosen, std::size_t size,
                                 std::vector<double> distances) const {
  std::vector<std::pair<double, std::size_t>> nearest;
  for (std::size_t k = 0; k < planned_.size(); ++k) {
    if (planned_[k] != chosen.front()) nearest.emplace_back(distances[k], planned_[k]);
  }
  const auto end = nearest.begin() + static_cast<std::ptrdiff_t>(size - 1);
  std::partial_sort(nearest.begin(), end, nearest.end());
  for (auto it = nearest.begin(); it != end; ++it) chosen.push_back(it->second);
}

std::vector<double> Neighbourhoods::distances_at(double time, std::size_t first) const {
  const Position there = position_at(*state_.trajectory(first), time);
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double apart = (position_at(*state_.trajectory(robot), time) - there).norm();
    distances.push_back(apart - state_.instance().motion(robot).radius);
  }
  return distances;
}

std::vector<double> Neighbourhoods::distances_to_goal(std::size_t first, Random& random) const {
  const Position goal = state_.trajectory(first)->end();
  std::vector<double> distances;
  for (const std::size_t robot : planned_) {
    const double apart = distance_to(goal, *state_.trajectory(robot));
    distances.push_back((0.5 + random.unit()) * apart);  // not always the same
  }
  return distances;
}

const Trajectory& Neighbourhoods::alone(std::size_t robot) {
  if (!alone_[robot]) alone_[robot] = state_.plan_alone(robot, stop_);
  return *alone_[robot];
}

}  // namespace fleetplan::core
