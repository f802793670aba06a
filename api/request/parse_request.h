#pragma once

// The bodies of requests to plan, to validate and to simulate. Each has its source.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/error.h"
#include "api/json/result.h"
#include "api/request/fleet/received_robot.h"
#include "api/request/limits.h"
#include "api/request/options.h"
#include "api/request/world_frame.h"
#include "core/execution/simulation/simulation.h"
#include "core/geometry/moving_obstacle.h"
#include "core/map/occupancy_grid.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/runtime/work.h"
#include "core/verify/check_rules.h"

namespace fleetplan::api {

/// A valid body of POST /v1/plan.
struct PlanRequest {
  core::Problem problem;  // in the map frame
  core::PlanOptions options;
  std::chrono::nanoseconds budget;  // the smaller of the request's and the service's
  WorldFrame frame;
  std::vector<std::string> warnings;
  std::vector<ReceivedRobot> received;  // of each robot
  std::string metadata;                 // see parse_metadata
  RequestedDependencies dependencies;
};

/// Reads a body of POST /v1/plan; ends with `parse_unfinished` or `draining` when the stop is met. `maps` has
/// those of earlier requests; may be null.
Result<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits, core::Work& stop,
                                                core::MapCache* maps = nullptr);

/// A readable body of POST /v1/validate. Robots may overlap obstacles and each other: the checker reports
/// that.
struct ValidateRequest {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;
  std::vector<core::RobotPlan> plans;
  RequestedDependencies dependencies;
  core::CheckRules rules;             // the tolerance is in metres, seconds and radians
  std::chrono::nanoseconds budget{};  // of the check
};

/// Reads a body of POST /v1/validate; ends with `parse_unfinished` or `draining` when the stop is met.
Result<ValidateRequest, RequestError> parse_validate_request(std::string_view body, const Limits& limits,
                                                             core::Work& stop);

/// The most runs of one study.
inline constexpr std::size_t kMostRuns = 100'000;

/// A readable body of POST /v1/simulate. The actions of every plan are contiguous from the start of its robot
/// on; whether plans collide is not judged. Robots without a plan have their committed actions as one.
struct SimulateRequest {
  core::OccupancyGrid grid;
  WorldFrame frame;
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<double> body_radii;  // metres, by robot
  core::ExecutionPolicy policy = core::ExecutionPolicy::open_loop;
  double max_delay = 0.0;                           // seconds, of clock_stop
  double wait_before_move = 0.0;                    // seconds, see PlanOptions
  std::vector<core::Dependency> dependencies = {};  // by robot
  core::SimulationSettings settings = {};
  std::optional<std::size_t> trace = {};  // the run that is returned
  std::chrono::nanoseconds budget{};
  std::vector<std::string> warnings = {};
};

/// Reads a body of POST /v1/simulate; ends with `parse_unfinished` or `draining` when the stop is met.
Result<SimulateRequest, RequestError> parse_simulate_request(std::string_view body, const Limits& limits,
                                                             core::Work& stop);

}  // namespace fleetplan::api
