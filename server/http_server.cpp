#include "server/http_server.h"

#include <exception>
#include <thread>
#include <utility>

#include "server/http/guard/connection.h"

namespace fleetplan::server {

namespace {

/// Of the admin port: enough for probes and scrapers, and for a few that hang.
constexpr std::size_t kAdminConnections = 64;

}  // namespace

HttpServer::HttpServer(const Settings& settings, Service service)
    : settings_(settings),
      service_(std::move(service)),
      log_(settings.log_level),
      files_(settings.web_root),
      cross_origin_(settings.cors_origins),
      body_memory_(settings.limits.max_body, settings.queue + static_cast<std::size_t>(settings.workers)),
      jobs_(settings_, log_),
      backend_{settings_,
               service_,
               files_,
               [this](Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events) {
                 return jobs_.run(exchange, endpoint, events);
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

HttpServer::Endpoint::Endpoint(HttpServer& server, Steps::Port port, int number, std::size_t max_connections,
                               const RouteTable& routes)
    : steps(port, server.settings_, routes, server.cross_origin_, server.draining_, server.metrics_,
            server.log_),
      library({server.settings_.host, number, max_connections, routes, server.settings_.limits.max_body,
               server.log_, server.draining_, [&server, this](int fd) { server.serve(fd, *this); }}) {}

std::optional<std::string> HttpServer::bind() {
  if (auto fault = main_.library.bind()) return fault;
  if (!admin_) return std::nullopt;
  auto fault = admin_->library.bind();
  if (fault) *fault += " (--admin-port)";
  return fault;
}

std::optional<int> HttpServer::admin_port() const {
  return admin_ ? std::optional(admin_->library.port()) : std::nullopt;
}

void HttpServer::run() {
  std::thread admin;
  if (admin_) admin = std::thread([this] { admin_->library.run(); });
  main_.library.run();
  if (admin.joinable()) admin.join();
}

void HttpServer::cancel_jobs() {
  jobs_.cancel_all();
  stop_signal_.raise();
}

void HttpServer::stop() {
  stop_signal_.raise();
  main_.library.stop();
  if (admin_) admin_->library.stop();
}

void HttpServer::serve(int fd, Endpoint& endpoint) {
  const UnderWay open(endpoint.connections);
  try {
    Connection connection(
        fd, {settings_, endpoint.steps, body_memory_, draining_, endpoint.exchanges, stop_signal_.fd(),
             [&endpoint](Exchange& exchange) { return endpoint.library.answer(exchange); }});
    connection.serve();
  } catch (const std::exception& failure) {  // e.g. no memory for its body: ends this connection only
    log_.error(failure.what());
  }
}

Gauges HttpServer::gauges() const {
  return {main_.connections, admin_ ? admin_->connections.load() : 0,
          static_cast<std::size_t>(settings_.workers), jobs_.load(), log_.dropped()};
}

}  // namespace fleetplan::server
