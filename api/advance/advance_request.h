#pragma once

// The request of POST /v1/advance and its answer, the request of a later moment.

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

/// What the answer repeats of the goals of a robot, and of those that replace them.
struct RepeatedGoals {
  std::vector<GoalTexts> texts;            // see ParsedGoals
  std::vector<GoalTexts> others;           // of those that replace them
  std::vector<core::OpenGoal> open;        // as its plan has settled them
  std::vector<core::OpenGoal> other_open;  // of those that replace them
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

/// What the next request is judged by, as long as the request and `work` are there. Its map is taken if it is
/// needed. `maps`: those of earlier requests; may be null.
core::Judgement judgement_of(AdvanceRequest& request, core::MapCache* maps, core::Work& work);

/// Returns the request of the moment: that of the body with the starts, goals, committed and previous actions
/// of these robots, what is left of its obstacles, and the options that it needs where they are; everything
/// else is copied. Then `progress`, and `unavoidable` with `unavoidable_total` if robots overlap or cannot
/// stop in time. The text ends anywhere once the work is met.
std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           const core::Circumstances& circumstances, core::Work& work);

}  // namespace fleetplan::api
