#pragma once

// The errors of the service, from one table, and why a request cannot be read.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/faults.h"

namespace fleetplan::api {

/// Every error of the service; its row in the table (error.cpp) gives the HTTP status, `code` and `title`.
enum class ErrorCode {
  malformed_json,          // 400
  too_deep,                // 400
  malformed_request,       // 400, framing
  unauthorized,            // 401
  foreign_origin,          // 403, a page of another origin
  not_found,               // 404
  method_not_allowed,      // 405
  not_acceptable,          // 406
  request_timeout,         // 408, head or body not complete in time
  body_too_large,          // 413
  target_too_long,         // 414, request target
  unsupported_media_type,  // 415
  wrong_host,              // 421, the Host of a request to a service on loopback
  invalid_request,         // 422, with one entry in `errors` for each fault
  check_unfinished,        // 422, a plan that takes longer to check than the budget
  memory_exceeded,         // 422, a request that needs more memory than it is granted
  parse_unfinished,        // 422, a request that takes too long to read
  head_too_large,          // 431, header fields by size or number
  internal_error,          // 500
  overloaded,              // 503, queue full
  draining,                // 503, shutting down
};

/// Ends the detail of a body that is too large: nearly always its map.
inline constexpr const char* kLargeMapRemedy =
    " A large map is smallest as a PNG, in map.image.png; see GET /v1/limits.";

inline constexpr const char* kDrainingDetail = "The service is shutting down: try another replica.";

struct ErrorRow {
  ErrorCode code;
  int status;
  std::string_view name;         // `code` of the answer
  std::string_view title;        // as in RFC 9110 where the status says it all
  std::string_view description;  // when the error is returned, for the OpenAPI document
};

/// Returns the table, in the order of ErrorCode. api/openapi.json has a response for each status in it.
std::span<const ErrorRow> error_table();

const ErrorRow& row_of(ErrorCode code);
inline int status_of(ErrorCode code) { return row_of(code).status; }
inline std::string_view name_of(ErrorCode code) { return row_of(code).name; }

/// Why a request cannot be read.
struct RequestError {
  ErrorCode code = ErrorCode::invalid_request;
  std::string detail;
  std::vector<Fault> faults;  // the listed faults
  std::size_t faults_total = 0;
};

}  // namespace fleetplan::api
