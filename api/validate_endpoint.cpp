#include "api/validate_endpoint.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/error.h"
#include "api/parse_fleet.h"
#include "api/parse_plans.h"
#include "api/write_report.h"
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
};

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
  return ValidateRequest{std::move(fleet.map->grid), std::move(robots), std::move(plans), tolerance};
}

}  // namespace

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  auto parsed = parse_validate_request(body, context.limits);
  if (const auto* error = std::get_if<RequestError>(&parsed)) {
    return problem_reply(error->code, error->detail, context.request_id, error->faults);
  }
  const auto& request = std::get<ValidateRequest>(parsed);
  const core::StopCondition stop(core::StopCondition::Clock::time_point::max(), context.stop);
  if (context.await_turn) context.await_turn(stop);
  if (stop.met()) {
    return problem_reply(ErrorCode::draining, "The service is shutting down.", context.request_id);
  }
  const auto report = core::verify(request.grid, request.robots, request.plans, request.tolerance);
  return {200, kJson, write_report(report, request.robots)};
}

}  // namespace fleetplan::api
