#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/response/plan_outcome.h"
#include "server/http/body_memory.h"
#include "server/http/header_fields.h"
#include "server/http/request_head.h"
#include "server/http/socket.h"
#include "server/routes.h"

namespace fleetplan::server {

/// One request and its answer, on the connection's thread.
struct Exchange {
  using Clock = std::chrono::steady_clock;

  Socket* socket = nullptr;
  Clock::time_point begun_at;     // first byte in
  Clock::time_point received_at;  // last byte of the body in
  std::string request_id;
  RequestHead head;
  Route route;
  std::optional<BodyMemory::Share> memory = std::nullopt;  // for the body
  std::string body;                                        // as sent, perhaps gzip-coded

  HeaderFields fields;  // of the answer, by what the request's head says
  int status = 0;
  int retry_after_s = 1;   // what a 503 tells; by default another service may have taken this one's place
  bool close = false;      // the connection ends with this answer
  bool abandoned = false;  // the client left: nobody reads an answer
  std::optional<std::uint64_t> streamed = std::nullopt;  // bytes of an answer that went out as an EventStream
  std::optional<double> queue_ms = std::nullopt;
  std::string_view problem;  // see api::Reply
  std::optional<api::PlanOutcome> outcome = std::nullopt;
};

}  // namespace fleetplan::server
