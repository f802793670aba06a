#include "core/instance/static_fit.h"

#include <algorithm>
#include <vector>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// More than what a disk in contact with an obstacle overlaps it, rounding included.
constexpr double kMostOverlap = kContactTolerance + 2.0 * kSamePosition;

}  // namespace

double radius_at_start(const Instance& instance, std::size_t robot) {
  const double radius = instance.stages(robot)[0].load.radius;
  const PlanOptions& options = instance.options();
  const double overlap = std::max(0.0, options.start_overlap - options.inflation);  // of the bare disk
  const double least = std::max(radius - overlap - kMostOverlap, kSmallestDisk * radius);
  return instance.sight(robot).fitting_radius(instance.itinerary(robot).pose.position, least,
                                              instance.motion(robot).radius);
}

double radius_at_goal(const Instance& instance, std::size_t robot, const Position& goal, std::size_t stage) {
  const double radius = instance.stages(robot)[stage].motion.radius;
  return instance.sight(robot).fitting_radius(goal, radius - kMostOverlap, radius);
}

bool fits_at_start(const Instance& instance, std::size_t robot) {
  return instance.sight(robot).disk_fits(instance.itinerary(robot).pose.position,
                                         instance.motion(robot).radius);
}

bool is_clear_at_start(const Instance& instance, std::size_t robot) {
  return radius_at_start(instance, robot) >= instance.motion(robot).radius - kMostOverlap;
}

bool fits_at_goals(const Instance& instance, std::size_t robot) {
  const RobotStages& stages = instance.stages(robot);
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    if (goals[k].anywhere) continue;
    const double largest = std::max(stages[k].motion.radius, stages[k + 1].motion.radius);
    if (!instance.sight(robot).disk_fits(goals[k].position, largest - kMostOverlap)) return false;
  }
  return true;
}

bool fits_at(const Instance& instance, std::size_t robot, const Position& position) {
  return instance.sight(robot).disk_fits(position, instance.motion(robot).radius - kMostOverlap);
}

}  // namespace fleetplan::core
