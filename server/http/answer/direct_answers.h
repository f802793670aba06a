#pragma once

// Answers that cpp-httplib does not write: answers to requests without a handler, and streams of events.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "api/endpoints/request_context.h"
#include "api/json/errors.h"
#include "api/response/reply.h"
#include "server/http/exchange.h"

namespace fleetplan::server {

/// An answer without a handler: a refusal, or the reply to a browser's preflight.
struct DirectAnswer {
  api::Reply reply;
  HeaderFields fields = {};  // header fields of this answer only
};

/// Returns a problem in answer to the exchange.
DirectAnswer refusal(const Exchange& exchange, api::ErrorCode code, const std::string& detail,
                     HeaderFields fields = {});

/// Returns the common header fields of all answers.
HeaderFields common_fields(const Exchange& exchange);

/// Returns a head, with the empty line that ends it. `further` header fields follow the common fields of
/// every answer.
std::string answer_head(const Exchange& exchange, int status, const HeaderFields& further);

/// Returns the whole answer as it is sent.
std::string answer_text(const Exchange& exchange, const DirectAnswer& answer);

/// The answer to an exchange as a stream of events (WHATWG HTML, server-sent events), each with one line of
/// data. It bypasses cpp-httplib, which would have to know from the start that the answer is a stream.
///
/// After begin(), its own thread writes. The planner only stores the latest state, so a slow client does not
/// delay it. A slow client skips outdated states. A client that is too slow, see WritePatience, loses its
/// connection.
class EventStream final : public api::PlanEvents {
 public:
  /// The time between two progress events, whatever the planner does.
  static constexpr std::chrono::milliseconds kPeriod{150};

  /// The exchange and `last` must outlive this object. `last` is the name of the event that ends the stream
  /// with the answer.
  explicit EventStream(Exchange& exchange, const char* last = "plan");
  ~EventStream() override;

  void begin(const api::PlanProgress& progress) override;
  void progress(const api::PlanProgress& progress) override;
  void incumbent(std::string answer) override;

  /// Whether anything has been written.
  bool begun() const { return begun_; }

  /// Writes the last event of a stream that has begun: the answer, or a problem. Data that the client does
  /// not accept at once goes to Exchange::unsent. If the client is gone, the connection is closed.
  void end(const api::Reply& reply);

 private:
  void write_events();
  void write_rest();
  void stop_writing();
  std::string head() const;
  std::string event(std::string_view name, std::string_view data) const;
  void send(std::string_view text);

  Exchange& exchange_;
  const bool chunked_;
  const std::string_view last_;
  bool begun_ = false;
  std::thread writer_;
  // The members below belong to the thread that writes.
  bool failed_ = false;     // the client accepts no more
  std::uint64_t sent_ = 0;  // bytes sent and bytes still to be sent
  std::optional<WritePatience> patience_;
  Exchange::Clock::time_point deadline_;  // the client has to accept more until then
  std::mutex mutex_;                      // guards all below
  std::condition_variable changed_;
  api::PlanProgress progress_;
  std::optional<std::string> incumbent_;  // not written yet
  bool ending_ = false;
};

}  // namespace fleetplan::server
