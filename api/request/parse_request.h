#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/error.h"
#include "api/json/result.h"
#include "api/request/limits.h"
#include "api/request/received_robot.h"
#include "api/request/requested_dependencies.h"
#include "api/request/world_frame.h"
#include "core/map/map_cache.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/work.h"

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

}  // namespace fleetplan::api
