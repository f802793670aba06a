#pragma once

// What every plan of a fleet in motion has to fulfil, and how it compares with the previous one.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/tolerance.h"
#include "core/plan/kept_plans.h"
#include "core/plan/planner.h"
#include "core/verify/verify.h"
#include "tests/support/expect_safe.h"

namespace fleetplan::support {

inline core::StopCondition budget_of(int ms) {
  return core::StopCondition(core::StopCondition::Clock::now() + std::chrono::milliseconds(ms));
}

inline double objective(const core::PlanOptions& options, const std::vector<double>& costs) {
  double sum = 0.0;
  double most = 0.0;
  for (const double cost : costs) {
    sum += cost;
    most = std::max(most, cost);
  }
  return options.objective == core::PlanOptions::Objective::flowtime ? sum : most;
}

/// Returns the previous plans of all robots with goals; none if one of them has no previous plan.
inline std::optional<std::vector<core::RobotPlan>> previous_plans(const core::Problem& problem) {
  std::vector<core::RobotPlan> plans;
  for (std::size_t i = 0; i < problem.robots().size(); ++i) {
    const core::Robot& robot = problem.robots()[i];
    if (!robot.goal) continue;
    if (!robot.previous) return std::nullopt;
    plans.push_back({i, robot.previous->empty() ? 0.0 : robot.previous->back().t_end, *robot.previous});
  }
  return plans;
}

inline bool hold(const core::Problem& problem, const core::PlanOptions& options,
                 const std::vector<core::RobotPlan>& plans) {
  core::CheckRules rules;
  rules.inflation = options.inflation;
  rules.interval_margin = options.interval_margin;
  rules.wait_before_move = options.wait_before_move;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  return safety_report(problem, plans, rules).valid();
}

inline std::string unplanned_text(const core::Plan& plan) {
  std::string text;
  for (const core::Unplanned& robot : plan.unplanned)
    text += std::to_string(robot.robot) + ": " + robot.detail + "\n";
  return text;
}

inline bool same(const core::Action& a, const core::Action& b) {
  return a.type == b.type && a.t_start == b.t_start && a.t_end == b.t_end &&
         a.from.position == b.from.position && a.from.theta == b.from.theta &&
         a.to.position == b.to.position && a.to.theta == b.to.theta;
}

inline void expect_each_robot_once(const core::Problem& problem, const core::Plan& plan) {
  std::set<std::size_t> seen;
  for (const core::RobotPlan& robot : plan.plans) EXPECT_TRUE(seen.insert(robot.robot).second);
  for (const core::Unplanned& robot : plan.unplanned) EXPECT_TRUE(seen.insert(robot.robot).second);
  EXPECT_EQ(seen.size(), problem.robots().size());
}

/// Expects that an answer has all robots and is no worse than the previous plans, if all of these hold.
/// `first` returns them as they are. Returns whether they hold.
inline bool expect_no_worse_than_previous(const core::Problem& problem, const core::PlanOptions& options,
                                          const core::Plan& plan) {
  const auto previous = previous_plans(problem);
  if (!previous || !hold(problem, options, *previous)) return false;
  EXPECT_TRUE(plan.unplanned.empty()) << unplanned_text(plan);
  std::vector<double> before;
  std::vector<double> after;
  for (const core::RobotPlan& robot : *previous) before.push_back(robot.cost);
  for (const core::RobotPlan& robot : plan.plans) {
    if (problem.robots()[robot.robot].goal) after.push_back(robot.cost);
  }
  EXPECT_LE(objective(options, after), objective(options, before) + 1e-9);
  if (options.mode == core::PlanOptions::Mode::anytime) return true;
  for (const core::RobotPlan& robot : plan.plans) {
    const auto& given = problem.robots()[robot.robot].previous;
    if (!given || !problem.robots()[robot.robot].goal) continue;
    EXPECT_TRUE(std::equal(given->begin(), given->end(), robot.actions.begin(), robot.actions.end(), same))
        << "robot " << robot.robot << " does not keep its plan";
  }
  return true;
}

/// Expects that the checker finds every unavoidable collision that is listed, and that each pair is listed
/// once.
inline void expect_real_collisions(const core::Problem& problem, const core::Plan& plan) {
  if (plan.unavoidable.empty()) return;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::set<std::pair<std::size_t, std::size_t>> with_obstacles;
  core::CheckRules rules;
  rules.tolerances.assign(problem.robots().size(), core::Tolerance::of_all(core::kContactTolerance));
  const auto report = core::verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()},
                                   plan.plans, rules, core::StopCondition::never());
  for (const core::Violation& violation : report->violations) {
    if (violation.kind == core::Violation::Kind::robot_collision)
      pairs.insert({violation.robots[0], violation.robots[1]});
    if (violation.obstacle) with_obstacles.insert({violation.robots[0], *violation.obstacle});
  }
  for (const core::UnavoidableCollision& collision : plan.unavoidable) {
    if (collision.obstacle) {
      EXPECT_TRUE(with_obstacles.contains({collision.robot, *collision.obstacle}))
          << "robot " << collision.robot << " and obstacle " << *collision.obstacle << " at " << collision.t;
    } else {
      const auto pair = std::minmax(collision.robot, collision.other.value());
      EXPECT_TRUE(pairs.contains(pair))
          << "robots " << pair.first << " and " << pair.second << " at " << collision.t;
    }
  }
}

inline core::Plan planned(const core::Problem& problem, const core::PlanOptions& options, int budget_ms) {
  core::Plan plan = core::plan(problem, options, budget_of(budget_ms));
  expect_safe(problem, plan, options);
  expect_each_robot_once(problem, plan);
  expect_real_collisions(problem, plan);
  return plan;
}

}  // namespace fleetplan::support
