#include "server/http/http_server.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "api/response/error.h"
#include "server/http/answer_fields.h"
#include "server/http/event_stream.h"
#include "server/http/guarded.h"
#include "server/http/negotiation.h"
#include "server/http/under_way.h"
#include "server/info_endpoints.h"
#include "server/ops/metrics_text.h"

namespace fleetplan::server {

namespace {

using api::ErrorCode;

/// Of the admin port: enough for probes and scrapers, and for a few that hang.
constexpr std::size_t kAdminConnections = 64;

constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// For metrics and the log.
void note(Exchange& exchange, const api::Reply& reply) {
  exchange.problem = reply.problem;
  exchange.outcome = reply.outcome;
}

void fill(Exchange& exchange, httplib::Response& response, api::Reply reply) {
  note(exchange, reply);
  response.status = reply.status;
  response.body = std::move(reply.body);
  response.set_header("Content-Type", reply.content_type);
}

}  // namespace

HttpServer::HttpServer(const Settings& settings, Service service)
    : settings_(settings),
      service_(std::move(service)),
      log_(settings.log_level),
      files_(settings.web_root),
      cross_origin_(settings.cors_origins),
      main_(settings.host, settings.port, settings.connections, [this](int fd) { serve(fd, Port::main); }),
      body_memory_(settings.limits.max_body, settings.queue + static_cast<std::size_t>(settings.workers)),
      jobs_(settings_, log_) {
  if (settings_.admin_port) {
    admin_.emplace(settings_.host, *settings_.admin_port, kAdminConnections,
                   [this](int fd) { serve(fd, Port::admin); });
  }
  install_handlers();
}

std::optional<std::string> HttpServer::bind() {
  if (auto fault = main_.bind()) return fault;
  if (!admin_) return std::nullopt;
  auto fault = admin_->bind();
  if (fault) *fault += " (--admin-port)";
  return fault;
}

std::optional<int> HttpServer::admin_port() const {
  return admin_ ? std::optional(admin_->port()) : std::nullopt;
}

void HttpServer::run() {
  std::thread admin;
  if (admin_) admin = std::thread([this] { admin_->run(); });
  main_.run();
  if (admin.joinable()) admin.join();
}

void HttpServer::cancel_jobs() {
  jobs_.cancel_all();
  stop_signal_.raise();
}

void HttpServer::stop() {
  stop_signal_.raise();
  main_.stop();
  if (admin_) admin_->stop();
}

void HttpServer::serve(int fd, Port port) {
  Traffic& traffic = port == Port::main ? traffic_ : admin_traffic_;
  const UnderWay open(traffic.connections);
  try {
    Connection connection(
        fd, {settings_, port, files_, cross_origin_, log_, metrics_, body_memory_, draining_,
             traffic.exchanges, stop_signal_.fd(),
             [this](Exchange& exchange, ExchangeStream& stream) { return answer(exchange, stream); }});
    connection.serve();
  } catch (
      const std::exception& failure) {  // of one connection, such as no memory for its body: only that ends
    log_.error(failure.what());
  }
}

Gauges HttpServer::gauges() const {
  return {traffic_.connections, admin_traffic_.connections, static_cast<std::size_t>(settings_.workers),
          jobs_.running(), jobs_.queued()};
}

bool HttpServer::answer(Exchange& exchange, ExchangeStream& stream) {
  const httplib::Request* key = nullptr;
  const auto setup = [&](httplib::Request& request) {
    const std::lock_guard lock(exchanges_mutex_);
    key = &request;
    exchanges_[key] = &exchange;
  };
  bool closed = false;
  const auto process = [&](auto& self) {
    // The addresses came in with a later version of the library.
    if constexpr (requires { self.process_request(stream, false, closed, setup); }) {
      return self.process_request(stream, false, closed, setup);
    } else {
      return self.process_request(stream, "", 0, "", 0, false, closed, setup);
    }
  };
  const bool written = process(*this);
  const std::lock_guard lock(exchanges_mutex_);
  exchanges_.erase(key);
  return written;
}

Exchange* HttpServer::exchange_of(const httplib::Request& request) {
  const std::lock_guard lock(exchanges_mutex_);
  const auto found = exchanges_.find(&request);
  return found == exchanges_.end() ? nullptr : found->second;
}

void HttpServer::install_handlers() {
  // All requests are shown to the library as one path, see ExchangeStream.
  Get("/", [this](const httplib::Request& request, httplib::Response& response) {
    answer_get(*exchange_of(request), response);
  });
  Post("/",
       [this](const httplib::Request& request, httplib::Response& response,
              const httplib::ContentReader& reader) { answer_job(*exchange_of(request), reader, response); });
  set_exception_handler(
      [this](const httplib::Request& request, httplib::Response& response, std::exception_ptr failure) {
        if (Exchange* exchange = exchange_of(request)) {
          fill(*exchange, response,
               guarded(log_, exchange->request_id, [&]() -> api::Reply { std::rethrow_exception(failure); }));
        }
      });
  set_post_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    Exchange* exchange = exchange_of(request);
    if (exchange == nullptr) return;
    exchange->status = response.status;
    if (draining_) exchange->close = true;
    for (const char* name : {"Keep-Alive", "Accept-Ranges", "Connection"}) response.headers.erase(name);
    response.set_header(
        "Vary", exchange->route.endpoint == Endpoint::plan ? "Accept, Accept-Encoding" : "Accept-Encoding");
    if (response.status == 304) response.headers.erase("Content-Length");
    for (const auto& [name, value] : common_fields(*exchange)) response.set_header(name, value);
  });
}

void HttpServer::answer_get(Exchange& exchange, httplib::Response& response) {
  const Route& route = exchange.route;
  if (route.endpoint == Endpoint::page) return answer_page(exchange, response);
  fill(exchange, response, guarded(log_, exchange.request_id, [&]() -> api::Reply {
         switch (route.endpoint) {
           case Endpoint::example_list:
             return service_.example_list();
           case Endpoint::example:
             return example_reply(service_, route.parameter, exchange.request_id);
           case Endpoint::limits:
             return limits_reply(settings_);
           case Endpoint::openapi:
             return service_.openapi();
           case Endpoint::metrics:
             return {200, kMetricsType, metrics_.text(gauges())};
           case Endpoint::readyz:
             return readiness_reply(ready_, exchange.request_id);
           default:
             return health_reply();
         }
       }));
}

void HttpServer::answer_page(Exchange& exchange, httplib::Response& response) {
  auto file = files_.read(exchange.route.parameter);
  if (!file) {
    const std::string detail = files_.has_root() ? "The page's folder has no such file."
                                                 : "This server has no page: start it with --web-root.";
    return fill(exchange, response, api::problem_reply(ErrorCode::not_found, detail, exchange.request_id));
  }
  response.set_header("ETag", file->etag);
  response.set_header("Cache-Control", file->cache_control);
  response.set_header("Content-Security-Policy", kContentSecurityPolicy);
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Opener-Policy", "same-origin");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  if (exchange.head.field("if-none-match").find(file->etag) != std::string::npos) {
    response.status = 304;
    return;
  }
  fill(exchange, response, {200, file->content_type, std::move(file->body)});
}

void HttpServer::answer_job(Exchange& exchange, const httplib::ContentReader& reader,
                            httplib::Response& response) {
  if (auto refusal = decode_body(exchange, reader)) return fill(exchange, response, std::move(*refusal));
  const auto& endpoint = exchange.route.endpoint == Endpoint::plan ? service_.plan : service_.validate;
  std::optional<EventStream> events;
  if (plan_form(exchange.head.field("accept")) == PlanForm::events) events.emplace(exchange);
  api::Reply reply = jobs_.run(exchange, endpoint, events ? &*events : nullptr);
  if (events && events->begun()) {
    note(exchange, reply);
    events->end(reply);
    response.status = 200;
    return;
  }
  fill(exchange, response, std::move(reply));
}

std::optional<api::Reply> HttpServer::decode_body(Exchange& exchange,
                                                  const httplib::ContentReader& reader) const {
  if (content_coding(exchange.head.field("content-encoding")) == ContentCoding::identity) return std::nullopt;
  const std::size_t limit = settings_.limits.max_body;
  std::string decoded;
  bool too_large = false;
  bool has_room = true;
  const bool complete = reader([&](const char* data, std::size_t size) {
    too_large = size > limit - decoded.size();
    has_room = exchange.memory->grow_to(exchange.body.size() + decoded.size() + size);
    if (too_large || !has_room) return false;
    decoded.append(data, size);
    return true;
  });
  const auto refused = [&](ErrorCode code, const std::string& detail) {
    return api::problem_reply(code, detail, exchange.request_id);
  };
  if (too_large) {
    return refused(ErrorCode::body_too_large, "The body of " + std::to_string(exchange.body.size()) +
                                                  " bytes has more than " + std::to_string(limit) +
                                                  " bytes when decompressed, which is the limit.");
  }
  if (!has_room) return refused(ErrorCode::overloaded, BodyMemory::kFull);
  if (!complete) return refused(ErrorCode::malformed_request, "The body is not in gzip, as it is declared.");
  exchange.body = std::move(decoded);
  return std::nullopt;
}

}  // namespace fleetplan::server
