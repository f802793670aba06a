#include "server/http_server.h"

#include <thread>
#include <utility>

namespace fleetplan::server {

namespace {

/// The most connections of the admin port: enough for probes and scrapers, and for a few that hang.
constexpr std::size_t kAdminConnections = 64;

/// The connections that may be open, for each that may be served at a time: the others wait for their
/// clients.
constexpr std::size_t kOpenPerServed = 4;

}  // namespace

HttpServer::HttpServer(const Settings& settings, Service service)
    : settings_(settings),
      service_(std::move(service)),
      log_(settings.log_level),
      files_(settings.web_root),
      cross_origin_(settings.cors_origins),
      body_memory_(settings.limits.max_body, settings.queue + static_cast<std::size_t>(settings.workers),
                   settings.connections),
      unsent_answers_(settings.max_unsent),
      jobs_(settings_, log_),
      backend_{settings_,
               service_,
               files_,
               [this](Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events) {
                 api::Reply reply = jobs_.run(exchange, endpoint, events);
                 exchange.release_body();
                 return reply;
               },
               [this] { return ready_.load(); },
               [this] { return metrics_.text(gauges()); }},
      main_routes_(main_routes(backend_)),
      admin_routes_(admin_routes(backend_)),
      metrics_(main_routes_),
      main_(*this, Steps::Port::main, settings.port, settings.connections, main_routes_) {
  if (settings_.admin_port) {
    admin_.emplace(*this, Steps::Port::admin, *settings_.admin_port, kAdminConnections, admin_routes_);
  }
}

HttpServer::ServedPort::ServedPort(HttpServer& server, Steps::Port port, int number,
                                   std::size_t max_connections, const RouteTable& routes)
    : steps(port, server.settings_, routes, server.cross_origin_, server.draining_, server.metrics_,
            server.log_),
      adapter({server.settings_.host, number, server.log_, server.draining_}),
      listener({max_connections, kOpenPerServed * max_connections, server.stop_signal_,
                [&server, this](int fd) { return server.connect(fd, *this); },
                [&server](const std::string& what) { server.log_.error(what); },
                [&server](const std::string& why) { server.fail(why); }}) {}

std::optional<std::string> HttpServer::bind() {
  if (auto fault = main_.adapter.bind()) return fault;
  if (!admin_) return std::nullopt;
  auto fault = admin_->adapter.bind();
  if (fault) *fault += " (--admin-port)";
  return fault;
}

std::optional<int> HttpServer::admin_port() const {
  return admin_ ? std::optional(admin_->adapter.port()) : std::nullopt;
}

void HttpServer::run() {
  std::thread admin;
  if (admin_) admin = std::thread([this] { admin_->listener.run(admin_->adapter.listening_fd()); });
  main_.listener.run(main_.adapter.listening_fd());
  if (admin.joinable()) admin.join();
}

void HttpServer::cancel_jobs() {
  jobs_.cancel_all();
  stop_signal_.raise();
}

void HttpServer::stop() {
  stop_signal_.raise();
  main_.listener.stop();
  if (admin_) admin_->listener.stop();
}

std::unique_ptr<Connection> HttpServer::connect(int fd, ServedPort& served) {
  return std::make_unique<Connection>(
      fd, ConnectionContext{settings_, served.steps, body_memory_, unsent_answers_, draining_,
                            served.exchanges, stop_signal_,
                            [&served](Exchange& exchange) { return served.adapter.answer(exchange); }});
}

void HttpServer::fail(const std::string& why) {
  log_.error("no more connections can be accepted: " + why);
  failed_ = true;
  if (on_failure_) on_failure_();
}

Gauges HttpServer::gauges() const {
  return {.connections = main_.listener.connections(),
          .admin_connections = admin_ ? admin_->listener.connections() : 0,
          .workers = static_cast<std::size_t>(settings_.workers),
          .jobs = jobs_.load(),
          .log_dropped = log_.dropped(),
          .maps = jobs_.maps(),
          .unsent = unsent_answers_.stats()};
}

}  // namespace fleetplan::server
