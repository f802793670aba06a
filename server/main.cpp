#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/printable.h"
#include "server/command/commands.h"
#include "server/http_server.h"
#include "server/ops/process.h"
#include "server/ops/settings.h"
#include "server/service/service.h"

namespace fleetplan::server {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kDrainCheck{20};
constexpr std::chrono::seconds kHousekeeping{5};
/// The time within which cancelled jobs must end; otherwise the process ends without them.
constexpr std::chrono::seconds kStopGrace{5};

/// Waits for SIGTERM and SIGINT. Construct it before any other thread is started.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }

  /// Waits for a signal. Returns false when none arrived within that time.
  bool wait(std::chrono::seconds patience) const {
    const timespec time{patience.count(), 0};
    return sigtimedwait(&set_, nullptr, &time) > 0;
  }

  /// Waits for so long. A SIGINT meanwhile, which is the second signal, ends the process.
  void linger(std::chrono::milliseconds patience) const {
    const auto end = Clock::now() + patience;
    for (auto left = Clock::duration(patience); left.count() > 0; left = end - Clock::now()) {
      const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
      const timespec time{seconds.count(), std::chrono::nanoseconds(left - seconds).count()};
      if (sigtimedwait(&set_, nullptr, &time) == SIGINT) std::_Exit(128 + SIGINT);
    }
  }

 private:
  sigset_t set_{};
};

/// Raises the limit of descriptors: every connection needs one, and the usual soft limit of 1024 is too low.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// Waits until all requests are answered. Returns false if some are not by the deadline.
bool await_idle(const HttpServer& server, const EndSignals& signals, Clock::time_point deadline) {
  while (!server.idle()) {
    if (Clock::now() >= deadline) return false;
    signals.linger(kDrainCheck);
  }
  return true;
}

std::string url_of(const Settings& settings, int port) {
  const bool ipv6 = settings.host.find(':') != std::string::npos;
  return "http://" + (ipv6 ? "[" + settings.host + "]" : settings.host) + ':' + std::to_string(port);
}

void announce(const Settings& settings, const HttpServer& server, const RequestLog& log) {
  const std::string url = url_of(settings, server.port());
  const auto admin_port = server.admin_port();
  const std::string admin_url = admin_port ? url_of(settings, *admin_port) : "";
  std::cout << "fleetplan " << kVersion << " listening on " << url << std::endl;
  if (admin_port)
    std::cout << "fleetplan " << kVersion << " health and metrics on " << admin_url << std::endl;
  log.info("started",
           {{"version", kVersion}, {"url", url}, {"admin_url", admin_url}, {"workers", settings.workers}});
}

/// Ends the service in this order, so that no accepted request is lost:
///
/// 1. It is not ready, but still serves, for --drain-delay-ms. Load balancers stop sending requests.
/// 2. New jobs are rejected. Accepted jobs get --drain-ms to finish.
/// 3. Jobs that still run are cancelled and answer with what they have.
/// 4. If a job does not end, the process ends with an error.
void drain(HttpServer& server, const Settings& settings, const EndSignals& signals, const RequestLog& log) {
  server.announce_end();
  signals.linger(settings.drain_delay);
  server.begin_drain();
  if (await_idle(server, signals, Clock::now() + settings.drain)) return;
  log.info("cancelling jobs that are still running");
  server.cancel_jobs();
  if (await_idle(server, signals, Clock::now() + kStopGrace)) return;
  log.error("a request did not end in time");
  log.flush();
  std::_Exit(1);
}

/// Serves until SIGTERM or SIGINT, then drains. Returns the exit code of the process: 0, or 1 when a port is
/// not available, stops accepting connections, or jobs did not end.
int run(const Settings& settings, Service service) {
  const EndSignals signals;
  keep_memory_small(settings.workers);
  raise_descriptor_limit();
  HttpServer server(settings, std::move(service));
  if (const auto fault = server.bind()) {
    std::cerr << "fleetplan: " << api::printable(*fault) << '\n';
    return 1;
  }
  const RequestLog& log = server.log();
  for (const std::string& name : settings.unknown_variables) {
    log.warn("unknown environment variable", {{"name", name}});
  }
  server.on_failure([] { ::kill(::getpid(), SIGTERM); });  // ends in order
  std::thread serving([&] { server.run(); });
  announce(settings, server, log);

  while (!signals.wait(kHousekeeping)) give_memory_back();
  log.info("draining", {{"delay_ms", settings.drain_delay.count()}, {"drain_ms", settings.drain.count()}});
  drain(server, settings, signals, log);
  server.stop();
  serving.join();
  log.info("stopped");
  return server.failed() ? 1 : 0;
}

}  // namespace
}  // namespace fleetplan::server

int main(int argc, char** argv) {
  using namespace fleetplan::server;
  open_standard_descriptors();
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const Streams streams{std::cin, std::cout, std::cerr, isatty(STDERR_FILENO) == 1};
  if (const auto code = run_command(arguments, planning_service, streams)) return *code;
  if (!arguments.empty() && arguments[0] == "serve") arguments.erase(arguments.begin());
  const auto parsed = parse_settings(std::move(arguments));
  if (const auto* exit = std::get_if<SettingsExit>(&parsed)) {
    (exit->code == 0 ? std::cout : std::cerr) << exit->text;
    return exit->code;
  }
  const auto& settings = std::get<Settings>(parsed);
  if (!settings.healthcheck) {
    Service service = planning_service();
    service.example_list();  // so that no client waits for it
    return run(settings, std::move(service));
  }
  const auto fault = health_fault(settings);
  if (fault) std::cerr << "fleetplan: " << fleetplan::api::printable(*fault) << '\n';
  return fault ? 1 : 0;
}
