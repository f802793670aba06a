#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/model/action.h"
#include "core/model/zone.h"
#include "core/verify/execution/execution.h"
#include "core/verify/geometry/segment_to_rectangle.h"
#include "core/verify/verify.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {

/// The zones of one robot.
class ZonesOfRobot {
 public:
  /// `zones`: null if there are none; otherwise they outlive this object.
  /// `own_speed`: the robot's linear speed, metres per second.
  ZonesOfRobot(const std::vector<Zone>* zones, std::size_t robot, double own_speed);

  bool empty() const { return zones_.empty(); }

  /// How far a position is from the blocked zones, metres, at most `reach`; 0 inside.
  double distance_to_blocked(const Position& position, double reach) const;

  /// Reports where the disk overlaps a blocked zone by more than the tolerance (metres): for each zone one
  /// violation for consecutive legs through which the overlap continues. `radii` are those of the disk in
  /// each leg. Ends early when `stop` is met.
  ViolationList check_blocked(const std::vector<double>& radii, const std::vector<Leg>& legs,
                              double tolerance, const StopCondition& stop) const;

  /// Reports the actions that are faster than a speed zone allows, and those against a one-way zone. Ends
  /// early when `stop` is met.
  ViolationList check_driving(const std::vector<Action>& actions, const Tolerance& tolerance,
                              const StopCondition& stop) const;

 private:
  struct ZoneBox {
    std::size_t index = 0;
    const Zone* zone = nullptr;
    Rectangle box;
  };

  std::optional<Violation> check_translation(const ZoneBox& in, const Action& action, std::size_t number,
                                             const Tolerance& tolerance, const StopCondition& stop) const;
  std::optional<Violation> check_rotation(const ZoneBox& in, const Action& action, std::size_t number,
                                          const Tolerance& tolerance) const;
  Violation broken(const ZoneBox& in, double t, double measured, double required, std::string detail) const;

  std::size_t robot_;
  double own_speed_;
  std::vector<ZoneBox> zones_;
};

}  // namespace fleetplan::core
