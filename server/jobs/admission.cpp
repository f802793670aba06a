#include "server/jobs/admission.h"

#include "server/http/negotiation.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

using api::ErrorCode;

std::optional<Refusal> job_fault(const RequestHead& head, const Route& route, std::uint64_t max_body) {
  if (auto fault = content_type_fault(head.field("content-type"))) {
    return Refusal{ErrorCode::unsupported_media_type, *fault};
  }
  if (content_coding(head.field("content-encoding")) == ContentCoding::unknown) {
    return Refusal{ErrorCode::unsupported_media_type,
                   std::string("The body's Content-Encoding is ") +
                       in_quotes(head.field("content-encoding")) + ": send it plain or with gzip.",
                   {{"Accept-Encoding", "gzip"}}};
  }
  if (route.endpoint == Endpoint::plan && !plan_form(head.field("accept"))) {
    return Refusal{ErrorCode::not_acceptable,
                   std::string("Plans are application/json or text/event-stream, which Accept: ") +
                       in_quotes(head.field("accept")) +
                       " excludes: add application/json or leave the header out."};
  }
  if (head.content_length && *head.content_length > max_body) {
    return Refusal{ErrorCode::body_too_large, "The body has " + std::to_string(*head.content_length) +
                                                  " bytes; the limit is " + std::to_string(max_body) + "."};
  }
  return std::nullopt;
}

/// Programs show the token as Bearer; Basic is what browsers can ask a person for.
std::optional<Refusal> token_fault(const RequestHead& head, const Route& route, const Settings& settings) {
  const bool open = route.endpoint == Endpoint::healthz || route.endpoint == Endpoint::readyz;
  if (!settings.token || open || settings.token->admits(head.field("authorization"))) return std::nullopt;
  return Refusal{ErrorCode::unauthorized,
                 "Send the service's token as 'Authorization: Bearer ...', or as the password of Basic.",
                 {{"WWW-Authenticate", R"(Bearer realm="fleetplan")"},
                  {"WWW-Authenticate", R"(Basic realm="fleetplan", charset="UTF-8")"}}};
}

}  // namespace

Route route_of(const RequestHead& head, Port port, const StaticFiles& files) {
  Route route = find_route(head.path, port);
  const bool is_file = port == Port::main && route.endpoint == Endpoint::unknown && files.contains(head.path);
  return is_file ? Route{Endpoint::page, head.path} : route;
}

std::optional<Refusal> admission_fault(const RequestHead& head, const Route& route, const Settings& settings,
                                       bool draining) {
  if (auto fault = token_fault(head, route, settings)) return fault;
  if (route.endpoint == Endpoint::unknown)
    return Refusal{ErrorCode::not_found, std::string("There is nothing at ") + in_quotes(head.path) + '.'};
  if (!is_allowed(route.endpoint, head.method)) {
    const std::string allowed(allowed_methods(route.endpoint));
    return Refusal{ErrorCode::method_not_allowed,
                   in_quotes(head.path) + " takes " + allowed + ", not " + in_quotes(head.method) + '.',
                   {{"Allow", allowed}}};
  }
  if (head.method == "POST") {
    if (auto fault = job_fault(head, route, settings.limits.max_body)) return fault;
    if (draining) {
      return Refusal{ErrorCode::draining, "The service is shutting down: ask another one."};
    }
  }
  return std::nullopt;
}

}  // namespace fleetplan::server
