#pragma once

// Where a disk must not be: in obstacles, and in zones against their rules.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/obstacle_field.h"
#include "core/verify/geometry/segment_distance.h"
#include "core/verify/violations.h"

namespace fleetplan::core {

/// Returns the distance of a position from the nearest obstacle, at most `reach` metres.
double distance_from_walls(const ObstacleField& field, const Position& position, double reach);

/// Returns the distance from obstacles that a robot has to keep during each of its legs, metres: its radius
/// there, and after its commitment the inflated one. A robot that begins nearer, as the rules allow, comes no
/// nearer than it is until a leg of it ends clear. `distance_from(position, most)` returns the distance of a
/// position from obstacles, at most `most`.
std::vector<double> distances_to_keep(const std::function<double(const Position&, double)>& distance_from,
                                      const std::vector<double>& radii, const std::vector<Leg>& legs,
                                      const Departure& departure, double tolerance, const CheckRules& rules);

/// Reports where a disk overlaps obstacles by more than the tolerance: one violation for each leg, or one for
/// consecutive legs through which the overlap continues. `legs` are a result of `execute`; `radii` are those
/// of the disk in each of them. Ends early when `stop` is met.
ViolationList check_obstacles(const ObstacleField& field, std::size_t robot, const std::vector<double>& radii,
                              const std::vector<Leg>& legs, double tolerance, const StopCondition& stop);

/// The zones of one robot.
class ZonesOfRobot {
 public:
  /// The zones of the robot with this index. `zones`: null if there are none; otherwise they outlive this
  /// object.
  ZonesOfRobot(const std::vector<Zone>* zones, std::size_t index);

  bool empty() const { return zones_.empty(); }
  bool may_leave_any() const { return may_leave_any_; }

  /// Returns how far a position is from the blocked zones, metres, at most `reach`; 0 inside. Those that the
  /// robot may leave are not among them.
  double distance_to_blocked(const Position& position, double reach) const;

  /// Returns the number of the first goal from `first` on at which the robot would be inside of a zone that
  /// it may leave but not enter; none if there is none. Where it is inside by less than the tolerance
  /// (metres), or outside by less, the goal may be visited or put off: it is put off unless `visits(goal)`.
  std::optional<std::size_t> first_goal_put_off(const Robot& robot, std::size_t first, double tolerance,
                                                const std::function<bool(std::size_t)>& visits) const;

  /// Reports where the disk overlaps a blocked zone by more than the tolerance (metres): for each zone one
  /// violation for consecutive legs through which the overlap continues. `radii` are those of the disk in
  /// each leg. In zones that it may leave, a robot may be from its start, or from the end of its commitment,
  /// until it is clear of all of them at the end of a leg, and while it executes its commitment. Ends early
  /// when `stop` is met.
  ViolationList check_blocked(const std::vector<double>& radii, const std::vector<Leg>& legs,
                              const Departure& departure, double tolerance, const StopCondition& stop) const;

  /// Reports the actions that are faster than a speed zone allows, and those against a one-way zone. Ends
  /// early when `stop` is met.
  ViolationList check_driving(const std::vector<Action>& actions, const CarriedLoads& loads,
                              const Tolerance& tolerance, const StopCondition& stop) const;

 private:
  struct ZoneBox {
    std::size_t index = 0;
    const Zone* zone = nullptr;
    Rectangle box;
  };

  double distance_to_leave(const Position& position, double reach) const;
  std::vector<bool> may_be_inside(const std::vector<double>& radii, const std::vector<Leg>& legs,
                                  const Departure& departure, double tolerance,
                                  const StopCondition& stop) const;
  std::optional<Violation> check_translation(const ZoneBox& in, const Action& action, std::size_t number,
                                             const Load& load, const Tolerance& tolerance,
                                             const StopCondition& stop) const;
  std::optional<Violation> check_rotation(const ZoneBox& in, const Action& action, std::size_t number,
                                          const Tolerance& tolerance) const;
  Violation broken(const ZoneBox& in, double t, double measured, double required, std::string detail) const;

  std::size_t robot_;
  std::vector<ZoneBox> zones_;
  bool may_leave_any_ = false;  // of them
};

}  // namespace fleetplan::core
