#pragma once

// Plans for tests, written action by action.

#include <cmath>
#include <cstddef>

#include "core/geometry/position.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::support {

/// Builds the plan of one robot from its start at t = 0, at the full speed of the robot:
/// `PlanBuilder(0, robot).rotate_to(1.57).translate_to(1, 4).wait(2).build()`. Plans can be invalid: only
/// `drive_to` adds the rotation that it needs.
class PlanBuilder {
 public:
  PlanBuilder(std::size_t index, const core::Robot& robot)
      : linear_speed_(robot.linear_speed), angular_speed_(robot.angular_speed), pose_(robot.start) {
    plan_.robot = index;
  }

  /// Rotates in place to a heading, in the shorter direction.
  PlanBuilder& rotate_to(double theta) {
    core::Pose to = pose_;
    to.theta = core::normalize_angle(theta);
    const double angle = std::abs(core::rotation_between(pose_.theta, to.theta));
    return add(core::Action::Type::rotate, angle / angular_speed_, to);
  }

  /// Translates to a point without rotating, at `speed` (m/s), or at the robot's full speed if it is 0.
  PlanBuilder& translate_to(double x, double y, double speed = 0.0) {
    core::Pose to = pose_;
    to.position = core::Position(x, y);
    const double length = (to.position - pose_.position).norm();
    return add(core::Action::Type::translate, length / (speed > 0.0 ? speed : linear_speed_), to);
  }

  /// Rotates towards a point if necessary and translates there.
  PlanBuilder& drive_to(double x, double y, double speed = 0.0) {
    const core::Position offset = core::Position(x, y) - pose_.position;
    const double theta = std::atan2(offset.y(), offset.x());
    if (std::abs(core::rotation_between(pose_.theta, theta)) > 0.0) rotate_to(theta);
    return translate_to(x, y, speed);
  }

  PlanBuilder& wait(double seconds) { return add(core::Action::Type::wait, seconds, pose_); }

  /// The plan so far; its cost is the end of the last action.
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

  double linear_speed_;
  double angular_speed_;
  core::Pose pose_;
  double now_ = 0.0;
  core::RobotPlan plan_;
};

}  // namespace fleetplan::support
