#pragma once

// The answer with a plan, its parts that other answers also have, and the report of a check.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "api/json/json_writer.h"
#include "api/request/shared_members.h"
#include "core/execution/dependencies.h"
#include "core/execution/wait_reasons.h"
#include "core/fleet/enclosure.h"
#include "core/geometry/position.h"
#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/plan/part_timer.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// When the stages of a request ended.
struct StageTimes {
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  Time received;  // last byte of the body in
  Time parsed = {};
  Time started = {};  // the request has got its turn
  Time planned = {};
  Time verified = {};
  core::PartTimer parts{Time()};  // of the time from started to planned
};

/// A plan that has passed the check, and the other contents of an answer.
struct VerifiedPlan {
  const core::Plan& plan;
  const core::VerifyReport& report;
  const core::Problem& problem;
  const std::vector<ReceivedRobot>& received;  // by robot
  const core::Position& origin;                // origin of the map in the world
  const std::vector<std::string>& warnings;
  const std::string& metadata;           // metadata of the request, as JSON; empty: none
  std::vector<double> lattice_spacings;  // by robot, metres; empty: neither asked for nor chosen
  /// The dependencies of the answer. Null if they were not asked for; none if they were not made in time.
  const std::optional<core::Dependencies>* dependencies = nullptr;
  /// By robot: whom it waits for; null if the dependencies are not known.
  const std::vector<std::vector<core::WaitReason>>* wait_reasons = nullptr;
  std::optional<double> objective_value = {};  // none: it is the flowtime or the makespan
  /// By robot of plan.unplanned: where its way is too narrow. May be empty.
  std::vector<std::optional<core::NarrowPlace>> narrow_places = {};
};

/// Returns the answer of POST /v1/plan. The timings are written last, so that they include the writing.
std::string write_response(const VerifiedPlan& verified, const std::string& request_id,
                           const StageTimes& stages);

/// Whom one robot waits for, and the robots that have the names.
struct NamedReasons {
  const std::vector<core::WaitReason>* list = nullptr;  // by ascending actions; null: not known
  const std::vector<core::Robot>* robots = nullptr;
};

/// Writes the member `actions` of a robot. Committed actions, and previous ones that the plan repeats, have
/// the numbers received; what follows begins with the position in which they end. `origin` is that of the map
/// in the world. `reasons`: the member `for` of waits, if
/// whom they are for is known.
/// Returns false, with a part of the text written, if `stop`, which may be null, is met first.
bool write_actions(JsonWriter& json, const std::vector<core::Action>& actions, const core::Robot& robot,
                   const ReceivedRobot& received, const core::Position& origin,
                   const core::StopCondition* stop = nullptr, const NamedReasons& reasons = {});

/// Writes the member `profile` of an action.
void write_profile(JsonWriter& json, const core::SpeedProfile& profile);

/// Writes the members `dependencies` and `tight`. Without dependencies (null), both are null.
void write_dependencies(JsonWriter& json, const core::Dependencies* dependencies,
                        const std::vector<core::Robot>& robots);

/// Returns the smallest clearance as answers report it, metres: contact, an overlap of at most
/// kContactTolerance, is 0.
std::optional<double> reported_clearance(const core::VerifyReport& report);

/// Returns the answer of POST /v1/validate. It contains at most the first twenty violations and the number of
/// all. If there are more, it has `"truncated": true`.
std::string write_report(const core::VerifyReport& report, const std::vector<core::Robot>& robots,
                         const std::vector<core::MovingObstacle>& obstacles,
                         const std::vector<core::Zone>& zones);

}  // namespace fleetplan::api
