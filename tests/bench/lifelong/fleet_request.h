#pragma once

#include <nlohmann/json.hpp>

#include "core/map/occupancy_grid.h"
#include "tests/bench/lifelong/fleet.h"
#include "tests/bench/lifelong/lifelong_job.h"

namespace fleetplan::bench {

/// The body of POST /v1/plan for the fleet at time `now`, without the options. Its clock begins at `now`.
///
/// `stop` and `snapshots`: every robot starts where it is. A robot in service is parked.
/// `committed`: what a robot does within `job.commit` seconds is committed, and the rest of its plan
/// previous.
nlohmann::json fleet_request(const nlohmann::json& map, const Fleet& fleet, double now,
                             const LifelongJob& job);

/// The body for a robot that is alone on the map and drives from a pose to its goal.
nlohmann::json lone_request(const nlohmann::json& map, const Vehicle& vehicle, const core::Pose& from);

nlohmann::json map_json(const core::OccupancyGrid& grid);

/// The actions of an answer.
Actions actions_of(const nlohmann::json& list);

}  // namespace fleetplan::bench
