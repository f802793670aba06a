#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "server/http/exchange.h"
#include "server/http/http_library.h"
#include "server/http/route_table.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

/// The adapter to the HTTP library: the only class that derives from the library's server, for the members
/// that its versions keep protected. It listens with the library, registers the routes there, and hands it
/// requests that have been read and checked.
///
/// Construct, bind, run (in a thread of its own), stop.
class LibraryServer final : private httplib::Server {
 public:
  /// The parts that the adapter works with. References have to outlive it.
  struct Context {
    std::string host;
    int port;  // 0: any free one
    const RouteTable& routes;
    const RequestLog& log;
    const std::atomic<bool>& draining;
  };

  explicit LibraryServer(Context context);
  ~LibraryServer() override;
  LibraryServer(const LibraryServer&) = delete;
  LibraryServer& operator=(const LibraryServer&) = delete;

  /// Binds the port. Returns the reason if that fails.
  std::optional<std::string> bind();

  /// The bound port, even if the setting was 0.
  int port() const { return context_.port; }

  /// The bound socket, which listens and does not block.
  int listening_fd() const { return listening_fd_; }

  /// Has the library route the request to its handler and send the answer.
  Sent answer(Exchange& exchange);

 private:
  void add(const Route& route);
  void reply_with(api::Reply reply, httplib::Response& response) const;
  void complete(httplib::Response& response) const;

  /// The exchange of this thread. The library cannot pass it to handlers, but it handles a request from
  /// begin to end on the thread that hands it over, and each connection has its own thread.
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): set and cleared by answer() only
  static thread_local Exchange* current_;

  Context context_;
  int listening_fd_ = -1;
};

}  // namespace fleetplan::server
