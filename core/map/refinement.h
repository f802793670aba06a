#pragma once

#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Whether a lattice may miss ways of robots of this radius at all. Robots that are no larger than a cell
/// follow the centres of the cells wherever they fit, unless there are blocked polygons.
bool may_need_refinement(const OccupancyGrid& grid, const Lattice& lattice, double radius, bool polygons);

/// The fine lattice for a disk of one radius: the centres of the cells. If the lattice has the cells as
/// vertices, it also has the middles between them.
struct FineLattice {
  double pitch = 0.0;
  double first = 0.0;   // both coordinates of the first node
  double radius = 0.0;  // metres; a little more than the robot's where gaps may leave it no play

  FineLattice(const OccupancyGrid& grid, const Lattice& lattice, double robot_radius);
};

/// Returns the vertices that the lattice lacks for robots of one radius. With them, a robot gets from one
/// vertex to another wherever it can over the centres of the cells, without a long way round. On the lattice
/// of the cells, the middles between cells count as well. Returns none if the stop condition was met first.
std::optional<FinerVertices> refine(const OccupancyGrid& grid, const LineOfSight& sight,
                                    const Lattice& lattice, double radius, const StopCondition& stop);

/// Returns a way from a position without any vertex in sight to a node of the fine lattice with a vertex in
/// sight. The way goes over nodes of the fine lattice, and each place on it is in sight of the place before.
/// Empty if there is no such way nearby.
///
/// `radius` is the robot's radius at the position. Up to the first place, the smaller of `radius` and the
/// radius of `nodes` counts; then the radius of `nodes`.
std::vector<Position> way_to_lattice(const Position& from, double radius, const FineLattice& nodes,
                                     const Lattice& lattice, const FreeSpace& space);

}  // namespace fleetplan::core
