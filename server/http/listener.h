#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "server/http/http_library.h"

namespace fleetplan::server {

/// A listening socket and a thread for every connection to it, up to a cap beyond which connections wait.
/// Construct, bind, run (in a thread of its own), stop.
class Listener final : private httplib::Server {
 public:
  /// Serves one connection; takes the socket over.
  using Serve = std::function<void(int fd)>;

  /// `port`: 0 for any free one. `serve` is called from many threads.
  Listener(std::string host, int port, std::size_t connections, Serve serve);
  ~Listener() override;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Takes the port; why not, otherwise.
  std::optional<std::string> bind();

  /// The bound one, also when any free port was asked for.
  int port() const { return port_; }

  /// Accepts until stop(), then waits for the connections to end; after bind().
  void run();

  /// Ends run(). May be called from any thread.
  void stop();

 private:
  bool process_and_close_socket(socket_t fd) override;

  const std::string host_;
  int port_;
  const Serve serve_;
  std::atomic<int> listening_fd_{-1};
};

}  // namespace fleetplan::server
