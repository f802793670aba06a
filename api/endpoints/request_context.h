#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>

#include "api/endpoints/plan_events.h"
#include "api/endpoints/turn.h"
#include "api/request/limits.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/executor.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// Gets the plan of an answer, which has passed the check, before the answer is written.
using AnsweredPlan = std::function<void(const core::Problem&, const core::Plan&)>;

/// What an endpoint gets of its request beside the body.
struct RequestContext {
  using Clock = std::chrono::steady_clock;

  std::string request_id;
  Clock::time_point received_at = Clock::now();  // last byte of the body in
  std::stop_token stop;                          // the client is gone or the server drains
  Limits limits;
  core::Executor* executor = nullptr;  // of further threads; null: the caller's alone
  PlanEvents* events = nullptr;        // receives the progress of a plan; may be null
  AnsweredPlan answered;               // gets the plan that is returned; may be empty
  Turn* turn = nullptr;                // to compute; null: at once
  core::MapCache* maps = nullptr;      // that earlier requests had; null: none
  core::Work::CpuClock cpu_clock = core::Work::thread_cpu_time;
};

}  // namespace fleetplan::api
