#pragma once

// Answers requests of the HTTP service inside the program: JSON in, JSON out. This header belongs to a
// separate library, fleetplan::service, which needs libpng. fleetplan.h does not include it.

#include <fleetplan/planner.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fleetplan {

/// The requests that can be answered. docs/api.md describes the body and the answers of each.
enum class Endpoint {
  plan,            // POST /v1/plan
  validate,        // POST /v1/validate
  dependencies,    // POST /v1/dependencies
  advance,         // POST /v1/advance
  simulate,        // POST /v1/simulate
  margins,         // POST /v1/margins
  retime,          // POST /v1/retime
  matrix,          // POST /v1/matrix
  assign,          // POST /v1/assign
  export_vda5050,  // POST /v1/export/vda5050
  import_vda5050,  // POST /v1/import/vda5050
};

/// What a single request may ask for. The defaults equal the service's. The names are the names in GET
/// /v1/limits, and details of errors use them.
struct ServiceLimits {
  /// The budget of a request that names none, and the largest budget of any request. A longer budget is
  /// clamped, with a warning in the answer. Both are from 1 ms to a day, and the default is at most the
  /// maximum.
  std::chrono::milliseconds default_budget{5000};
  std::chrono::milliseconds max_budget{120'000};
  std::size_t max_body = 32u << 20;     // bytes
  std::int64_t max_cells = 16'000'000;  // cells of the map; at most 1e9
  std::size_t max_robots = 2000;
  // In total, wherever they are:
  std::size_t max_goals = 20'000;     // goals in lists `goals`
  std::size_t max_actions = 200'000;  // actions in `committed` and `previous`
  std::size_t max_obstacles = 2000;
  std::size_t max_obstacle_entries = 400'000;
  std::size_t max_zones = 1000;
  std::size_t max_zone_corners = 20'000;
  /// Bytes. The limit holds only for memory that is known in advance: the figures that a simulation keeps of
  /// its runs. Unlike in the service, memory that a call allocates is not counted.
  std::size_t max_plan_memory = 256u << 20;
};

/// What a program may add to a call, beside the body.
struct ServiceOptions {
  ServiceLimits limits = {};
  /// The `request_id` in plans, simulations and errors. It helps to find them again, for example in the
  /// program's log.
  std::string request_id = {};
};

/// An answer of the service.
struct Answer {
  int status = 500;  // of HTTP
  std::string body;  // JSON: the answer or, unless ok(), the problem details of RFC 9457

  bool ok() const { return status == 200; }
};

/// Answers a request exactly as the service does, with the same limits, checks and errors. `body` is JSON in
/// UTF-8. The time budget counts from the call.
///
/// - A faulty body gets an answer, too. The status is 400, with line and column, if the body is not JSON.
///   Otherwise, the status is 422, with `errors`; each has a `pointer` to the place.
/// - When a stop is requested, the call ends within milliseconds. A plan that has been made by then is
///   returned, as at the end of its budget. If there is nothing to answer, the status is 503 and the code
///   `draining`.
/// - `control.progress` is called for Endpoint::plan. It may throw, which ends planning; answer() passes the
///   exception on.
/// - Memory is not bounded. If the process has no memory left, the answer has the status 503 and the code
///   `overloaded`.
///
/// Throws std::invalid_argument for limits that are out of range and for an endpoint that does not exist.
Answer answer(Endpoint endpoint, std::string_view body, const Control& control = {},
              const ServiceOptions& options = {});

}  // namespace fleetplan
