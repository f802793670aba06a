// Stands in for the api layer's error table until that is linked.

#include "api/error.h"

namespace fleetplan::api {

int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::malformed_json:
    case ErrorCode::too_deep:
    case ErrorCode::malformed_request:
      return 400;
    case ErrorCode::unauthorized:
      return 401;
    case ErrorCode::not_found:
      return 404;
    case ErrorCode::method_not_allowed:
      return 405;
    case ErrorCode::not_acceptable:
      return 406;
    case ErrorCode::body_too_large:
      return 413;
    case ErrorCode::unsupported_media_type:
      return 415;
    case ErrorCode::invalid_request:
      return 422;
    case ErrorCode::internal_error:
      return 500;
    case ErrorCode::overloaded:
    case ErrorCode::draining:
      return 503;
  }
  return 500;
}

std::string_view name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::malformed_json:
      return "malformed_json";
    case ErrorCode::too_deep:
      return "too_deep";
    case ErrorCode::malformed_request:
      return "malformed_request";
    case ErrorCode::unauthorized:
      return "unauthorized";
    case ErrorCode::not_found:
      return "not_found";
    case ErrorCode::method_not_allowed:
      return "method_not_allowed";
    case ErrorCode::not_acceptable:
      return "not_acceptable";
    case ErrorCode::body_too_large:
      return "body_too_large";
    case ErrorCode::unsupported_media_type:
      return "unsupported_media_type";
    case ErrorCode::invalid_request:
      return "invalid_request";
    case ErrorCode::internal_error:
      return "internal_error";
    case ErrorCode::overloaded:
      return "overloaded";
    case ErrorCode::draining:
      return "draining";
  }
  return "";
}

Reply problem_reply(ErrorCode code, std::string detail, const std::string& request_id,
                    const std::vector<Fault>&) {
  std::string body = R"({"status":)" + std::to_string(status_of(code)) + R"(,"code":")";
  body += name_of(code);
  body += R"(","request_id":")" + request_id + R"(","detail":")" + detail + "\"}";
  return {status_of(code), kProblemJson, body};
}

}  // namespace fleetplan::api
