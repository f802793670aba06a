#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/response/reply.h"
#include "server/http/answer/unsent_answers.h"
#include "server/http/request/body_reader.h"
#include "server/http/request/request_head.h"
#include "server/http/route_table.h"
#include "server/http/socket.h"

namespace fleetplan::server {

/// One request and its answer.
struct Exchange {
  using Clock = std::chrono::steady_clock;

  Socket* socket = nullptr;
  std::optional<UnsentAnswers::Answer> unsent = std::nullopt;  // what the client has not accepted yet
  Clock::time_point begun_at;                                  // first byte in
  Clock::time_point received_at;                               // last byte of the body in
  std::string request_id;
  std::string trace_id;  // the client's trace; empty: it has none
  RequestHead head;
  const Route* route = nullptr;                            // none: the path is unknown
  std::string parameter = {};                              // see RouteTable::Match
  std::optional<BodyMemory::Share> memory = std::nullopt;  // memory for the body
  std::string body;                                        // as sent, until its job decodes it
  std::uint64_t bytes_in = 0;                              // bytes of the body as sent

  HeaderFields fields;  // header fields of the answer, in addition to the common fields of every answer
  int status = 0;
  int retry_after_s = 1;   // seconds, for a 503; by default soon, as another replica may be ready
  bool close = false;      // the connection ends with this answer
  bool abandoned = false;  // the client left before the answer
  std::optional<std::uint64_t> streamed = std::nullopt;  // bytes of an answer that went out as an EventStream
  std::optional<double> queue_ms = std::nullopt;         // milliseconds until its turn came, or without one
  bool had_turn = false;                                 // it has had a turn to compute
  std::optional<double> late_s = std::nullopt;  // from the end of the budget to the answer; negative: before
  std::string_view problem;                     // see api::Reply
  std::optional<api::PlanOutcome> outcome = std::nullopt;

  /// Gives the body and its memory back, once it has been used, because a client may read its answer slowly.
  void release_body() {
    body = std::string();
    memory.reset();
  }

  /// Sends what the client accepts at once, and adds the rest to `unsent`. Returns false if the client is
  /// gone.
  bool send(std::string_view data) { return unsent->send(data); }
};

/// How an answer was sent.
struct Sent {
  std::uint64_t bytes = 0;
  bool usable = true;  // the connection can serve another request
};

}  // namespace fleetplan::server
