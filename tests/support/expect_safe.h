#pragma once

// Checks of plans by the independent checker.

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/plan/collect_plan.h"
#include "core/verify/verify.h"
#include "tests/support/plain_check.h"
#include "tests/support/summary.h"

namespace fleetplan::support {

/// Metres: the contact tolerance of the service, and the rounding of times and positions.
inline constexpr double kSafeTolerance = 2e-9;

/// The tolerances of the service for robots with actions of the request or among moving obstacles, which they
/// may touch, and kSafeTolerance for others.
inline std::vector<core::Tolerance> safe_tolerances(const core::Problem& problem,
                                                    const std::vector<core::RobotPlan>& plans) {
  auto tolerances = core::plan_tolerances(problem.grid(), problem.robots(), plans);
  for (std::size_t i = 0; i < tolerances.size(); ++i) {
    const core::Robot& robot = problem.robots()[i];
    if (robot.committed.empty() && !robot.previous && problem.obstacles().empty())
      tolerances[i] = core::Tolerance::of_all(kSafeTolerance);
  }
  return tolerances;
}

/// Returns the checker's report with these rules and safe_tolerances.
inline core::VerifyReport safety_report(const core::Problem& problem,
                                        const std::vector<core::RobotPlan>& plans,
                                        core::CheckRules rules = {}) {
  rules.tolerances = safe_tolerances(problem, plans);
  rules.exact_commitments = true;
  return *core::verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()}, plans,
                       rules, core::StopCondition::never());
}

/// Expects that planned robots collide with no other robot, planned or not, no moving obstacle and not with
/// the map. They must begin with their committed actions and visit their goals.
inline void expect_safe(const core::Problem& problem, const std::vector<core::RobotPlan>& plans) {
  const core::VerifyReport report = safety_report(problem, plans);
  EXPECT_TRUE(report.valid()) << text(report);
}

/// Expects that the result of planning meets all that `options` ask for: interval margin, added waits and the
/// overlap of starts. Collisions that the plan lists as unavoidable are exempt. On a busy machine, finding
/// them may be given up. Then the plan cannot be checked (see core::Plan).
inline void expect_safe(const core::Problem& problem, const core::Plan& plan,
                        const core::PlanOptions& options) {
  if (!plan.unavoidable_known) return;
  core::CheckRules rules;
  rules.interval_margin = options.interval_margin;
  rules.wait_before_move = options.wait_before_move;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  rules.exempt = plan.unavoidable;
  const core::VerifyReport report = safety_report(problem, plan.plans, rules);
  EXPECT_TRUE(report.valid()) << text(report);
}

/// Whether the robot is nearer to a wall or to the start of another robot than it should be, if all radii are
/// enlarged by `inflation`.
inline bool starts_too_near(const core::Problem& problem, std::size_t robot, double inflation) {
  const core::Robot& self = problem.robots()[robot];
  const double radius = self.radius + inflation;
  bool near = core::obstacle_distance(problem.grid(), self.start.position, radius) < radius;
  for (const core::Robot& other : problem.robots()) {
    if (&other == &self) continue;
    const double gap = (other.start.position - self.start.position).norm() - radius - other.radius;
    near = near || gap < inflation;
  }
  return near;
}

/// Expects a safe plan also with radii enlarged by `inflation`, except for robots that start too near to
/// others.
inline void expect_safe(const core::Problem& problem, const core::Plan& plan, double inflation = 0.0) {
  expect_safe(problem, plan.plans);
  if (inflation == 0.0) return;
  std::vector<core::Robot> robots = problem.robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!starts_too_near(problem, i, inflation)) robots[i].radius += inflation;
  }
  const core::VerifyReport report =
      *core::verify(problem.grid(), robots, plan.plans, kSafeTolerance, core::StopCondition::never());
  EXPECT_TRUE(report.valid()) << "inflated by " << inflation << ": " << text(report);
}

/// Returns the current trajectories as plans. Robots without a trajectory have none.
inline std::vector<core::RobotPlan> plans_of(const core::FleetReservations& reservations) {
  std::vector<core::RobotPlan> plans;
  for (std::size_t i = 0; i < reservations.instance().size(); ++i) {
    const auto& trajectory = reservations.trajectory(i);
    if (!trajectory) continue;
    plans.push_back({i, trajectory->cost,
                     core::to_actions(reservations.instance().problem().robots()[i], *trajectory,
                                      reservations.instance().views(i)[0].zones.get())});
  }
  return plans;
}

inline void expect_safe(const core::FleetReservations& reservations) {
  expect_safe(reservations.instance().problem(), plans_of(reservations));
}

}  // namespace fleetplan::support
