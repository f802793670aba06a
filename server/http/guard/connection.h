#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "server/http/answer/answer_text.h"
#include "server/http/exchange.h"
#include "server/http/guard/body_memory.h"
#include "server/http/steps/steps.h"
#include "server/ops/settings/settings.h"

namespace fleetplan::server {

/// What all connections of a port share.
struct ConnectionContext {
  const Settings& settings;
  const Steps& steps;
  BodyMemory& body_memory;
  const std::atomic<bool>& draining;
  std::atomic<std::size_t>& exchanges;    // under way
  int stop_fd;                            // see Socket
  std::function<Sent(Exchange&)> answer;  // has the library answer a request that passed all steps
};

/// Counts something as under way as long as it lives.
class UnderWay {
 public:
  explicit UnderWay(std::atomic<std::size_t>& count) : count_(count) { ++count_; }
  ~UnderWay() { --count_; }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

 private:
  std::atomic<std::size_t>& count_;
};

/// One client's connection: reads its requests strictly and takes each through the steps. Sends the answers
/// that need no handler itself.
class Connection {
 public:
  /// Takes the socket over.
  Connection(int fd, ConnectionContext context);

  /// Until the client leaves, is idle for too long, or the server stops.
  void serve();

 private:
  bool await_request();
  void serve_exchange(Exchange& exchange);
  std::optional<DirectAnswer> read_request(Exchange& exchange);
  std::optional<DirectAnswer> read_head(Exchange& exchange);
  std::optional<DirectAnswer> read_content(Exchange& exchange);
  Sent send(Exchange& exchange, const DirectAnswer& answer);
  void drop_body(Exchange& exchange);

  ConnectionContext context_;
  Socket socket_;
  const std::string peer_;
  std::string input_;  // read and not used yet
  bool open_ = true;
  bool unread_ = false;  // the client may still be sending
};

}  // namespace fleetplan::server
