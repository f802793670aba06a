#include "api/request/parse_body.h"

#include <algorithm>
#include <string>

#include "api/json/faults.h"
#include "api/request/parse_metadata.h"
#include "api/request/unit_warnings.h"
#include "api/request/zones/parse_zones.h"
#include "core/map/lattice.h"

namespace fleetplan::api {

namespace {

ErrorCode code_of(JsonError::Kind kind) {
  switch (kind) {
    case JsonError::Kind::malformed:
      return ErrorCode::malformed_json;
    case JsonError::Kind::too_deep:
      return ErrorCode::too_deep;
    case JsonError::Kind::too_large:
    case JsonError::Kind::unfinished:
      break;
  }
  return ErrorCode::invalid_request;
}

/// A fleet that is planned anew while it drives needs no start kept free: its plans begin where robots are.
void set_default_start_safe_interval(const JsonReader& options, const std::vector<ReadRobot>& robots,
                                     core::PlanOptions& plan) {
  const bool is_given = options && options.find("start_safe_interval");
  const bool in_motion = std::any_of(robots.begin(), robots.end(), [](const ReadRobot& read) {
    return read.committed || read.robot.previous;
  });
  // Within a horizon, robots that leave their places in time save repairs: 1000 robots in rounds of 5 s
  // serve 1.1 times as many goals as with 0.
  constexpr double kWithHorizon = 1.0;
  if (in_motion && !is_given) plan.start_safe_interval = plan.horizon ? kWithHorizon : 0.0;
}

/// Reports a lattice of too many vertices, or of none.
void check_lattice(const JsonReader& options, const core::PlanOptions& plan, const core::OccupancyGrid& grid,
                   const Limits& limits) {
  if (!plan.lattice_spacing) return;
  const JsonReader spacing = options.find("lattice_spacing");
  const std::int64_t columns = core::Lattice::vertices_along(grid.width(), *plan.lattice_spacing);
  const std::int64_t rows = core::Lattice::vertices_along(grid.height(), *plan.lattice_spacing);
  if (columns < 1 || rows < 1) {
    spacing.fault(fault::kOutOfRange, "A lattice with a spacing of " + number_text(*plan.lattice_spacing) +
                                          " m has no vertex on this map of " + number_text(grid.width()) +
                                          " m x " + number_text(grid.height()) +
                                          " m. Use at most twice its shorter side.");
  } else if (columns > limits.max_cells / rows) {
    spacing.fault(fault::kOutOfRange, "A lattice with a spacing of " + number_text(*plan.lattice_spacing) +
                                          " m has " + std::to_string(columns) + " x " + std::to_string(rows) +
                                          " vertices on this map; this service accepts at most " +
                                          std::to_string(limits.max_cells) + ". Use a larger spacing.");
  }
}

}  // namespace

RequestError request_error(const FaultList& faults) {
  RequestError error{ErrorCode::invalid_request, "", faults.listed(), faults.count()};
  if (faults.count() == 1) {
    error.detail = error.faults.front().detail;
  } else if (faults.count() == error.faults.size()) {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; see errors.";
  } else {
    error.detail = "The request has " + std::to_string(faults.count()) + " faults; errors lists the first " +
                   std::to_string(error.faults.size()) + ".";
  }
  return error;
}

RequestError request_error(const JsonError& error, const core::Work& stop) {
  if (error.kind == JsonError::Kind::unfinished) return unfinished(stop);
  RequestError request{code_of(error.kind), error.detail, {}, 0};
  if (request.code == ErrorCode::invalid_request) {
    request.faults.push_back({"", fault::kOutOfRange, error.detail});
    request.faults_total = 1;
  }
  return request;
}

RequestError unfinished(const core::Work& stop) {
  if (stop.cancelled()) {
    return {ErrorCode::draining, kDrainingDetail, {}, 0};
  }
  return {ErrorCode::parse_unfinished,
          "Reading the request was given up after " +
              std::string(stop.has_budget() ? "its time budget, or three seconds of CPU time"
                                            : "a second of CPU time") +
              ": send a smaller map, or fewer robots, actions or other values" +
              (stop.has_budget() ? ", or increase options.time_budget_ms." : "."),
          {},
          0};
}

RequestedDependencies requested_dependencies(const Fleet& fleet) {
  RequestedDependencies requested{fleet.options.dependencies, fleet.options.dependency_slack, {}};
  for (const ReadRobot& read : fleet.robots) {
    requested.margins.push_back(read.execution_margin.value_or(fleet.options.execution_margin));
  }
  return requested;
}

Fleet parse_fleet(const JsonReader& root, const Limits& limits,
                  const std::function<void(const ReadOptions&)>& set_budget) {
  Fleet fleet;
  fleet.options = parse_options(root.find("options"));
  set_budget(fleet.options);
  fleet.map = parse_map(root.require("map"), limits.max_cells);
  if (fleet.map) check_lattice(root.find("options"), fleet.options.plan, fleet.map->grid, limits);
  const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
  UniqueIds ids;
  fleet.robots = parse_robots(root.require("robots"), root.find("robot_defaults"), frame, limits, ids);
  fleet.obstacles = parse_obstacles(root.find("obstacles"), frame, limits, ids);
  fleet.zones = parse_zones(root.find("zones"), fleet.map ? &*fleet.map : nullptr, limits, fleet.robots);
  for (std::string& warning : unit_warnings(fleet.robots, root.find("zones"))) {
    fleet.options.warnings.push_back(std::move(warning));
  }
  fleet.metadata = parse_metadata(root);
  set_default_start_safe_interval(root.find("options"), fleet.robots, fleet.options.plan);
  return fleet;
}

}  // namespace fleetplan::api
