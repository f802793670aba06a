#pragma once

// The faults that the core finds in poses and committed motion, in the words of the request.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_body.h"
#include "core/explain/nearest_places.h"
#include "core/map/occupancy_grid.h"
#include "core/map/static_map.h"
#include "core/model/problem.h"
#include "core/model/ways_out.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// Finds places for goals that do not fit.
class NearestGoals {
 public:
  /// For so many robots on this map, with zones and an inflation.
  NearestGoals(std::shared_ptr<const core::StaticMap> map, const std::vector<core::Zone>& zones,
               std::size_t robots, double inflation, const WorldFrame& frame, const core::StopCondition& stop)
      : inflation_(inflation), maps_(std::move(map), zones, robots, stop), places_(frame.origin, stop) {}

  /// Returns the nearest place that fits, inflation included, for a fault of the kind goal_in_obstacle. None
  /// if no place is found. `goal` is the position of the goal. Both are in the map frame.
  std::optional<core::Position> of(const core::ProblemFault& found, const core::Position& goal);

 private:
  double inflation_;
  core::ZoneMaps maps_;
  core::NearestPlaces places_;
};

/// A fault of poses or committed motion as the client sees it.
struct GeometryFault {
  JsonReader place;
  const char* code;
  std::string detail;
};

/// Returns the text for a pose that a robot cannot have because of an obstacle. `zones` belong to the
/// problem, whose map is `grid`.
std::string describe_pose(const core::ProblemFault& found, const JsonReader& pose, const core::Robot& robot,
                          double inflation, const std::vector<core::Zone>& zones,
                          const core::OccupancyGrid& grid, const WorldFrame& frame, NearestGoals& nearest);

/// Returns the text for a fault. `indices`: for each of the problem's robots, its index in the fleet. `grid`:
/// the fleet's map.
GeometryFault describe(const core::ProblemFault& found, const Fleet& fleet,
                       const std::vector<std::size_t>& indices, const core::OccupancyGrid& grid,
                       NearestGoals& nearest);

/// Returns a sentence about one mistake that explains all faults, or nothing if there is none. For example,
/// the map or the poses are upside down, or radii are diameters. Looks at each pose at most twice, and ends
/// at the first pose that contradicts. So it costs no more than the check that found the faults. Ends with
/// `stop`.
std::string common_cause(const core::ProblemFaults& faults, const Fleet& fleet,
                         const std::vector<std::size_t>& indices, const core::StaticMap& map,
                         const core::StopCondition& stop);

}  // namespace fleetplan::api
