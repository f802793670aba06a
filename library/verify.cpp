#include "core/verify/verify.h"

#include <fleetplan/verify.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/runtime/stop_condition.h"
#include "library/convert.h"
#include "library/make_problem.h"

namespace fleetplan {

namespace {

using Clock = core::StopCondition::Clock;

/// Returns the end of the time budget, which may be very long.
core::StopCondition end_of(const Rules& rules) {
  const auto now = Clock::now();
  const bool ends = rules.time_budget < Clock::time_point::max() - now;
  return core::StopCondition(ends ? now + rules.time_budget : Clock::time_point::max(), rules.stop);
}

std::vector<core::RobotPlan> core_plans(std::span<const RobotPlan> plans, const library::Frame& frame) {
  std::vector<core::RobotPlan> made;
  for (const RobotPlan& plan : plans) made.push_back(library::plan_of(plan, frame));
  return made;
}

}  // namespace

Verification verify(const Problem& problem, std::span<const RobotPlan> plans, const Rules& rules) {
  library::ReadFleet fleet = library::read_fleet(problem);
  if (!fleet.faults.empty()) throw InvalidProblem(std::move(fleet.faults));
  core::CheckRules core_rules;
  core_rules.tolerances.assign(problem.robots.size(), core::Tolerance::of_all(rules.tolerance));
  core_rules.inflation = rules.inflation;
  core_rules.interval_margin = rules.interval_margin;
  core_rules.wait_before_move = rules.wait_before_move;
  core_rules.start_overlap = rules.start_overlap;
  core_rules.horizon = rules.horizon;
  core_rules.exempt = library::unavoidable_of(rules.unavoidable);
  const core::OccupancyGrid grid = library::grid_of(problem.map);
  auto report = core::verify({grid, fleet.robots, fleet.obstacles, &fleet.zones},
                             core_plans(plans, library::Frame(problem.map)), core_rules, end_of(rules));
  return report ? library::verification_of(std::move(*report)) : Verification();
}

Verification verify(const Problem& problem, const Plan& plan, const Options& options) {
  Rules rules;
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.horizon = options.horizon;
  rules.unavoidable = plan.unavoidable;
  return verify(problem, std::span(plan.plans), rules);
}

}  // namespace fleetplan
