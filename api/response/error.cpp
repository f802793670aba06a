#include "api/response/error.h"

#include <array>

#include "api/json/json_writer.h"

namespace fleetplan::api {

namespace {

struct Row {
  ErrorCode code;
  int status;
  std::string_view name;
  std::string_view title;
};

// In the order of ErrorCode.
constexpr std::array<Row, 17> kTable{{
    {ErrorCode::malformed_json, 400, "malformed_json", "The body is not JSON"},
    {ErrorCode::too_deep, 400, "too_deep", "The JSON is nested too deep"},
    {ErrorCode::malformed_request, 400, "malformed_request", "The HTTP request is malformed"},
    {ErrorCode::unauthorized, 401, "unauthorized", "A valid token is required"},
    {ErrorCode::not_found, 404, "not_found", "There is nothing here"},
    {ErrorCode::method_not_allowed, 405, "method_not_allowed", "This resource has other methods"},
    {ErrorCode::not_acceptable, 406, "not_acceptable", "No acceptable form of the answer"},
    {ErrorCode::request_timeout, 408, "request_timeout", "The request did not come in time"},
    {ErrorCode::body_too_large, 413, "body_too_large", "The body is too large"},
    {ErrorCode::target_too_long, 414, "target_too_long", "The request target is too long"},
    {ErrorCode::unsupported_media_type, 415, "unsupported_media_type", "The body is of another media type"},
    {ErrorCode::invalid_request, 422, "invalid_request", "The request is not valid"},
    {ErrorCode::check_unfinished, 422, "check_unfinished", "The check did not end in time"},
    {ErrorCode::head_too_large, 431, "head_too_large", "The header fields are too large"},
    {ErrorCode::internal_error, 500, "internal_error", "The service has a fault"},
    {ErrorCode::overloaded, 503, "overloaded", "The service has too much to do"},
    {ErrorCode::draining, 503, "draining", "The service is shutting down"},
}};

const Row& row_of(ErrorCode code) { return kTable[static_cast<std::size_t>(code)]; }

constexpr bool is_in_order() {
  for (std::size_t index = 0; index < kTable.size(); ++index) {
    if (static_cast<std::size_t>(kTable[index].code) != index) return false;
  }
  return static_cast<std::size_t>(ErrorCode::draining) + 1 == kTable.size();
}
static_assert(is_in_order(), "every ErrorCode has its row, in the order of the enumeration");

}  // namespace

std::vector<ErrorCode> error_codes() {
  std::vector<ErrorCode> codes;
  codes.reserve(kTable.size());
  for (const Row& row : kTable) codes.push_back(row.code);
  return codes;
}

int status_of(ErrorCode code) { return row_of(code).status; }

std::string_view name_of(ErrorCode code) { return row_of(code).name; }

Reply problem_reply(ErrorCode code, const std::string& detail, const std::string& request_id,
                    const std::vector<Fault>& faults) {
  const Row& row = row_of(code);
  JsonWriter json;
  json.begin_object();
  // A name, not an address: there is no page behind it.
  json.member("type", "urn:fleetplan:problem:" + std::string(row.name));
  json.member("title", row.title).member("status", row.status).member("detail", detail);
  json.member("code", row.name).member("request_id", request_id);
  json.key("errors").begin_array();
  for (const Fault& fault : faults) {
    json.begin_object();
    json.member("pointer", fault.pointer).member("code", fault.code).member("detail", fault.detail);
    json.end_object();
  }
  json.end_array().end_object();
  return {row.status, kProblemJson, json.take(), row.name};
}

}  // namespace fleetplan::api
