#pragma once

// The requests about the execution of plans, POST /v1/simulate, POST /v1/margins and POST /v1/retime, and
// their answers. Each has its own source file.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/parse_request.h"
#include "api/request/shared_members.h"
#include "core/execution/dependencies.h"
#include "core/execution/retime.h"
#include "core/execution/simulation/simulation.h"
#include "core/map/occupancy_grid.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/plan/margins.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The most runs of one study.
inline constexpr std::size_t kMaxRuns = 100'000;

/// How plans are executed and disturbed.
struct RequestedExecution {
  core::ExecutionPolicy policy = core::ExecutionPolicy::open_loop;
  double max_delay = 0.0;  // seconds, for clock_stop
  core::Disturbance disturbance;
};

/// Reads `policy`, `max_delay` and `disturbance` of a body.
RequestedExecution parse_execution(const JsonReader& root, std::vector<std::string>& warnings);

/// The word for a policy in requests.
std::string_view name_of(core::ExecutionPolicy policy);

/// A readable body of POST /v1/simulate. The actions of every plan are contiguous from the start of its robot
/// on; whether plans collide is not judged. A robot without a plan has its committed actions as its plan.
struct SimulateRequest {
  core::OccupancyGrid grid;
  WorldFrame frame;
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<double> body_radii;  // metres, by robot
  core::ExecutionPolicy policy = core::ExecutionPolicy::open_loop;
  double max_delay = 0.0;                           // seconds, for clock_stop
  double wait_before_move = 0.0;                    // seconds, see PlanOptions
  std::vector<core::Dependency> dependencies = {};  // by robot
  core::SimulationSettings settings = {};
  std::optional<std::size_t> trace = {};  // the run that is returned
  std::chrono::nanoseconds budget{};
  std::vector<std::string> warnings = {};
};

/// Reads a body of POST /v1/simulate. Ends with `parse_unfinished` or `draining` when `work` is met.
Result<SimulateRequest, RequestError> parse_simulate_request(std::string_view body, const Limits& limits,
                                                             core::Work& work);

/// Returns the `trace` of the answer; none if `stop` is met first.
std::optional<std::string> write_trace(const core::SimulationTrace& trace, const SimulateRequest& request,
                                       const core::StopCondition& stop);

/// Returns the answer of POST /v1/simulate. `trace`: its text, if there is one.
std::string write_simulation(const core::SimulationReport& report, const SimulateRequest& request,
                             const std::optional<std::string>& trace, const std::string& request_id);

/// A valid body of POST /v1/margins.
struct MarginsRequest {
  PlanRequest plan;  // its problem and its open goals are in the task
  core::MarginTask task;
  std::vector<std::string> warnings;
};

/// Reads a body of POST /v1/margins; ends with `parse_unfinished` or `draining` when `work` is met. `maps`,
/// which may be null, has those of earlier requests.
Result<MarginsRequest, RequestError> parse_margins_request(std::string_view body, const Limits& limits,
                                                           core::Work& work, core::MapCache* maps);

/// Returns the answer of POST /v1/margins. `plan`: the text of the best plan's answer, if there is one.
std::string write_margins(const core::FoundMargins& found, const MarginsRequest& request,
                          const std::optional<std::string>& plan, const std::string& request_id);

/// A readable body of POST /v1/retime, in the client's world.
struct RetimeRequest {
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<core::Dependency> dependencies;
  std::vector<core::ObservedState> states;  // at most one for each robot
  core::RetimeRules rules;
};

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<RetimeRequest> parse_retime_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work);

/// Returns the answer of POST /v1/retime. `retimed` is by robot. Returns none if `work` is met.
std::optional<std::string> write_retimed(const RetimeRequest& request,
                                         const std::vector<core::RetimedRobot>& retimed, core::Work& work);

}  // namespace fleetplan::api
