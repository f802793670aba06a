#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "server/http/body_memory.h"
#include "server/http/cors.h"
#include "server/http/exchange.h"
#include "server/http/exchange_stream.h"
#include "server/http/header_fields.h"
#include "server/http/static_files.h"
#include "server/jobs/admission.h"
#include "server/ops/metrics.h"
#include "server/ops/request_log.h"
#include "server/ops/settings.h"

namespace fleetplan::server {

/// What all connections share.
struct ConnectionContext {
  const Settings& settings;
  Port port;
  const StaticFiles& files;
  const CrossOrigin& cross_origin;
  const RequestLog& log;
  Metrics& metrics;
  BodyMemory& body_memory;
  const std::atomic<bool>& draining;
  std::atomic<std::size_t>& exchanges;                     // under way
  int stop_fd;                                             // see Socket
  std::function<bool(Exchange&, ExchangeStream&)> answer;  // false: the connection is of no more use
};

/// An answer that no endpoint makes: a refusal, or what a browser is told before it asks.
struct DirectAnswer {
  api::Reply reply;
  HeaderFields fields = {};  // further header fields
};

/// One client's connection: reads its requests, refuses the bad ones, has the others answered, and logs each.
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
  std::optional<Refusal> read_head(Exchange& exchange);
  std::optional<DirectAnswer> answer_to_head(const Exchange& exchange) const;
  std::optional<Refusal> read_content(Exchange& exchange);
  std::uint64_t write(Exchange& exchange, const DirectAnswer& answer);
  void drop_body(Exchange& exchange);
  void log(const Exchange& exchange, std::uint64_t bytes_out) const;

  ConnectionContext context_;
  Socket socket_;
  const std::string peer_;
  std::string input_;  // read and not used yet
  bool open_ = true;
  bool unread_ = false;  // the client may still be sending
};

}  // namespace fleetplan::server
