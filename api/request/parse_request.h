#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/request/limits.h"
#include "api/request/parse_fleet.h"
#include "api/request/world_frame.h"
#include "core/model/problem.h"
#include "core/planner.h"

namespace fleetplan::api {

/// A valid body of POST /v1/plan.
struct PlanRequest {
  core::Problem problem;  // in the map frame
  core::PlanOptions options;
  std::chrono::nanoseconds budget;  // the smaller of the request's and the service's
  WorldFrame frame;
  std::vector<std::string> warnings;
};

/// Reads a body of POST /v1/plan: the request, or all that is wrong with it.
std::variant<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits);

}  // namespace fleetplan::api
