#include "core/sipp/times_from_start.h"

#include <algorithm>
#include <cstddef>

#include "core/sipp/vertices.h"

namespace fleetplan::core {
namespace {

/// Expansions between two checks of the stop condition.
constexpr std::int64_t kCheckStride = 256;

}  // namespace

TimesFromStart::TimesFromStart(const Vertices& vertices, int start, int goal)
    : vertices_(vertices),
      goal_(goal),
      goal_position_(vertices.position(goal)),
      times_(static_cast<std::size_t>(vertices.count())) {
  open(start, 0.0F);
}

std::optional<bool> TimesFromStart::reach_goal(std::int64_t max_expansions, const StopCondition& stop) {
  for (std::int64_t count = 0; !reached_goal_; ++count) {
    if (open_.empty()) return false;
    if (count >= max_expansions || (count % kCheckStride == 0 && stop.met())) return std::nullopt;
    ++expansions_;
    const Open best = open_.top();
    open_.pop();
    if (best.seconds > time(best.vertex)) continue;
    reached_goal_ = best.vertex == goal_;
    if (!reached_goal_) expand(best);
  }
  open_ = {};
  return true;
}

void TimesFromStart::expand(const Open& best) {
  const Position here = vertices_.position(best.vertex);
  const double speed = vertices_.linear_speed(best.vertex);
  vertices_.for_each_neighbour(best.vertex, [&](int neighbour) {
    if (!vertices_.allow(best.vertex, neighbour)) return;
    const double length = (vertices_.position(neighbour) - here).norm();
    const auto through = static_cast<float>(best.seconds + length / speed);
    if (through < time(neighbour)) open(neighbour, through);
  });
}

void TimesFromStart::open(int vertex, float seconds) {
  time(vertex) = seconds;
  open_.push({static_cast<float>(seconds + to_goal(vertex)), seconds, vertex});
}

double TimesFromStart::to_goal(int vertex) const {
  return vertices_.motion().translation_time((vertices_.position(vertex) - goal_position_).norm());
}

/// No way to the goal is faster than the one found, so a vertex off it is at least so far from the start that
/// a straight line to the goal makes it as slow.
double TimesFromStart::at_least(int vertex) {
  if (!reached_goal_) return 0.0;
  return std::clamp<double>(time(goal_) - to_goal(vertex), 0.0, time(vertex));
}

}  // namespace fleetplan::core
