#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "server/http/exchange.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

/// The adapter to cpp-httplib. It binds a port, and writes the answers of handlers to requests that have been
/// read, judged and routed.
///
/// Construct, bind, then answer.
class HttplibAdapter {
 public:
  /// The parts that the adapter works with. References must outlive it.
  struct Context {
    std::string host;
    int port;  // 0: any free one
    const RequestLog& log;
    const std::atomic<bool>& draining;
  };

  explicit HttplibAdapter(Context context);
  ~HttplibAdapter();
  HttplibAdapter(const HttplibAdapter&) = delete;
  HttplibAdapter& operator=(const HttplibAdapter&) = delete;

  /// Binds the port. Returns the reason if that fails.
  std::optional<std::string> bind();

  /// The bound port, even if the setting was 0.
  int port() const { return context_.port; }

  /// The bound socket, which listens and does not block.
  int listening_fd() const { return listening_fd_; }

  /// Calls the handler of the exchange's route, and sends its answer. May be called from several threads.
  Sent answer(Exchange& exchange) const;

 private:
  Context context_;
  int listening_fd_ = -1;
};

}  // namespace fleetplan::server
