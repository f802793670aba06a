#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "api/response/reply.h"

namespace spdlog {
class logger;
}

namespace fleetplan::server {

/// A queue of lines on their way to a descriptor. A separate thread writes them, so that a reader who does
/// not read delays nobody. Lines beyond `max_bytes` are dropped and counted. Thread-safe.
class LogQueue {
 public:
  LogQueue(int fd, std::size_t max_bytes);

  /// Flushes the lines. If the reader does not read, the thread stays behind and waits for it.
  ~LogQueue();
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  /// Takes a line with its end, or drops it. Never waits for the reader.
  void push(std::string line);

  /// Waits until all lines have been written, but no longer than `patience`.
  void flush(std::chrono::milliseconds patience = std::chrono::milliseconds(1000)) const;

  /// The number of lines that were not written, because the queue was full or the descriptor did not take
  /// them.
  std::uint64_t dropped() const;

 private:
  struct State;

  std::shared_ptr<State> state_;  // shared with the thread, which may outlive this
};

/// One line of the log for each request.
struct RequestRecord {
  std::string id;
  std::string trace_id;  // the client's trace; empty: none
  std::string method;
  std::string path;                               // without query, as sent
  int status = 0;                                 // 499: the client left before the answer
  std::uint64_t bytes_in = 0;                     // bytes of the body, as sent
  std::uint64_t bytes_out = 0;                    // bytes of the whole answer
  double ms = 0.0;                                // first byte of the request to last byte of the answer
  std::optional<double> queue_ms = std::nullopt;  // milliseconds in the queue, for planning jobs
  std::string_view problem;                       // the error's code; empty: none
  std::optional<api::PlanOutcome> outcome = std::nullopt;
  std::string peer;       // address and port of the client, or of the proxy before it
  std::string forwarded;  // the clients that proxies name, as sent; empty: none
  bool admin = false;     // the request came to the admin port
};

/// Writes JSON lines to stderr, or to another descriptor. A reader that does not read delays nothing, see
/// LogQueue. Thread-safe.
class RequestLog {
 public:
  /// `level`: trace, debug, info, warn, error, critical or off.
  explicit RequestLog(const std::string& level, int fd = 2);

  /// Logs a request. The level is info, but error for a status of 500 and more except 503, and debug for
  /// answers of the admin port.
  void request(const RequestRecord& record) const;

  using Value = std::variant<std::int64_t, std::string>;
  using Members = std::initializer_list<std::pair<std::string_view, Value>>;

  /// Logs an event of the process, at level info; `members` follow the message.
  void info(std::string_view message, Members members = {}) const;

  /// Logs something that an operator should look at, at level warn.
  void warn(std::string_view message, Members members = {}) const;

  /// Logs a bug, at level error.
  void error(std::string_view message, std::string_view request_id = {}) const;

  /// Waits until all lines have been written, but no longer than a second.
  void flush() const { queue_->flush(); }

  /// The number of lines that were dropped because the reader did not read.
  std::uint64_t dropped() const { return queue_->dropped(); }

 private:
  std::shared_ptr<LogQueue> queue_;
  std::shared_ptr<spdlog::logger> logger_;
};

/// Returns the 500 that answers an exception, which means a bug. The exception's text goes only to the log.
api::Reply internal_error(const RequestLog& log, const std::string& request_id,
                          const std::exception_ptr& failure);

}  // namespace fleetplan::server
