#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/response/plan_outcome.h"
#include "server/http/guard/body_memory.h"
#include "server/http/guard/request_head.h"
#include "server/http/guard/socket.h"
#include "server/http/route_table.h"

namespace fleetplan::server {

/// One request and its answer, on the connection's thread.
struct Exchange {
  using Clock = std::chrono::steady_clock;

  Socket* socket = nullptr;
  Clock::time_point begun_at;     // first byte in
  Clock::time_point received_at;  // last byte of the body in
  std::string request_id;
  std::string trace_id;  // of the client's trace; empty: it has none
  RequestHead head;
  const Route* route = nullptr;                            // none: the path is unknown
  std::string parameter = {};                              // see RouteTable::Match
  std::optional<BodyMemory::Share> memory = std::nullopt;  // for the body
  std::string body;                                        // as sent, perhaps gzip-coded

  HeaderFields fields;  // of the answer, besides those that every answer has
  int status = 0;
  int retry_after_s = 1;   // of a 503; by default soon, as another replica may be ready
  bool close = false;      // the connection ends with this answer
  bool abandoned = false;  // the client left before the answer
  std::optional<std::uint64_t> streamed = std::nullopt;  // bytes of an answer that went out as an EventStream
  std::optional<double> queue_ms = std::nullopt;
  std::string_view problem;  // see api::Reply
  std::optional<api::PlanOutcome> outcome = std::nullopt;
};

/// How an answer was sent.
struct Sent {
  std::uint64_t bytes = 0;
  bool usable = true;  // the connection can serve another request
};

}  // namespace fleetplan::server
