#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <unordered_map>

#include "server/http/connection.h"
#include "server/http/cors.h"
#include "server/http/http_library.h"
#include "server/http/listener.h"
#include "server/http/static_files.h"
#include "server/jobs/job_runner.h"
#include "server/ops/metrics.h"
#include "server/ops/request_log.h"
#include "server/ops/settings.h"
#include "server/ops/stop_signal.h"
#include "server/service.h"

namespace fleetplan::server {

/// The service on a port, and health, readiness and metrics on another if one is set, whose connections have
/// their own threads. Construct, bind, run (in a thread of its own); to end: announce_end and begin_drain,
/// wait until idle, cancel_jobs if that takes too long, stop. All but bind and run may be called from any
/// thread.
class HttpServer final : private httplib::Server {
 public:
  HttpServer(const Settings& settings, Service service);
  ~HttpServer() override = default;
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Takes the ports; why not, otherwise.
  std::optional<std::string> bind();

  /// The bound one, also when any free port was asked for.
  int port() const { return main_.port(); }
  std::optional<int> admin_port() const;

  /// Serves until stop(); after bind().
  void run();

  /// Says that it is not ready any more, but serves everything on.
  void announce_end() { ready_ = false; }

  /// Not ready any more, no new jobs; what runs goes on.
  void begin_drain() {
    ready_ = false;
    draining_ = true;
  }

  /// No request is being read, worked on or answered, but for those of the admin port.
  bool idle() const { return traffic_.exchanges == 0; }

  /// Asks all jobs, now and later, to stop, and waits for no more of requests that are still being sent.
  void cancel_jobs();

  /// Ends run() once requests under way are answered.
  void stop();

 private:
  /// What goes on at one port.
  struct Traffic {
    std::atomic<std::size_t> connections{0};
    std::atomic<std::size_t> exchanges{0};
  };

  void serve(int fd, Port port);
  Gauges gauges() const;
  void install_handlers();
  bool answer(Exchange& exchange, ExchangeStream& stream);
  void answer_get(Exchange& exchange, httplib::Response& response);
  void answer_page(Exchange& exchange, httplib::Response& response);
  void answer_job(Exchange& exchange, const httplib::ContentReader& reader, httplib::Response& response);
  std::optional<api::Reply> decode_body(Exchange& exchange, const httplib::ContentReader& reader) const;
  Exchange* exchange_of(const httplib::Request& request);

  const Settings settings_;
  const Service service_;
  const RequestLog log_;
  const StaticFiles files_;
  const CrossOrigin cross_origin_;
  StopSignal stop_signal_;
  std::atomic<bool> ready_{true};
  std::atomic<bool> draining_{false};
  Traffic traffic_;
  Traffic admin_traffic_;
  Metrics metrics_;
  std::mutex exchanges_mutex_;
  std::unordered_map<const httplib::Request*, Exchange*> exchanges_;  // those in the library's hands
  Listener main_;
  std::optional<Listener> admin_;
  BodyMemory body_memory_;  // of as many large bodies as there may be jobs
  JobRunner jobs_;
};

}  // namespace fleetplan::server
