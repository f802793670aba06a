#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "api/request/fleet/parse_plans.h"
#include "api/request/parse_body.h"
#include "api/request/parse_request.h"
#include "api/request/ranges.h"
#include "core/verify/check_rules.h"

namespace fleetplan::api {

namespace {

// The members of a request to validate, then those that answers of /v1/plan, /v1/advance and /v1/assign add,
// which are ignored.
constexpr std::array<std::string_view, 30> kValidateRequestMembers{
    "map",          "robot_defaults",  "robots",      "obstacles",       "unavoidable",   "options",
    "plans",        "tolerance",       "status",      "request_id",      "unplanned",     "flowtime",
    "makespan",     "objective_value", "lower_bound", "verified",        "min_clearance", "deterministic",
    "search",       "timings_ms",      "warnings",    "lattice_spacing", "metadata",      "zones",
    "dependencies", "tight",           "estimated",   "progress",        "assigned",      "unassigned"};

constexpr double kDefaultTolerance = core::kMostTolerance;  // metres, seconds, radians
constexpr double kLargestTolerance = 1e9;
constexpr Range kTolerance{0.0, kLargestTolerance, "(metres, seconds and radians)"};

/// Returns the budget of a check: at least the default one, as the options may be those of the plan's
/// request, which allowed less.
std::chrono::nanoseconds check_budget(ParsedOptions options, const Limits& limits) {
  const auto least = static_cast<double>(limits.default_budget_ms);
  if (options.budget_ms) options.budget_ms = std::max(*options.budget_ms, least);
  return effective_budget(options, limits);
}

/// Returns the rules of a check. Inflation and added waits are left out, as they are the planner's business:
/// plans are checked with bare radii.
core::CheckRules rules_of(const core::PlanOptions& options,
                          std::vector<core::UnavoidableCollision> collisions) {
  core::CheckRules rules;
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.horizon = options.horizon;
  rules.exempt = std::move(collisions);
  return rules;
}

}  // namespace

Result<ValidateRequest, RequestError> parse_validate_request(std::string_view body, const Limits& limits,
                                                             core::Work& stop) {
  const auto parse = [&](const JsonReader& root, core::Work& reading) -> std::optional<ValidateRequest> {
    Fleet fleet = parse_fleet(root, limits, [&](const ParsedOptions& options) {
      reading.set_budget(check_budget(options, limits));
    });
    const double tolerance = root.find("tolerance").number(kTolerance).value_or(kDefaultTolerance);
    const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame{};
    auto plans = parse_plans(root.require("plans"), fleet.robots, frame);
    auto collisions = parse_unavoidable(root.find("unavoidable"), fleet);
    if (!fleet.map || reading.met()) return std::nullopt;
    RequestedDependencies dependencies = requested_dependencies(fleet);
    std::vector<core::Robot> robots;
    robots.reserve(fleet.robots.size());
    for (ParsedRobot& robot : fleet.robots) robots.push_back(std::move(robot.robot));
    if (fleet.options.invalid_robots == InvalidRobots::report) {
      mark_invalid_robots(root.find("unplanned"), robots);
    }
    core::CheckRules rules = rules_of(fleet.options.plan, std::move(collisions));
    rules.tolerances.assign(robots.size(), core::Tolerance::of_all(tolerance));
    return ValidateRequest{.grid = std::move(fleet.map->grid),
                           .robots = std::move(robots),
                           .obstacles = std::move(fleet.obstacles),
                           .zones = std::move(fleet.zones),
                           .plans = std::move(plans),
                           .dependencies = std::move(dependencies),
                           .rules = std::move(rules),
                           .budget = check_budget(fleet.options, limits)};
  };
  return parse_body<ValidateRequest>(body, limits, stop, kValidateRequestMembers, parse);
}

}  // namespace fleetplan::api
