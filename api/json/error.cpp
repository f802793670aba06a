#include "api/json/error.h"

#include <array>

namespace fleetplan::api {

namespace {

constexpr std::array<ErrorRow, 21> kTable{{
    {ErrorCode::malformed_json, 400, "malformed_json", "Malformed JSON", "The body is not JSON."},
    {ErrorCode::too_deep, 400, "too_deep", "JSON Nested Too Deep",
     "The JSON of the body nests deeper than `max_depth` of `GET /v1/limits`."},
    {ErrorCode::malformed_request, 400, "malformed_request", "Bad Request",
     "The HTTP request itself is malformed."},
    {ErrorCode::unauthorized, 401, "unauthorized", "Unauthorized",
     "The service requires a token, and the request has none or a wrong one."},
    {ErrorCode::foreign_origin, 403, "foreign_origin", "Forbidden",
     "The request comes from a page of another origin (`Origin`), which `--cors-origin` does not list."},
    {ErrorCode::not_found, 404, "not_found", "Not Found", "There is no such path or example."},
    {ErrorCode::method_not_allowed, 405, "method_not_allowed", "Method Not Allowed",
     "The path does not support this method."},
    {ErrorCode::not_acceptable, 406, "not_acceptable", "Not Acceptable",
     "`Accept` excludes every media type of the answer."},
    {ErrorCode::request_timeout, 408, "request_timeout", "Request Timeout",
     "The head or the body of the request did not arrive in time."},
    {ErrorCode::body_too_large, 413, "body_too_large", "Content Too Large",
     "The body exceeds `max_body` of `GET /v1/limits`, as sent or decompressed."},
    {ErrorCode::target_too_long, 414, "target_too_long", "URI Too Long",
     "The path with its query is longer than 8 KiB."},
    {ErrorCode::unsupported_media_type, 415, "unsupported_media_type", "Unsupported Media Type",
     "The body is not declared to be JSON (`Content-Type: application/json`), plain or with gzip."},
    {ErrorCode::wrong_host, 421, "wrong_host", "Misdirected Request",
     "The service listens on loopback, and `Host` is neither a local name nor in `--allowed-hosts`."},
    {ErrorCode::invalid_request, 422, "invalid_request", "Invalid Request",
     "The body is JSON, but not a valid request. `errors` lists the first twenty faults in the order "
     "of the document; `errors_total` counts all."},
    {ErrorCode::check_unfinished, 422, "check_unfinished", "Check Not Finished",
     "`/v1/validate` could not check the plans within the budget, `/v1/simulate` finished no run, or "
     "`/v1/matrix` or `/v1/assign` did not have all travel times."},
    {ErrorCode::memory_exceeded, 422, "memory_exceeded", "Memory Limit Exceeded",
     "The request needs more memory than `max_plan_memory` of `GET /v1/limits`, so that there is not even a "
     "partial plan."},
    {ErrorCode::parse_unfinished, 422, "parse_unfinished", "Request Not Read",
     "Reading the body took more than a second of CPU time before the time budget was read, more than three "
     "seconds in all, or more than the budget: the request is too large for this service."},
    {ErrorCode::head_too_large, 431, "head_too_large", "Request Header Fields Too Large",
     "The head of the request is larger than 32 KiB, or has more than 100 fields."},
    {ErrorCode::internal_error, 500, "internal_error", "Internal Server Error",
     "A bug of the service, such as a plan that its checker rejected."},
    {ErrorCode::overloaded, 503, "overloaded", "Service Unavailable",
     "The queue is full, the time budget would be spent in the queue, or the large bodies being received "
     "would take too much memory together."},
    {ErrorCode::draining, 503, "draining", "Service Unavailable", "The service is shutting down."},
}};

constexpr bool is_in_order() {
  for (std::size_t index = 0; index < kTable.size(); ++index) {
    if (static_cast<std::size_t>(kTable[index].code) != index) return false;
  }
  return static_cast<std::size_t>(ErrorCode::draining) + 1 == kTable.size();
}
static_assert(is_in_order(), "every ErrorCode has its row, in the order of the enumeration");

}  // namespace

std::span<const ErrorRow> error_table() { return kTable; }

const ErrorRow& row_of(ErrorCode code) { return kTable[static_cast<std::size_t>(code)]; }

}  // namespace fleetplan::api
