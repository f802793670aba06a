#pragma once

// Robots and plans, written as they are told.

#include <cmath>
#include <cstddef>

#include "core/geometry/angle.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::support {

/// A plan of one robot, action by action, from its start at t = 0 and as fast as the robot can:
/// `PlanBuilder(0, robot).rotate_to(1.57).translate_to(1, 4).wait(2).build()`. The motions are what the calls
/// say, valid or not: nothing turns or waits by itself, except in `drive_to`.
class PlanBuilder {
 public:
  PlanBuilder(std::size_t index, const core::Robot& robot) : robot_(robot), pose_(robot.start) {
    plan_.robot = index;
  }

  /// Turns in place to a heading, the shorter way.
  PlanBuilder& rotate_to(double theta) {
    core::Pose to = pose_;
    to.theta = core::normalize_angle(theta);
    const double angle = std::abs(core::rotation_between(pose_.theta, to.theta));
    return add(core::Action::Type::rotate, angle / robot_.angular_speed, to);
  }

  /// Moves straight to a point with the heading it has; at `speed` (m/s) instead of the robot's where given.
  PlanBuilder& translate_to(double x, double y, double speed = 0.0) {
    core::Pose to = pose_;
    to.position = core::Position(x, y);
    const double length = (to.position - pose_.position).norm();
    return add(core::Action::Type::translate, length / (speed > 0.0 ? speed : robot_.linear_speed), to);
  }

  /// Turns towards a point, if it has to, and moves there.
  PlanBuilder& drive_to(double x, double y, double speed = 0.0) {
    const core::Position way = core::Position(x, y) - pose_.position;
    const double theta = std::atan2(way.y(), way.x());
    if (std::abs(core::rotation_between(pose_.theta, theta)) > 0.0) rotate_to(theta);
    return translate_to(x, y, speed);
  }

  /// Stands still, seconds.
  PlanBuilder& wait(double seconds) { return add(core::Action::Type::wait, seconds, pose_); }

  /// The plan so far; it costs what its actions take.
  core::RobotPlan build() const {
    core::RobotPlan plan = plan_;
    plan.cost = now_;
    return plan;
  }

 private:
  PlanBuilder& add(core::Action::Type type, double duration, const core::Pose& to) {
    plan_.actions.push_back({type, now_, now_ + duration, pose_, to});
    now_ += duration;
    pose_ = to;
    return *this;
  }

  core::Robot robot_;
  core::Pose pose_;
  double now_ = 0.0;
  core::RobotPlan plan_;
};

}  // namespace fleetplan::support
