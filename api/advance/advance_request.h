#pragma once

// The request of POST /v1/advance and its answer, which is the request of a later moment.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "core/advance/advance.h"
#include "core/map/static_map.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// What the answer repeats of the goals of a robot, and of the goals that replace them.
struct RepeatedGoals {
  std::vector<GoalTexts> texts;            // see ParsedGoals
  std::vector<GoalTexts> others;           // texts of the goals that replace them
  std::vector<core::OpenGoal> open;        // as its plan has settled them
  std::vector<core::OpenGoal> other_open;  // open goals among the goals that replace them
  bool returns = false;                    // it may come back to any pose of its last goal, if that is open
};

/// A readable body of POST /v1/advance, in the frame of its map.
struct AdvanceRequest {
  std::unique_ptr<GivenPositions> given;  // so that the answer repeats positions to the last digit
  Fleet fleet;                            // of its request
  core::FleetInMotion now;
  std::vector<RepeatedGoals> repeated;  // by robot
  JsonReader request;                   // the member of the body
};

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<AdvanceRequest> parse_advance_request(const JsonReader& root, const Limits& limits,
                                                    core::Work& work);

/// Returns the facts by which the next request is judged. The request and `work` must outlive them. The map
/// is only fetched if it is needed. `maps`: the maps of earlier requests; may be null.
core::Judgement judgement_of(AdvanceRequest& request, core::MapCache* maps, core::Work& work);

/// Returns the request of the moment. It takes these from its arguments:
///
/// - the starts, goals, committed and previous actions of the robots,
/// - what is left of the obstacles,
/// - and the options that the positions of the robots require.
///
/// Everything else is copied from the body. Then `progress` follows, and, if robots overlap or cannot stop in
/// time, `unavoidable` with `unavoidable_total`. If the work is met, the text is incomplete.
std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           const core::Circumstances& circumstances, core::Work& work);

}  // namespace fleetplan::api
