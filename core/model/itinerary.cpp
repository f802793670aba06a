#include "core/model/itinerary.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/geometry/position.h"

namespace fleetplan::core {
namespace {

/// Seconds; far above the rounding of times, far below what any robot does.
constexpr double kRounding = 1e-6;

Trajectory committed_trajectory(const Robot& robot) {
  Trajectory trajectory;
  trajectory.start = robot.start.position;
  for (const Action& action : robot.committed) {
    if (action.type != Action::Type::translate || action.from.position == action.to.position) continue;
    const Segment path{action.from.position, action.to.position};
    trajectory.moves.push_back({{path, action.t_start, action.t_end}, action.profile, action.reverse});
  }
  trajectory.cost = robot.committed_until();
  return trajectory;
}

double direct_way(const Robot& robot) {
  double length = 0.0;
  Position from = robot.committed_end().position;
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    const Position& to = robot.goal_at(k).position;
    length += (to - from).norm();
    from = to;
  }
  return length;
}

}  // namespace

double Itinerary::radius_after_goals(std::size_t served) const {
  for (std::size_t k = std::min(served, radius_after.size()); k > 0; --k) {
    if (radius_after[k - 1]) return *radius_after[k - 1];
  }
  return load.radius;
}

double Itinerary::largest_radius() const {
  double largest = load.radius;
  for (const std::optional<double>& radius : radius_after)
    largest = std::max(largest, radius.value_or(largest));
  return largest;
}

Itinerary itinerary_of(const Robot& robot) {
  Itinerary itinerary;
  itinerary.committed = committed_trajectory(robot);
  itinerary.pose = robot.committed_end();
  itinerary.t_begin = robot.committed_until();
  itinerary.is_committed = !robot.committed.empty();
  if (itinerary.is_committed) {
    ServedGoals served = served_goals(robot, robot.committed);
    itinerary.visited = std::move(served.visits);
    itinerary.first_goal = itinerary.visited.size();
    itinerary.arrived = served.arrived;
    itinerary.service_done = served.service_done;
  }
  for (std::size_t k = itinerary.first_goal; k < robot.goal_count(); ++k) {
    itinerary.goals.push_back(robot.goal_at(k));
  }
  itinerary.load = first_load(robot);
  for (std::size_t k = 0; changes_radius(robot) && k < robot.goal_count(); ++k) {
    itinerary.radius_after.push_back(robot.goal_at(k).radius_after);
  }
  itinerary.is_invalid = robot.invalid;
  itinerary.is_idle = robot.is_idle();
  itinerary.weight = robot.weight;
  itinerary.goal_age = robot.goal_age;
  itinerary.direct_way = direct_way(robot);
  return itinerary;
}

std::vector<Itinerary> itineraries_of(std::span<const Robot> robots) {
  std::vector<Itinerary> itineraries;
  itineraries.reserve(robots.size());
  for (const Robot& robot : robots) itineraries.push_back(itinerary_of(robot));
  return itineraries;
}

bool has_arrived(const Itinerary& itinerary) {
  const bool has_one_goal = itinerary.first_goal + itinerary.goals.size() == 1;
  return has_one_goal && itinerary.last_goal().service == 0.0 &&
         is_in_pose(itinerary.pose, itinerary.last_goal());
}

std::vector<RadiusStep> radius_steps(const Itinerary& itinerary, std::span<const Visit> visits) {
  std::vector<RadiusStep> steps;
  if (itinerary.radius_after.empty()) return steps;
  for (const Visit& visit : visits) {
    const std::optional<double>& radius = itinerary.radius_after[visit.goal];
    if (radius && visit.t_leave < kForever) steps.push_back({visit.t_leave, *radius});
  }
  return steps;
}

std::vector<SizedSegment> with_radii(const std::vector<TimedSegment>& segments, double first,
                                     const std::vector<RadiusStep>& steps) {
  double radius = first;
  auto step = steps.begin();
  std::vector<SizedSegment> sized;
  sized.reserve(segments.size() + steps.size());
  // Bounded: each segment and each step once.
  for (const TimedSegment& segment : segments) {
    SizedSegment rest{segment, radius};
    for (; step != steps.end() && step->t < rest.t_end - kRounding; ++step) {
      if (step->t > rest.t_start + kRounding) {
        SizedSegment before = rest;
        before.t_end = step->t;
        before.path.to = before.path.from;
        sized.push_back(before);
        rest.t_start = step->t;
      }
      radius = step->radius;
      rest.radius = radius;
    }
    sized.push_back(rest);
  }
  return sized;
}

std::vector<SizedSegment> committed_segments(const Itinerary& itinerary) {
  if (itinerary.t_begin <= 0.0) return {};
  std::vector<TimedSegment> segments = timed_segments(itinerary.committed);
  std::erase_if(segments, [&](const TimedSegment& segment) { return segment.t_start >= itinerary.t_begin; });
  if (!segments.empty()) segments.back().t_end = std::min(segments.back().t_end, itinerary.t_begin);
  return with_radii(segments, itinerary.load.radius, radius_steps(itinerary, itinerary.visited));
}

std::optional<SizedSegment> growth_at_end(const Itinerary& itinerary) {
  double before = itinerary.load.radius;
  double after = itinerary.load.radius;
  for (const RadiusStep& step : radius_steps(itinerary, itinerary.visited)) {
    after = step.radius;
    if (step.t < itinerary.t_begin - kRounding) before = after;
  }
  if (after <= before) return std::nullopt;
  const Position& place = itinerary.pose.position;
  return SizedSegment{{{place, place}, itinerary.t_begin, itinerary.t_begin}, after};
}

std::vector<SizedSegment> certain_segments(const Itinerary& itinerary) {
  std::vector<SizedSegment> segments = committed_segments(itinerary);
  if (const auto growth = growth_at_end(itinerary)) segments.push_back(*growth);
  return segments;
}

std::vector<SizedSegment> sized_segments(const Itinerary& itinerary, const Trajectory& trajectory) {
  const std::vector<TimedSegment> segments = timed_segments(trajectory);
  if (itinerary.radius_after.empty()) return with_radii(segments, itinerary.load.radius, {});
  std::vector<Visit> visits = itinerary.visited;
  visits.insert(visits.end(), trajectory.visits.begin(), trajectory.visits.end());
  const std::size_t last = itinerary.radius_after.size() - 1;
  if (!itinerary.is_parked()) visits.push_back({last, 0.0, trajectory.last_served});
  return with_radii(segments, itinerary.load.radius, radius_steps(itinerary, visits));
}

}  // namespace fleetplan::core
