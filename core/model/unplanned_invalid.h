#pragma once

#include <cstddef>

#include "core/model/plan.h"

namespace fleetplan::core {

/// Why a robot with Robot::invalid has no plan.
inline Unplanned unplanned_invalid(std::size_t robot) {
  return {
      robot, Unplanned::Reason::invalid, "The robot's geometry is at fault, so it stays where it is.", {}};
}

}  // namespace fleetplan::core
