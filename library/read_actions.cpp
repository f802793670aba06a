#include "library/read_actions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angle.h"
#include "core/geometry/speed_profile.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"

namespace fleetplan::library {

namespace {

using Type = core::Action::Type;

constexpr double kTolerance = core::kContactTolerance;
/// Radians and seconds by which actions may deviate, as in the service (api/request/fleet/parse_actions.cpp).
constexpr double kTurnTolerance = core::kSamePosition;
constexpr double kTimeRounding = std::numeric_limits<double>::epsilon() * core::kLongestPlan;

double distance(const core::Pose& a, const core::Pose& b) { return (b.position - a.position).norm(); }
double turn(const core::Pose& a, const core::Pose& b) { return core::angle_between(a.theta, b.theta); }

bool in_range(const Action& action) {
  const auto is_pose = [](const Pose& pose) {
    return kCoordinate.contains(pose.x) && kCoordinate.contains(pose.y) && kAngle.contains(pose.theta);
  };
  return kDuration.contains(action.t_start) && kDuration.contains(action.t_end) && is_pose(action.from) &&
         is_pose(action.to) &&
         (!action.profile ||
          (kProfileSpeed.contains(action.profile->start) && kProfileSpeed.contains(action.profile->cruise) &&
           kProfileSpeed.contains(action.profile->end)));
}

/// Returns why an action cannot follow a pose and a time; null if it can.
const char* gap(const core::Action& action, const core::Pose& before, double now) {
  if (std::abs(action.t_start - now) > kTolerance) return "does not start when the one before ends";
  if (action.t_end < action.t_start - kTolerance) return "ends before it starts";
  if (distance(before, action.from) > kTolerance || turn(before, action.from) > kTolerance) {
    return "does not begin where the one before ends, or at the robot's start";
  }
  const bool moves = action.type != Type::translate && distance(action.from, action.to) > kTolerance;
  const bool turns = action.type != Type::rotate && turn(action.from, action.to) > kTolerance;
  return moves || turns ? "contradicts its type: only translations move, and only rotations turn" : nullptr;
}

/// Returns why a robot cannot execute an action; null if it can.
const char* impossible(const core::Action& action, const core::Robot& robot, const core::Load& load) {
  const double duration = action.t_end - action.t_start;
  if (action.type == Type::rotate) {
    const double tolerance = kTurnTolerance + robot.angular_speed * kTimeRounding;
    const bool is_fast = turn(action.from, action.to) > robot.angular_speed * duration + tolerance;
    return is_fast ? "is faster than the robot" : nullptr;
  }
  if (action.type != Type::translate) return nullptr;
  const double length = distance(action.from, action.to);
  if (length > load.linear_speed * duration + kTolerance || (duration <= 0.0 && length > 0.0)) {
    return "is faster than the robot";
  }
  const core::Position d = action.to.position - action.from.position;
  const core::Position heading(std::cos(action.from.theta), std::sin(action.from.theta));
  if (std::abs(core::cross_product(heading, d)) > kTolerance) return "leads off the line of its heading";
  if (!action.reverse) return nullptr;
  if (!robot.may_reverse) return "reverses, but the robot may not";
  return d.dot(heading) > kTolerance ? "leads ahead, although it reverses" : nullptr;
}

/// Returns why the profile of an action does not fit; null if it does. Only measured motion has none.
/// `speed`: at the end of the action before; none: unknown.
const char* unfit(const core::Action& action, const core::Robot& robot, const core::Load& load,
                  std::optional<double> speed, bool may_be_measured) {
  const double amount = core::amount_of(action);
  if (!action.profile) {
    const bool has_to = !may_be_measured && robot.limits_changes_of_speed(action.type) && amount > kTolerance;
    if (has_to) return "has no profile, but the robot's acceleration is limited";
    const bool is_measured = action.type == Type::translate;
    return speed.value_or(0.0) > kTolerance && !is_measured ? "begins at rest, unlike the one before ends"
                                                            : nullptr;
  }
  const core::SpeedProfile& profile = *action.profile;
  if (action.type == Type::wait) return "has a profile, but waits";
  if (!(profile.cruise > 0.0) || profile.cruise < std::max(profile.start, profile.end)) {
    return "has a profile whose cruise speed is 0, or less than start or end";
  }
  const double greatest = action.type == Type::rotate ? robot.angular_speed : load.linear_speed;
  if (profile.cruise > greatest + kTolerance) {
    return "has a profile that is faster than the robot";
  }
  if (speed && std::abs(profile.start - *speed) > kTolerance) {
    return "has a profile that does not begin at the speed at which the one before ends";
  }
  const double changes = profile.rise_length() + profile.fall_length();
  const double seconds = core::duration(profile, amount) - (action.t_end - action.t_start);
  const bool fits = changes <= amount + kTolerance * (1.0 + profile.cruise) &&
                    std::abs(seconds) * profile.cruise <= kTolerance * (1.0 + profile.cruise);
  return fits ? nullptr : "has a profile that does not lead over its length in its time";
}

}  // namespace

std::vector<core::Action> read_actions(const std::vector<Action>& actions, const core::Robot& robot,
                                       std::size_t measured, const Frame& frame, const std::string& place,
                                       FaultList& faults) {
  std::vector<core::Action> read;
  read.reserve(actions.size());
  core::Pose before = robot.start;
  double now = 0.0;
  std::optional<double> speed;
  core::LoadOnTheWay on_the_way(robot);
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const auto refuse = [&](const std::string& why) {
      faults.add(item(place, k), "The action " + why + '.');
      return read;
    };
    if (!in_range(actions[k])) return refuse("has a time, a coordinate or a speed out of range");
    if (actions[k].goal && actions[k].type != Action::Type::wait)
      return refuse("names a goal, but does not wait");
    if (actions[k].goal && *actions[k].goal >= robot.goal_count())
      return refuse("names a goal that there is not");
    core::Action action = frame.to_core(actions[k]);
    if (const char* why = gap(action, before, now)) return refuse(why);
    action.t_start = now;
    action.t_end = std::max(action.t_start, action.t_end);
    action.from = before;
    if (action.type != Type::translate) action.to.position = action.from.position;
    if (action.type != Type::rotate) action.to.theta = action.from.theta;
    const core::Load& load = on_the_way.load();
    if (const char* why = impossible(action, robot, load)) return refuse(why);
    core::set_inertia(action, robot, load);
    if (const char* why = unfit(action, robot, load, speed, k < measured)) return refuse(why);
    on_the_way.execute(action);
    speed.reset();
    if (action.profile || action.type != Type::translate) speed = action.profile ? action.profile->end : 0.0;
    before = action.to;
    now = action.t_end;
    read.push_back(action);
  }
  if (speed.value_or(0.0) > kTolerance) {
    faults.add(item(place, read.size() - 1), "The action ends at a speed; the last one has to end at rest.");
  }
  return read;
}

}  // namespace fleetplan::library
