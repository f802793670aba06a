#pragma once

// The faults that the core finds in poses and committed motion, in the words of the request.

#include <cstddef>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_body.h"
#include "core/map/occupancy_grid.h"
#include "core/map/static_map.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A fault of poses or committed motion as the client sees it.
struct GeometryFault {
  JsonReader place;
  const char* code;
  std::string detail;
};

/// Returns the words for a pose that a robot of this radius cannot have, because of an obstacle. `zones` are
/// those of the problem.
std::string describe_pose(const core::ProblemFault& found, const JsonReader& pose, double radius,
                          const std::vector<core::Zone>& zones, const core::OccupancyGrid& grid,
                          const WorldFrame& frame);

/// Returns the words for a fault. `indices` are those of the problem's robots in the fleet, whose map is
/// `grid`.
GeometryFault describe(const core::ProblemFault& found, const Fleet& fleet,
                       const std::vector<std::size_t>& indices, const core::OccupancyGrid& grid);

/// Returns a sentence about one mistake that explains all of the faults, or nothing if none does: the map or
/// the poses are upside down, or radii are diameters. Looks at each pose twice at most, and ends at the first
/// one that contradicts; so it costs no more than the check that found the faults. Ends with `stop`.
std::string common_cause(const core::ProblemFaults& faults, const Fleet& fleet,
                         const std::vector<std::size_t>& indices, const core::StaticMap& map,
                         const core::StopCondition& stop);

}  // namespace fleetplan::api
