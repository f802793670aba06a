#include "server/run.h"

#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <thread>
#include <utility>

#include "server/http_server.h"
#include "server/version.h"

namespace fleetplan::server {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kDrainCheck{20};
/// A job that was asked to stop does so within this, or the process ends without it.
constexpr std::chrono::seconds kStopGrace{5};

/// SIGTERM and SIGINT, taken by whoever waits for them here. To be made before any other thread.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }

  void wait() const {
    int number = 0;
    while (sigwait(&set_, &number) != 0) {
    }
  }

  bool interrupted_within(std::chrono::nanoseconds patience) const {
    const timespec time{0, static_cast<long>(patience.count())};
    return sigtimedwait(&set_, nullptr, &time) == SIGINT;
  }

 private:
  sigset_t set_{};
};

/// Every connection is a descriptor; the usual soft limit of 1024 would be in the way.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// True when all requests were answered by the deadline. A second SIGINT ends the process.
bool await_idle(const HttpServer& server, const EndSignals& signals, Clock::time_point deadline) {
  while (!server.idle()) {
    if (Clock::now() >= deadline) return false;
    if (signals.interrupted_within(kDrainCheck)) std::_Exit(128 + SIGINT);
  }
  return true;
}

std::string url_of(const Settings& settings, int port) {
  const bool ipv6 = settings.host.find(':') != std::string::npos;
  return "http://" + (ipv6 ? "[" + settings.host + "]" : settings.host) + ':' + std::to_string(port);
}

}  // namespace

int run(const Settings& settings, Service service) {
  const EndSignals signals;
  raise_descriptor_limit();
  HttpServer server(settings, std::move(service));
  if (const auto fault = server.bind()) {
    std::cerr << "fleetplan: " << *fault << '\n';
    return 1;
  }
  std::thread serving([&] { server.run(); });
  std::cout << "fleetplan " << kVersion << " listening on " << url_of(settings, server.port()) << std::endl;

  signals.wait();
  server.begin_drain();
  if (!await_idle(server, signals, Clock::now() + settings.drain)) {
    server.cancel_jobs();
    if (!await_idle(server, signals, Clock::now() + kStopGrace)) {
      std::cerr << "fleetplan: a request did not end in time\n";
      std::_Exit(1);
    }
  }
  server.stop();
  serving.join();
  return 0;
}

}  // namespace fleetplan::server
