#pragma once

#include <vector>

#include "core/geometry/position.h"
#include "core/map/free_space.h"
#include "core/map/lattice.h"
#include "core/map/refinement.h"

namespace fleetplan::core {

/// For a position from which no vertex is in sight: places on the way over the nodes of a fine lattice to one
/// from where a vertex is, each in sight of the one before. None if there is no such way nearby. `radius` of
/// the robot at the position and near it, at most that elsewhere.
std::vector<Position> way_to_lattice(const Position& from, double radius, const FineLattice& nodes,
                                     const Lattice& lattice, const FreeSpace& space);

}  // namespace fleetplan::core
