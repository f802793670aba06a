#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/request/parse_body.h"
#include "core/map/static_map.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// What the text of a fault says about a pose whose centre is not on the map, and about its probable unit:
/// "is at (52.5, 3), outside the map, which ...". Empty if the pose is on the map.
std::string outside_text(const JsonReader& pose, const core::OccupancyGrid& grid, const WorldFrame& frame);

/// A sentence about one mistake that explains all of the faults, or nothing if none does: the map or the
/// poses are upside down, or radii are diameters. Looks at each pose twice at most, and ends at the first one
/// that contradicts; so it costs no more than the check that found the faults. Ends with `stop`.
std::string common_cause(const core::ProblemFaults& faults, const Fleet& fleet,
                         const std::vector<std::size_t>& indices, const core::StaticMap& map,
                         const core::StopCondition& stop);

}  // namespace fleetplan::api
