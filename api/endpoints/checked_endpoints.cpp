#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/json/error.h"
#include "api/json/faults.h"
#include "api/json/json_writer.h"
#include "api/response/write_report.h"
#include "api/response/write_response.h"

namespace fleetplan::api {

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  return check_plans(
      body, context,
      [](const ValidateRequest& request, const core::VerifyReport& report,
         const core::StopCondition&) -> Reply {
        return {200, kJson, write_report(report, request.robots, request.obstacles, request.zones)};
      });
}

namespace {

/// Returns a JSON Pointer to the action of a robot at time `t`, to its plan if there is none, or to the robot
/// if it has no plan.
std::string pointer_to(std::size_t robot, double t, const std::vector<core::RobotPlan>& plans) {
  const auto plan = std::find_if(plans.begin(), plans.end(),
                                 [robot](const core::RobotPlan& one) { return one.robot == robot; });
  if (plan == plans.end()) return "/robots/" + std::to_string(robot);
  std::string pointer = "/plans/" + std::to_string(plan - plans.begin());
  const auto action = std::find_if(plan->actions.begin(), plan->actions.end(), [t](const core::Action& one) {
    return one.t_start <= t && t <= one.t_end;
  });
  if (action == plan->actions.end()) return pointer;
  return pointer + "/actions/" + std::to_string(action - plan->actions.begin());
}

/// Returns the 422 for plans that the check rejects, with its violations as faults.
RequestError invalid_plans(const ValidateRequest& request, const core::VerifyReport& report) {
  RequestError error;
  error.detail = "The plans are not valid, so there are no dependencies; see errors and /v1/validate.";
  error.faults_total = report.violation_count;
  // Bounded: at most FaultList::kMostListed.
  for (const core::Violation& violation : report.violations) {
    if (error.faults.size() == FaultList::kMostListed) break;
    std::string names;
    for (const std::size_t robot : violation.robots) {
      names += (names.empty() ? "" : ", ") + request.robots[robot].id;
    }
    error.faults.push_back({pointer_to(violation.robots.back(), violation.t, request.plans),
                            fault::kInvalidPlan, names + ": " + violation.detail + "."});
  }
  return error;
}

std::string write(const PlanDependencies& dependencies, const std::vector<core::Robot>& robots) {
  JsonWriter json;
  json.begin_object();
  write_dependencies(json, dependencies.made ? &*dependencies.made : nullptr, robots);
  json.key("warnings").begin_array();
  for (const std::string& warning : dependencies.warnings) json.value(std::string_view(warning));
  json.end_array().end_object();
  return json.take();
}

}  // namespace

Reply dependencies_endpoint(std::string_view body, const RequestContext& context) {
  return check_plans(body, context,
                     [&](const ValidateRequest& request, const core::VerifyReport& report,
                         const core::StopCondition& stop) -> Reply {
                       if (!report.valid()) {
                         return problem_reply(invalid_plans(request, report), context.request_id);
                       }
                       const double tolerance = request.rules.tolerances.front().metres;
                       const auto made =
                           plan_dependencies(request.robots, request.plans, request.dependencies, tolerance,
                                             !request.obstacles.empty(), stop);
                       return {200, kJson, write(made, request.robots)};
                     });
}

}  // namespace fleetplan::api
