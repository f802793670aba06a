#pragma once

// Robots on a map, and the checker's report about them.

#include <gtest/gtest.h>

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/verify/verify.h"
#include "tests/support/ascii_map.h"
#include "tests/support/plain_check.h"
#include "tests/support/plan_builder.h"

namespace fleetplan::core {

using Kind = Violation::Kind;

inline constexpr double kTolerance = 1e-6;

/// For the messages of failed expectations.
inline void PrintTo(const Violation& violation, std::ostream* out) {
  *out << "kind " << static_cast<int>(violation.kind) << " at " << violation.t << ": " << violation.detail;
}

/// A robot of radius 0.5 m, 1 m/s and 1 rad/s, parked unless given a goal.
inline Robot robot_at(double x, double y, double theta = 0.0, double radius = 0.5) {
  Robot robot;
  robot.radius = radius;
  robot.linear_speed = 1.0;
  robot.angular_speed = 1.0;
  robot.start = {Position(x, y), theta};
  return robot;
}

/// A map of free cells of a metre each.
inline OccupancyGrid open_map(int columns = 20, int rows = 20) { return OccupancyGrid(columns, rows, 1.0); }

/// Robots and their plans. Each plan's end becomes the robot's goal, so that a scene is valid until a test
/// breaks it.
class Scene {
 public:
  explicit Scene(OccupancyGrid grid = open_map()) : grid_(std::move(grid)) {}

  /// A robot without a plan.
  Scene& stand(const Robot& robot) {
    robots_.push_back(robot);
    return *this;
  }

  /// A robot with the plan that `build` adds to a PlanBuilder.
  template <typename Build>
  Scene& add(Robot robot, Build build) {
    support::PlanBuilder builder(robots_.size(), robot);
    build(builder);
    const RobotPlan plan = builder.build();
    if (!plan.actions.empty()) {
      const Pose& rest = plan.actions.back().to;
      robot.goal = Goal{rest.position, rest.theta};
    }
    robots_.push_back(robot);
    plans_.push_back(plan);
    return *this;
  }

  /// A disk of radius 0.5 m that appears at the first entry and leaves after the last one.
  Scene& obstacle(std::vector<MovingObstacle::Entry> motion,
                  MovingObstacle::After after = MovingObstacle::After::leaves) {
    obstacles_.push_back({std::to_string(obstacles_.size()), 0.5, std::move(motion), after});
    return *this;
  }

  std::vector<Robot>& robots() { return robots_; }
  std::vector<RobotPlan>& plans() { return plans_; }
  Action& action(std::size_t index, std::size_t plan = 0) { return plans_[plan].actions[index]; }

  VerifyReport check(double tolerance = kTolerance) const {
    return *verify(grid_, robots_, plans_, tolerance, StopCondition::never());
  }
  std::vector<Violation> violations(double tolerance = kTolerance) const {
    return check(tolerance).violations;
  }

  /// With moving obstacles and these rules.
  std::optional<VerifyReport> check(CheckRules rules, const StopCondition& stop) const {
    rules.tolerances.assign(robots_.size(), Tolerance::of_all(kTolerance));
    return verify({grid_, robots_, obstacles_}, plans_, rules, stop);
  }
  std::vector<Violation> violations(const CheckRules& rules) const {
    return check(rules, StopCondition::never())->violations;
  }

 private:
  OccupancyGrid grid_;
  std::vector<Robot> robots_;
  std::vector<RobotPlan> plans_;
  std::vector<MovingObstacle> obstacles_;
};

inline std::vector<Kind> kinds_of(const std::vector<Violation>& violations) {
  std::vector<Kind> kinds;
  kinds.reserve(violations.size());
  for (const Violation& violation : violations) kinds.push_back(violation.kind);
  return kinds;
}

}  // namespace fleetplan::core
