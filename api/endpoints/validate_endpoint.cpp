#include "api/endpoints/validate_endpoint.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/json/text.h"
#include "api/request/parse_fleet.h"
#include "api/request/parse_plans.h"
#include "api/response/error.h"
#include "api/response/write_report.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

// The members of a request to validate, then those that an answer of /v1/plan adds and nobody reads here.
constexpr std::array<std::string_view, 18> kMembers{
    "map",      "robot_defaults", "robots",        "options",  "plans",      "tolerance",
    "status",   "request_id",     "unplanned",     "flowtime", "makespan",   "lower_bound",
    "verified", "min_clearance",  "deterministic", "search",   "timings_ms", "warnings"};

constexpr double kDefaultTolerance = 1e-6;  // metres, seconds, radians; kind to rounded decimals
constexpr Range kTolerance{0.0, kLargest, "(metres, seconds and radians)"};

/// A readable body of POST /v1/validate.
struct ValidateRequest {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  double tolerance = kDefaultTolerance;
  std::chrono::nanoseconds budget{};  // for the check itself
};

/// The default budget even where the options, which may be those of the plan's request, want less.
std::chrono::nanoseconds check_budget(ReadOptions& options, const Limits& limits) {
  const auto least = static_cast<double>(limits.default_budget_ms);
  if (options.budget_ms) options.budget_ms = std::max(*options.budget_ms, least);
  return effective_budget(options, limits);
}

std::variant<ValidateRequest, RequestError> parse_validate_request(std::string_view body,
                                                                   const Limits& limits) {
  auto read = read_json(body, limits.max_depth);
  if (const auto* error = std::get_if<JsonError>(&read)) return refusal(*error);
  JsonDocument document = std::get<JsonDocument>(std::move(read));
  FaultList& faults = document.faults;

  const JsonPath path;
  const ObjectReader root(document.root, path, kMembers, faults);
  Fleet fleet = parse_fleet(root, limits, faults);
  const double tolerance = root.number_or("tolerance", kTolerance, kDefaultTolerance);
  std::vector<core::RobotPlan> plans;
  if (const JsonValue* member = root.require("plans")) {
    const JsonPath plans_path = root.path("plans");
    const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
    plans = parse_plans(*member, plans_path, fleet.robots, frame, faults);
  }
  if (!faults.empty()) return refusal(faults);
  std::vector<core::Robot> robots;
  robots.reserve(fleet.robots.size());
  for (ReadRobot& robot : fleet.robots) robots.push_back(std::move(robot.robot));
  return ValidateRequest{std::move(fleet.map->grid), std::move(robots), std::move(plans), tolerance,
                         check_budget(fleet.options, limits)};
}

Reply unfinished(const ValidateRequest& request, const core::StopCondition& stop,
                 const std::string& request_id) {
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, "The service is shutting down.", request_id);
  }
  const auto ms = std::chrono::duration<double, std::milli>(request.budget).count();
  return problem_reply(
      ErrorCode::check_unfinished,
      "The plans could not be checked within " + number_text(ms) +
          " ms: give options.time_budget_ms more, as far as /v1/limits allows, or send fewer "
          "robots or a part of the time.",
      request_id);
}

}  // namespace

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  auto parsed = parse_validate_request(body, context.limits);
  if (const auto* error = std::get_if<RequestError>(&parsed)) {
    return problem_reply(error->code, error->detail, context.request_id, error->faults);
  }
  const auto& request = std::get<ValidateRequest>(parsed);
  using Clock = core::StopCondition::Clock;
  if (context.await_turn) context.await_turn(core::StopCondition(Clock::time_point::max(), context.stop));
  const core::StopCondition stop(Clock::now() + request.budget, context.stop);
  const auto report = core::verify(request.grid, request.robots, request.plans, request.tolerance, stop);
  if (!report) return unfinished(request, stop, context.request_id);
  return {200, kJson, write_report(*report, request.robots)};
}

}  // namespace fleetplan::api
