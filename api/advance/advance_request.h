#pragma once

// The request of POST /v1/advance and its answer, which is the request of a later moment.

#include <string>
#include <vector>

#include "api/advance/advance.h"
#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"

namespace fleetplan::api {

struct Circumstances;

/// A readable body of POST /v1/advance, in the client's world.
struct AdvanceRequest {
  Fleet fleet;  // of its request, in the map frame
  Moment moment;
  std::vector<core::Robot> robots;
  std::vector<Execution> executions;  // by robot
  /// By robot: what is repeated of its goals, or of those that replace them, see ParsedGoals.
  std::vector<std::vector<GoalTexts>> goal_texts;
  std::vector<std::vector<core::OpenGoal>> open;  // by robot, as its plan has settled them
  /// By robot: it may come back to any pose of its last goal, if that is open.
  std::vector<bool> returns;
  std::vector<core::MovingObstacle> obstacles;
  JsonReader request;  // the member of the body
};

/// Reads the root of the document. Nothing if it has faults, or if its stop is met.
std::optional<AdvanceRequest> parse_advance_request(const JsonReader& root, const Limits& limits,
                                                    core::Work& stop);

/// The request of the moment: that of the body with the starts, goals, committed and previous actions of
/// these robots, what is left of its obstacles, and the options that it needs where they are; everything else
/// is copied. Then `progress`, and `unavoidable` if robots overlap or cannot stop in time. The text ends
/// anywhere once the work is met.
std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           const Circumstances& circumstances, core::Work& work);

}  // namespace fleetplan::api
