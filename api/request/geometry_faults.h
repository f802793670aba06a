#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_body.h"
#include "core/map/occupancy_grid.h"
#include "core/model/problem.h"

namespace fleetplan::api {

/// A fault of poses or committed motion as it is told to the client.
struct GeometryFault {
  JsonReader place;
  const char* code;
  std::string detail;
};

/// `indices`: of the problem's robots in the fleet, whose map is `grid`.
GeometryFault describe(const core::ProblemFault& found, const Fleet& fleet,
                       const std::vector<std::size_t>& indices, const core::OccupancyGrid& grid);

}  // namespace fleetplan::api
