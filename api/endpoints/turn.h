#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/response/reply.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// What a request needs of the server, known once it is parsed.
struct TurnNeed {
  enum class Kind { plan, check, simulation, conversion };

  Kind kind = Kind::plan;
  core::StopCondition stop;  // of the computation
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

  /// Asks for the turn, once, when the request is known to be valid. False when the server is too busy for
  /// it; returns at once.
  virtual bool request(const TurnNeed& need) = 0;

  /// Waits for the turn that was granted. False when the need's `stop` was met before, or when so little of
  /// the time is left that the server gives up.
  virtual bool await() = 0;

  /// To be called now and then by what takes long once it has its turn: others may get it meanwhile, and this
  /// waits for the next. False when the need's `stop` was met before.
  virtual bool let_others() = 0;
};

/// Asks for the turn of a request that has been read, and waits for it. True at once without a Turn.
bool take_turn(Turn* turn, const TurnNeed& need, core::Work& work);

/// TurnNeed::work of plans that are checked or executed.
double work_of(std::size_t robots, const std::vector<core::RobotPlan>& plans);

/// The answer to a request that gets no turn.
Reply too_busy(const std::string& request_id);

}  // namespace fleetplan::api
