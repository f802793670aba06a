
#include "server/connections/steps.h"

#include <array>
#include <utility>

#include "server/http/request/content.h"
#include "server/http/request/request_head.h"
#include "server/http/text.h"

namespace fleetplan::server {

using api::ErrorCode;

Steps::Steps(Port port, const Settings& settings, const RouteTable& routes, const CrossOrigin& cross_origin,
             const std::atomic<bool>& draining, Metrics& metrics, const RequestLog& log)
    : port_(port),
      settings_(settings),
      routes_(routes),
      allowed_hosts_(settings.host, settings.allowed_hosts),
      cross_origin_(cross_origin),
      draining_(draining),
      metrics_(metrics),
      log_(log) {}

void Steps::begin(Exchange& exchange) const {
  const std::string sent_id = exchange.head.field("x-request-id");
  if (is_well_formed_request_id(sent_id)) exchange.request_id = sent_id;
  exchange.fields = cross_origin_.answer_fields(exchange.head);
  const std::string traceparent = exchange.head.field("traceparent");
  if (auto trace_id = trace_id_of(traceparent)) {
    exchange.trace_id = std::move(*trace_id);
    exchange.fields.emplace_back("traceparent", traceparent);
  }
  auto match = routes_.find(exchange.head.path);
  exchange.route = match.route;
  exchange.parameter = std::move(match.parameter);
}

std::optional<DirectAnswer> Steps::answer_to_head(const Exchange& exchange) const {
  static constexpr std::array kInOrder{&Steps::host,           &Steps::preflight, &Steps::origin,
                                       &Steps::authentication, &Steps::path,      &Steps::method,
                                       &Steps::content,        &Steps::draining};
  for (const auto step : kInOrder) {
    if (auto answer = (this->*step)(exchange)) return answer;
  }
  return std::nullopt;
}

Steps::Answer Steps::host(const Exchange& exchange) const {
  if (allowed_hosts_.admits(exchange.head)) return std::nullopt;
  return refusal(exchange, ErrorCode::wrong_host,
                 std::string("This service listens on loopback for requests to a local name, not to ") +
                     in_quotes(exchange.head.host.value_or("")) +
                     ": use localhost, or start it with --allowed-hosts.");
}

Steps::Answer Steps::preflight(const Exchange& exchange) const {
  if (exchange.route == nullptr || !cross_origin_.is_preflight(exchange.head)) return std::nullopt;
  api::Reply no_content{204, "", ""};
  return DirectAnswer{std::move(no_content),
                      CrossOrigin::preflight_fields(exchange.route->allowed_methods())};
}

Steps::Answer Steps::origin(const Exchange& exchange) const {
  const Route* route = exchange.route;
  const bool has_effect = route != nullptr && route->takes_body() && route->allows(exchange.head.method);
  if (!has_effect || cross_origin_.admits(exchange.head)) return std::nullopt;
  return refusal(exchange, ErrorCode::foreign_origin,
                 std::string("Pages of the origin ") + in_quotes(exchange.head.field("origin")) +
                     " may not use this service, unless it is started with --cors-origin.");
}

/// Returns the refusal of a client without the token. Programs send the token as Bearer; for Basic, browsers
/// show a login dialog.
Steps::Answer Steps::authentication(const Exchange& exchange) const {
  const bool open = exchange.route != nullptr && exchange.route->traits.without_token;
  if (!settings_.token || open || settings_.token->admits(exchange.head.field("authorization"))) {
    return std::nullopt;
  }
  return refusal(exchange, ErrorCode::unauthorized,
                 "Send the service's token as 'Authorization: Bearer ...', or as the password of Basic.",
                 {{"WWW-Authenticate", R"(Bearer realm="fleetplan")"},
                  {"WWW-Authenticate", R"(Basic realm="fleetplan", charset="UTF-8")"}});
}

Steps::Answer Steps::path(const Exchange& exchange) const {
  if (exchange.route != nullptr) return std::nullopt;
  return refusal(exchange, ErrorCode::not_found,
                 std::string("There is no resource at ") + in_quotes(exchange.head.path) + '.');
}

Steps::Answer Steps::method(const Exchange& exchange) const {
  const RequestHead& head = exchange.head;
  if (exchange.route->allows(head.method)) return std::nullopt;
  const std::string allowed(exchange.route->allowed_methods());
  return refusal(exchange, ErrorCode::method_not_allowed,
                 in_quotes(head.path) + " allows " + allowed + ", not " + in_quotes(head.method) + '.',
                 {{"Allow", allowed}});
}

Steps::Answer Steps::content(const Exchange& exchange) const {
  if (!exchange.route->takes_body()) return std::nullopt;
  const RequestHead& head = exchange.head;
  if (const auto fault = content_type_fault(head.field("content-type"))) {
    return refusal(exchange, ErrorCode::unsupported_media_type, *fault);
  }
  const std::string coding = head.field("content-encoding");
  if (content_coding(coding) == ContentCoding::unknown) {
    return refusal(
        exchange, ErrorCode::unsupported_media_type,
        std::string("The body's Content-Encoding is ") + in_quotes(coding) + ": send it plain or with gzip.",
        {{"Accept-Encoding", "gzip"}});
  }
  const std::string accept = head.field("accept");
  if (exchange.route->traits.events && !plan_form(accept)) {
    return refusal(exchange, ErrorCode::not_acceptable,
                   std::string("Answers are application/json or text/event-stream, which Accept: ") +
                       in_quotes(accept) + " excludes: add application/json or leave the header out.");
  }
  const std::uint64_t limit = settings_.limits.max_body;
  if (head.content_length && *head.content_length > limit) {
    return refusal(exchange, ErrorCode::body_too_large,
                   api::too_large_body_detail(std::to_string(*head.content_length), limit));
  }
  return std::nullopt;
}

Steps::Answer Steps::draining(const Exchange& exchange) const {
  if (!draining_ || !exchange.route->takes_body()) return std::nullopt;
  return refusal(exchange, ErrorCode::draining, api::kDrainingDetail);
}

void Steps::end(Exchange& exchange, std::uint64_t bytes_out, const std::string& peer) const {
  if (exchange.abandoned) {
    exchange.status = 499;
    exchange.problem = {};  // no answer was sent
  }
  metrics_.count(exchange);
  const std::chrono::duration<double, std::milli> elapsed = Exchange::Clock::now() - exchange.begun_at;
  RequestRecord record;
  record.id = exchange.request_id;
  record.trace_id = exchange.trace_id;
  record.method = exchange.head.method;
  record.path = exchange.head.raw_path;
  record.status = exchange.status;
  record.bytes_in = exchange.bytes_in;
  record.bytes_out = bytes_out;
  record.ms = elapsed.count();
  record.queue_ms = exchange.queue_ms;
  record.problem = exchange.problem;
  record.outcome = exchange.outcome;
  record.peer = peer;
  record.forwarded = exchange.head.field("x-forwarded-for");
  record.admin = port_ == Port::admin;
  log_.request(record);
}

}  // namespace fleetplan::server
