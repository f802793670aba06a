#include "core/prioritized/without_way.h"

namespace fleetplan::core {

Unplanned unplanned_without_way(std::size_t robot, const Way& way) {
  using Reason = Unplanned::Reason;
  if (!way.closed_by.empty()) {
    return {robot, Reason::blocked_by_robots,
            "Robots that stay where they are leave no way from the start to the goal.", way.closed_by};
  }
  return {
      robot,
      Reason::goal_unreachable,
      way.kind == Way::Kind::closed
          ? "No way leads from the start to the goal that is wide enough for the robot."
          : "The lattice of cell centres has no way from the start to the goal that is wide enough for the "
            "robot. A finer resolution, a smaller radius or more connectivity may give it one.",
      {}};
}

}  // namespace fleetplan::core
