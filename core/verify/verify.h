#pragma once

// The independent check of a plan, in continuous time and closed form. It shares no collision test with the
// search.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"

namespace fleetplan::core {

/// The outcome of a check.
struct VerifyReport {
  std::vector<Violation> violations;  // by time, then kind, then robots; the first kMaxViolations
  std::size_t violation_count = 0;    // listed or not, except overlaps beyond kMaxCollisions
  // Metres: the smallest gap between two disks without inflation over all time. None for fewer than two
  // (usable) robots.
  std::optional<double> min_clearance;
  bool valid() const { return violations.empty(); }
};

/// Checks `plans` (at most one for each robot, in any order):
///
/// - collisions of robots with robots, moving obstacles, walls and the map's edge,
/// - continuity and speeds,
/// - start, visits, goal and commitments.
///
/// A robot without a plan executes its committed actions and stays at their end. A robot with a plan rests
/// where its last action ends. Robots need not form a valid Problem: starts that overlap or are in an
/// obstacle are violations at t = 0, except for robots with Robot::invalid.
///
/// Exact in continuous time up to rounding, a few ulp of the largest coordinate (1e-13 m on a map of 1 km).
/// Returns none if `stop` is met first: thousands of robots that move in one small area may take minutes.
/// Throws std::invalid_argument if a plan belongs to no robot, or two belong to the same robot.
std::optional<VerifyReport> verify(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans,
                                   const CheckRules& rules, const StopCondition& stop);

/// Checks a plan of the planner. Returns none if `stop` is met first.
std::optional<VerifyReport> check_plan(const Problem& problem, const PlanOptions& options, const Plan& plan,
                                       const StopCondition& stop);

}  // namespace fleetplan::core
