#pragma once

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

/// Whether the two are the same up to rounding, see kSamePosition.
inline bool is_same_position(const Position& a, const Position& b) {
  return (a - b).squaredNorm() <= kSamePosition * kSamePosition;
}

}  // namespace fleetplan::core
