#pragma once

#include <chrono>
#include <stop_token>
#include <string>

#include "api/limits.h"
#include "api/plan_events.h"
#include "core/parallel/executor.h"

namespace fleetplan::api {

/// What an endpoint knows of its request beside the body.
struct RequestContext {
  using Clock = std::chrono::steady_clock;

  std::string request_id;
  Clock::time_point received_at = Clock::now();  // last byte of the body in
  Clock::time_point started_at = Clock::now();   // taken from the queue
  std::stop_token stop;                          // the client is gone or the server drains
  Limits limits;
  core::Executor* executor = nullptr;  // of more threads than the caller's, if there are any
  PlanEvents* events = nullptr;        // who wants to hear how a plan gets on, if anybody
};

}  // namespace fleetplan::api
