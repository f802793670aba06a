#pragma once

// What the HTTP service answers, in the process of the program: JSON in, JSON out. It is in a library of its
// own, fleetplan::service, which needs libpng; fleetplan.h does not include this header.

#include <fleetplan/planner.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fleetplan {

/// The requests that are answered. docs/api.md has the bodies of each, and its answers.
enum class Endpoint {
  plan,            // POST /v1/plan
  validate,        // POST /v1/validate
  dependencies,    // POST /v1/dependencies
  advance,         // POST /v1/advance
  simulate,        // POST /v1/simulate
  retime,          // POST /v1/retime
  matrix,          // POST /v1/matrix
  assign,          // POST /v1/assign
  export_vda5050,  // POST /v1/export/vda5050
  import_vda5050,  // POST /v1/import/vda5050
};

/// What a single request may ask for. The defaults are those of the service, and so are the names: they are
/// those of GET /v1/limits, by which the details of errors call them.
struct ServiceLimits {
  /// The budget of a request that names none; and of any: a longer one is clamped, with a warning in the
  /// answer. Both at most a day, and at least 1 ms; the default is at most the maximum.
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
  /// Bytes. Only what is known in advance is held to it: the figures that a simulation keeps of its runs.
  /// What a call allocates is not counted, unlike in the service.
  std::size_t max_plan_memory = 256u << 20;
};

/// What a program may say about a call, beside the body.
struct ServiceOptions {
  ServiceLimits limits = {};
  /// `request_id` of plans, simulations and errors, to find them again, for example in the program's log.
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
/// - What is wrong with the body is an answer: status 400 with line and column where it is not JSON, 422 with
///   `errors`, whose `pointer` names the place.
/// - When a stop is requested, the call ends within milliseconds. A plan is answered as at the end of its
///   budget, if some has been made. Where nothing can be answered, the status is 503 and the code `draining`.
/// - `control.progress` is called for Endpoint::plan. It may throw, which ends planning; answer() passes the
///   exception on.
/// - Memory is not bounded. If the process has none left, the answer has the status 503 and the code
///   `overloaded`.
///
/// Throws std::invalid_argument for limits that are out of range and for an endpoint that does not exist.
Answer answer(Endpoint endpoint, std::string_view body, const Control& control = {},
              const ServiceOptions& options = {});

}  // namespace fleetplan
