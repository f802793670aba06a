#pragma once

// What an endpoint gets of its request beside the body.

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "api/endpoints/plan_events.h"
#include "api/request/limits.h"
#include "api/response/reply.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// What a request needs of the server, known once it is parsed.
struct TurnNeed {
  enum class Kind { plan, check, simulation, conversion, travel };

  Kind kind = Kind::plan;
  core::StopCondition stop;  // ends the computation
  core::StopCondition::Clock::time_point answer_by = core::StopCondition::Clock::time_point::max();
  double work = 1.0;      // proportional to the expected time, for the kind
  bool is_short = false;  // takes milliseconds at most, as far as can be told
};

/// A request's turn to compute, among the requests of others.
class Turn {
 public:
  Turn() = default;
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  virtual ~Turn() = default;

  /// Asks for the turn, once, when the request is known to be valid. Returns at once; false when the server
  /// is too busy for it.
  virtual bool request(const TurnNeed& need) = 0;

  /// Waits for the turn that was granted. Returns false when the need's `stop` was met before, or when so
  /// little of the time is left that the server gives up.
  virtual bool await() = 0;

  /// Lets others have the turn meanwhile, and waits for the next one. To be called now and then by what takes
  /// long once it has its turn. Returns false when the need's `stop` was met before.
  virtual bool let_others() = 0;
};

/// Gets the plan of an answer, which has passed the check, before the answer is written.
using AnsweredPlan = std::function<void(const core::Problem&, const core::Plan&)>;

/// The context of a request: its limits, and who takes part in its work.
struct RequestContext {
  using Clock = std::chrono::steady_clock;

  std::string request_id;
  Clock::time_point received_at = Clock::now();  // last byte of the body in
  std::stop_token stop;                          // requested when the client is gone or the server drains
  Limits limits;
  core::Executor* executor = nullptr;  // runs further threads; null: the caller's alone
  PlanEvents* events = nullptr;        // receives the progress of a plan; may be null
  AnsweredPlan answered;               // gets the plan that is returned; may be empty
  Turn* turn = nullptr;                // turn to compute; null: it may compute at once
  core::MapCache* maps = nullptr;      // the maps of earlier requests; null: none
  core::Work::CpuClock cpu_clock = core::thread_cpu_time;
};

}  // namespace fleetplan::api
