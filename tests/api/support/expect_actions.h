#pragma once

// What holds for the actions of every answer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

#include "core/geometry/position.h"
#include "tests/api/support/lives.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// From an action on, there is no translation, rotation or wait of hardly anything.
inline void expect_no_small_actions(const Json& actions, std::size_t first = 0) {
  constexpr double kLeast = 1e-9;
  constexpr double kRounding = 1e-13;
  for (std::size_t k = first; k < actions.size(); ++k) {
    const Json& action = actions[k];
    const core::Pose from = pose_of(action.at("from"));
    const core::Pose to = pose_of(action.at("to"));
    double amount = action.at("t_end").get<double>() - action.at("t_start").get<double>();
    if (action.at("type") == "translate") amount = (to.position - from.position).norm();
    if (action.at("type") == "rotate") amount = core::angle_between(from.theta, to.theta);
    EXPECT_GE(amount, kLeast - kRounding) << "action " << k << " of " << actions;
  }
}

/// The goal of a robot with this number.
inline Json goal_of(const Json& robot, std::size_t number) {
  return robot.contains("goal") ? robot.at("goal") : robot.at("goals").at(number);
}

/// Every visit that takes time has one uninterrupted rest that is named after its goal while it lasts. No
/// wait is named after a goal that is not visited.
inline void expect_that_marks_follow_visits(const Json& robot, const Json& plan) {
  constexpr double kSame = 1e-6;  // seconds
  const Json& actions = plan.at("actions");
  std::set<std::size_t> visited;
  for (const Json& visit : plan.value("visits", Json::array())) {
    const auto number = visit.at("goal").get<std::size_t>();
    visited.insert(number);
    const Json goal = goal_of(robot, number);
    const double service = goal.value("service", 0.0);
    if (visit.at("t_arrive").is_null()) continue;
    const double arrive = visit.at("t_arrive");
    const double leave = std::max(arrive, goal.value("not_before", 0.0)) + service;
    if (leave - arrive < kSame) continue;
    int rests = 0;
    double begin = 0.0;
    double end = -1.0;
    for (const Json& action : actions) {
      if (!action.contains("goal") || action.at("goal") != number) continue;
      if (action.at("t_start").get<double>() > end + kSame || rests == 0) {
        ++rests;
        begin = action.at("t_start");
      }
      end = action.at("t_end");
    }
    EXPECT_EQ(rests, 1) << "goal " << number << " of " << plan;
    EXPECT_LE(begin, std::max(arrive, 0.0) + kSame) << "goal " << number << " of " << plan;
    EXPECT_NEAR(end, leave, kSame) << "goal " << number << " of " << plan;
  }
  for (const Json& action : actions) {
    if (!action.contains("goal")) continue;
    EXPECT_TRUE(visited.contains(action.at("goal").get<std::size_t>())) << action << plan;
  }
}

}  // namespace fleetplan::api
