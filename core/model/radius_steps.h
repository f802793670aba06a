#pragma once

// The radius of a robot that picks loads up or puts them down at its goals (Goal::radius_after).

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/robot_disk.h"
#include "core/geometry/segment.h"
#include "core/model/itinerary.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// By the number of goals that it has served, the radius of the robot in metres: as many as it has goals, and
/// one more.
std::vector<double> radii_of(const Robot& robot);
/// Whether not all of these are the same.
bool changes_radius(const Robot& robot);
/// The largest and the last of them.
double largest_radius(const Robot& robot);
double last_radius(const Robot& robot);

/// From `t` on (seconds) a robot has another radius.
struct RadiusStep {
  double t = 0.0;
  double radius = 0.0;  // metres
};

/// The steps of a robot that makes these visits, which begin with its first goal. A visit without end makes
/// none. Empty for a robot that keeps its radius.
std::vector<RadiusStep> radius_steps(const Robot& robot, std::span<const Visit> visits);

/// The committed motion of a robot, waits included, from t = 0 to its end; see with_radii.
std::vector<SizedSegment> committed_segments(const Robot& robot, const Itinerary& itinerary);

/// The instant at which the committed motion ends, if the robot has a larger radius from then on: then it
/// certainly has it, however soon it leaves.
std::optional<SizedSegment> growth_at_end(const Robot& robot, const Itinerary& itinerary);

/// Where a robot with a goal certainly is: its committed motion, and then the instant of growth_at_end.
std::vector<SizedSegment> certain_segments(const Robot& robot, const Itinerary& itinerary);

/// Contiguous segments from t = 0 with the radius of the robot; a rest is divided where it changes.
std::vector<SizedSegment> with_radii(const std::vector<TimedSegment>& segments, const Robot& robot,
                                     const std::vector<RadiusStep>& steps);

}  // namespace fleetplan::core
