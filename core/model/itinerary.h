#pragma once

// What is left to plan for a robot; planners read this instead of the robot itself. Also: where the robot is
// on its way, and its radius there.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/segment.h"
#include "core/model/action.h"
#include "core/model/loads.h"
#include "core/model/robot.h"
#include "core/model/served.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// What is left to plan for a robot after its committed actions. Goals have the same numbers as in Robot.
struct Itinerary {
  Trajectory committed;        // the robot's centre until `t_begin`; then it stays
  Pose pose;                   // pose at `t_begin`
  double t_begin = 0.0;        // seconds; the plan goes on from here
  bool is_committed = false;   // whether there are committed actions; they may take no time
  std::vector<Visit> visited;  // visits to the goals that the committed actions serve
  std::vector<Goal> goals;     // the goals that follow, the last one included; empty for a parked robot
  std::size_t first_goal = 0;  // the number of goals.front()
  /// Set if the committed actions end at rest in the first goal's pose. When that rest begins, and how much
  /// of the service is done by their end, seconds. This counts only as long as the robot does not leave.
  double arrived = 0.0;
  double service_done = 0.0;

  Load load = {};  // at t = 0
  /// The radius after each service, metres, by the number of the goal, served goals included. nullopt: as
  /// before. Empty if the radius never changes.
  std::vector<std::optional<double>> radius_after = {};

  bool is_invalid = false;  // see Robot::invalid
  bool is_idle = false;     // it makes way, and has no goals of its own, served or not: it need not move
  double weight = 1.0;      // see Robot::weight
  double goal_age = 0.0;    // seconds, see Robot::goal_age
  double direct_way = 0.0;  // metres: straight from `pose` through all goals, served goals included

  /// Whether it stays where its committed actions end.
  bool is_parked() const { return goals.empty(); }
  /// Whether it makes way for others after its own goals, or because it has none.
  bool yields() const { return !goals.empty() && goals.back().anywhere; }
  /// The number of goals with a pose, served goals included.
  std::size_t own_goal_count() const { return first_goal + goals.size() - (yields() ? 1 : 0); }
  /// A goal that is left, by its number.
  const Goal& goal(std::size_t number) const { return goals[number - first_goal]; }
  const Goal& last_goal() const { return goals.back(); }

  /// Metres, by the number of goals served.
  double radius_after_goals(std::size_t served) const;
  /// The largest radius at any time, and the radius at the end; metres.
  double largest_radius() const;
  double last_radius() const { return radius_after_goals(radius_after.size()); }
};

/// Returns what is left to plan for a robot. The rests of the committed actions serve goals as early as
/// possible. Only the last goal always remains. A part of a service that is done counts if the robot goes on
/// with it.
Itinerary itinerary_of(const Robot& robot);
/// The same for robots, in their order.
std::vector<Itinerary> itineraries_of(std::span<const Robot> robots);

/// Whether the robot, which has a goal, has nothing left to do when its committed actions end.
bool has_arrived(const Itinerary& itinerary);

/// From `t` on (seconds) a robot has another radius.
struct RadiusStep {
  double t = 0.0;
  double radius = 0.0;  // metres
};

/// The changes of radius of a robot that makes these visits, which begin with its first goal. A visit without
/// end changes nothing. Empty for a robot that keeps its radius.
std::vector<RadiusStep> radius_steps(const Itinerary& itinerary, std::span<const Visit> visits);

/// Contiguous segments from t = 0 with the robot's radius, which is `first` metres at t = 0. A rest is
/// divided where the radius changes.
std::vector<SizedSegment> with_radii(const std::vector<TimedSegment>& segments, double first,
                                     const std::vector<RadiusStep>& steps);

/// The committed motion of a robot, waits included, from t = 0 to its end; see with_radii.
std::vector<SizedSegment> committed_segments(const Itinerary& itinerary);

/// The instant at which the committed motion ends, if the robot has a larger radius from then on. It
/// certainly has the larger radius at this instant, however soon it leaves.
std::optional<SizedSegment> growth_at_end(const Itinerary& itinerary);

/// Returns where a robot with a goal certainly is: its committed motion, followed by the instant of
/// growth_at_end.
std::vector<SizedSegment> certain_segments(const Itinerary& itinerary);

/// The segments of a robot's trajectory, contiguous from t = 0 on; see with_radii.
std::vector<SizedSegment> sized_segments(const Itinerary& itinerary, const Trajectory& trajectory);

}  // namespace fleetplan::core
