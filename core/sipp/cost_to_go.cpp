#include "core/sipp/cost_to_go.h"

#include "core/geometry/angle.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Expansions between two looks at the clock.
constexpr int kStopStride = 64;

}  // namespace

CostToGo::CostToGo(const Instance& instance, std::size_t robot, const Vertices& vertices)
    : instance_(instance),
      robot_(robot),
      motion_(instance.motion(robot)),
      vertices_(vertices),
      start_(instance.robot(robot).start.position),
      nodes_(static_cast<std::size_t>(vertices.count())) {
  Node& goal = node(vertices_.goal());
  goal.state = State::closed;
  vertices_.for_each_neighbour(vertices_.goal(), [&](int vertex) { relax(vertex, vertices_.goal()); });
}

CostToGo::Estimate CostToGo::via(int vertex, int next) {
  const Displacement d = vertices_.between(vertex, next);
  Estimate estimate;
  estimate.heading = d.heading;
  estimate.seconds = motion_.translation_time(d.length) + motion_.wait_before_move;
  if (next != vertices_.goal()) {
    const Node& onward = node(next);
    estimate.seconds += onward.seconds + motion_.rotation_time(estimate.heading, onward.heading);
    const bool goes_on = angle_between(estimate.heading, onward.heading) <= kSameHeading;
    if (goes_on) estimate.seconds -= motion_.wait_before_move;  // both are one translation
  } else if (const auto& goal = *instance_.robot(robot_).goal; goal.theta) {
    estimate.seconds += motion_.rotation_time(estimate.heading, *goal.theta);
  }
  return estimate;
}

bool CostToGo::goal_in_sight(int vertex) {
  Node& n = node(vertex);
  if (!n.sight_known) {
    n.sight_known = true;
    n.in_sight = instance_.sight().may_sweep(vertices_.position(vertex), vertices_.position(vertices_.goal()),
                                             motion_.radius);
  }
  return n.in_sight;
}

void CostToGo::relax(int vertex, int next) {
  Node& n = node(vertex);
  if (n.state == State::closed) return;
  const Estimate estimate = via(vertex, next);
  if (n.state == State::open && estimate.seconds >= n.seconds) return;
  n.state = State::open;
  n.seconds = estimate.seconds;
  n.heading = estimate.heading;
  n.next = next;
  const double ahead = motion_.translation_time((vertices_.position(vertex) - start_).norm());
  open_.push({estimate.seconds + ahead, estimate.seconds, vertex});
}

void CostToGo::close(int vertex) {
  Node& n = node(vertex);
  n.state = State::closed;
  const bool seen = n.next == vertices_.goal()
                        ? goal_in_sight(vertex)
                        : instance_.sight().may_sweep(vertices_.position(vertex), vertices_.position(n.next),
                                                      motion_.radius);
  if (seen) return;
  // Lazy Theta* (Nash, Koenig, Tovey, AAAI 2010): only now is it known that the shortcut is blocked.
  n.seconds = kForever;
  vertices_.for_each_neighbour(vertex, [&](int neighbour) {
    if (neighbour != vertices_.goal() && node(neighbour).state != State::closed) return;
    const Estimate estimate = via(vertex, neighbour);
    if (estimate.seconds >= n.seconds) return;
    n.seconds = estimate.seconds;
    n.heading = estimate.heading;
    n.next = neighbour;
  });
}

void CostToGo::expand_best() {
  const Open best = open_.top();
  open_.pop();
  Node& n = node(best.vertex);
  if (n.state == State::closed || best.seconds > n.seconds) return;
  close(best.vertex);
  const int next = instance_.options().any_angle ? n.next : best.vertex;
  vertices_.for_each_neighbour(best.vertex, [&](int neighbour) { relax(neighbour, next); });
}

CostToGo::Estimate CostToGo::from(int vertex, const StopCondition& stop) {
  if (instance_.options().any_angle && goal_in_sight(vertex)) {
    Estimate estimate = via(vertex, vertices_.goal());
    estimate.straight = true;
    return estimate;
  }
  const Node& n = node(vertex);
  for (int step = 0; n.state != State::closed; ++step) {
    if (open_.empty()) return {kForever, 0.0, false};
    if (step % kStopStride == kStopStride - 1 && stop.met()) return via(vertex, vertices_.goal());
    expand_best();
  }
  return {n.seconds, n.heading, false};
}

}  // namespace fleetplan::core
