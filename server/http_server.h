#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/connections/connection.h"
#include "server/connections/httplib_adapter.h"
#include "server/connections/listener.h"
#include "server/connections/steps.h"
#include "server/http/answer/unsent_answers.h"
#include "server/http/request/access.h"
#include "server/http/request/body_reader.h"
#include "server/http/static_files.h"
#include "server/jobs/job_runner.h"
#include "server/ops/metrics.h"
#include "server/ops/request_log.h"
#include "server/ops/settings.h"
#include "server/routes.h"
#include "server/service/service.h"

namespace fleetplan::server {

/// The service on its main port, and on the admin port if one is set. The connections of the admin port have
/// their own threads. Construct, bind, run (in a separate thread).
///
/// To end: announce_end, begin_drain, wait until idle, cancel_jobs if that takes too long, stop. All
/// functions except bind and run may be called from any thread.
class HttpServer {
 public:
  HttpServer(const Settings& settings, Service service);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Binds the ports. Returns the reason if that fails.
  std::optional<std::string> bind();

  /// The bound port, even if the setting was 0.
  int port() const { return main_.adapter.port(); }
  std::optional<int> admin_port() const;

  /// Serves until stop(). Call it after bind().
  void run();

  /// Sets a function that is called when a port cannot accept connections any more. Call this before run().
  /// Open connections are still served.
  void on_failure(std::function<void()> call) { on_failure_ = std::move(call); }

  /// Whether a port cannot accept connections any more.
  bool failed() const { return failed_; }

  /// Makes /readyz answer 503 from now on. Everything is still served.
  void announce_end() { ready_ = false; }

  /// Makes /readyz answer 503, and refuses new jobs. Accepted jobs continue.
  void begin_drain() {
    ready_ = false;
    draining_ = true;
  }

  const RequestLog& log() const { return log_; }

  /// Whether no request of the main port is being read, computed or answered.
  bool idle() const { return main_.exchanges == 0; }

  /// Requests a stop of all jobs, now and later. Also stops waiting for requests that are still being sent.
  void cancel_jobs();

  /// Ends run() once requests under way are answered.
  void stop();

 private:
  /// A port with its steps and its load.
  struct ServedPort {
    ServedPort(HttpServer& server, Steps::Port port, int number, std::size_t max_connections,
               const RouteTable& routes);

    std::atomic<std::size_t> exchanges{0};
    Steps steps;
    HttplibAdapter adapter;
    Listener listener;
  };

  std::unique_ptr<Connection> connect(int fd, ServedPort& served);
  void fail(const std::string& why);
  Gauges gauges() const;

  const Settings settings_;
  const Service service_;
  const RequestLog log_;
  const StaticFiles files_;
  const CrossOrigin cross_origin_;
  StopSignal stop_signal_;
  std::atomic<bool> ready_{true};
  std::atomic<bool> draining_{false};
  std::atomic<bool> failed_{false};
  std::function<void()> on_failure_;
  BodyMemory body_memory_;  // for as many large bodies as there may be jobs
  UnsentAnswers unsent_answers_;
  JobRunner jobs_;
  const Backend backend_;
  const RouteTable main_routes_;
  const RouteTable admin_routes_;
  Metrics metrics_;
  ServedPort main_;
  std::optional<ServedPort> admin_;
};

}  // namespace fleetplan::server
