#include "core/verify/execution.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

Position position_at(const Leg& leg, double t) {
  if (t <= leg.t_begin) return leg.from;
  if (t >= leg.t_end) return leg.to;
  const double fraction = (t - leg.t_begin) / (leg.t_end - leg.t_begin);
  return leg.from + fraction * (leg.to - leg.from) - fraction * (1.0 - fraction) * leg.bend;
}

Leg part_of(const Leg& leg, double begin, double end) {
  const double duration = leg.t_end - leg.t_begin;
  const bool bends = leg.bend != Position(0.0, 0.0);
  const double share = bends ? (end - begin) / duration : 0.0;  // a leg that bends has an end
  return {begin, end, position_at(leg, begin), position_at(leg, end), share * share * leg.bend};
}

namespace {

/// Adds a part of a translation, in which the speed changes evenly, and returns its length in metres.
class ProfileLegs {
 public:
  /// Divides a translation with a profile; if the profile does not fit, the speed is constant.
  static std::vector<Leg> of(const Action& action, const CarriedLoad& load) {
    const Leg whole{action.t_start, std::max(action.t_start, action.t_end), action.from.position,
                    action.to.position};
    const double length = (whole.to - whole.from).norm();
    if (!action.profile || action.type != Action::Type::translate || length <= 0.0) return {whole};
    const SpeedProfile& profile = *action.profile;
    const double gains = (profile.cruise - profile.start) / load.linear_acceleration;
    const double loses = (profile.cruise - profile.end) / load.linear_deceleration;
    const double first = 0.5 * (profile.start + profile.cruise) * gains;
    const double last = 0.5 * (profile.cruise + profile.end) * loses;
    const double cruises = whole.t_end - whole.t_begin - gains - loses;
    constexpr double kRounded = 1e-6;  // seconds and metres
    const bool fits =
        gains >= 0.0 && loses >= 0.0 && cruises >= -kRounded && first + last <= length + kRounded;
    if (!fits) return {whole};
    ProfileLegs legs(whole, length);
    if (gains > 0.0) legs.add(first, gains, profile.start, profile.cruise);
    if (cruises > 0.0 && first + last < length) legs.add(length - first - last, cruises, 0.0, 0.0);
    if (loses > 0.0) legs.add(last, loses, profile.cruise, profile.end);
    if (legs.legs_.empty()) return {whole};
    legs.legs_.back().t_end = whole.t_end;
    legs.legs_.back().to = whole.to;
    return std::move(legs.legs_);
  }

 private:
  ProfileLegs(const Leg& whole, double length)
      : direction_((whole.to - whole.from) / length), t_(whole.t_begin), here_(whole.from) {}

  void add(double length, double seconds, double from_speed, double to_speed) {
    const Position there = here_ + length * direction_;
    const double bend = 0.5 * (to_speed - from_speed) * seconds;
    legs_.push_back({t_, t_ + seconds, here_, there, bend * direction_});
    t_ += seconds;
    here_ = there;
  }

  Position direction_;
  double t_;
  Position here_;
  std::vector<Leg> legs_;
};

}  // namespace

std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan) {
  return execute(robot, plan, CarriedLoads(robot, plan, Tolerance::of_all(kMaxTolerance)));
}

std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan, const CarriedLoads& loads) {
  std::vector<Leg> legs;
  double now = 0.0;
  Position here = robot.start.position;
  const std::vector<Action> none;
  const std::vector<Action>& without_plan = robot.invalid ? none : robot.committed;
  const std::vector<Action>& actions = plan != nullptr ? plan->actions : without_plan;
  legs.reserve(actions.size() + 1);
  // Bounded: the actions of one plan, and at most three legs of each.
  for (const Action& action : actions) {
    if (action.t_start > now) {
      legs.push_back({now, action.t_start, here, here});
      now = action.t_start;
    }
    for (const Leg& planned : ProfileLegs::of(action, loads.at(action.t_start))) {
      // What lies entirely in the past, or takes no time, is executed at once.
      if (planned.t_end > now) {
        legs.push_back(part_of(planned, std::max(now, planned.t_begin), planned.t_end));
      } else {
        legs.push_back({now, now, planned.from, planned.to});
      }
      now = legs.back().t_end;
    }
    here = action.to.position;
  }
  legs.push_back({now, std::numeric_limits<double>::infinity(), here, here});
  return legs;
}

std::vector<Leg> legs_of(const MovingObstacle& obstacle) {
  std::vector<Leg> legs;
  legs.reserve(obstacle.motion.size());
  for (std::size_t k = 0; k + 1 < obstacle.motion.size(); ++k) {
    const MovingObstacle::Entry& from = obstacle.motion[k];
    const MovingObstacle::Entry& to = obstacle.motion[k + 1];
    legs.push_back({from.t, to.t, from.position, to.position});
  }
  if (obstacle.motion.empty()) return legs;
  const MovingObstacle::Entry& last = obstacle.motion.back();
  if (obstacle.after == MovingObstacle::After::stays) {
    legs.push_back({last.t, std::numeric_limits<double>::infinity(), last.position, last.position});
  } else if (legs.empty()) {
    legs.push_back({last.t, last.t, last.position, last.position});
  }
  return legs;
}

Handover handover_of(const Robot& robot, const RobotPlan* plan) {
  Handover handover;
  if (!robot.invalid) handover.committed_until = robot.committed_until();
  if (plan == nullptr) return handover;
  for (std::size_t k = robot.committed.size(); k < plan->actions.size(); ++k) {
    const Action& action = plan->actions[k];
    if (action.type != Action::Type::translate || action.from.position == action.to.position) continue;
    handover.leaves = action.t_start;
    handover.first_move_ends = action.t_end;
    break;
  }
  return handover;
}

namespace {

CarriedLoad load_at_start(const Robot& robot) {
  return {robot.radius, robot.linear_speed, robot.linear_acceleration, robot.linear_deceleration};
}

/// A goal that gives an acceleration without a deceleration changes both.
CarriedLoad after_service(CarriedLoad load, const Goal& goal) {
  if (goal.radius_after) load.radius = *goal.radius_after;
  if (goal.linear_speed_after) load.linear_speed = *goal.linear_speed_after;
  if (goal.linear_acceleration_after) {
    load.linear_acceleration = *goal.linear_acceleration_after;
    load.linear_deceleration = *goal.linear_acceleration_after;
  }
  if (goal.linear_deceleration_after) load.linear_deceleration = *goal.linear_deceleration_after;
  return load;
}

bool any_changes_load(const Robot& robot) {
  const auto changes = [](const Goal& goal) { return goal.changes_load(); };
  return std::any_of(robot.via.begin(), robot.via.end(), changes) || (robot.goal && changes(*robot.goal));
}

/// Follows the actions and serves one goal after the other.
class Services {
 public:
  Services(const Robot& robot, const Tolerance& tolerance)
      : robot_(robot),
        metres_(std::max(tolerance.metres, kContactTolerance)),
        radians_(std::max(tolerance.radians, kContactTolerance)),
        seconds_(tolerance.seconds),
        steps_{{0.0, load_at_start(robot)}} {}

  std::vector<CarriedLoads::Step> run(const std::vector<Action>& actions, bool ends_at_goal) {
    Pose pose = robot_.start;
    double now = 0.0;
    serve(pose, now);
    for (const Action& action : actions) {
      now = std::max(now, action.t_end);
      if (action.type != Action::Type::wait) free_from_ = now;
      pose = action.to;
      serve(pose, now);
    }
    const std::size_t last = robot_.via.size();
    if (ends_at_goal && served_ == last && is_at(pose, *robot_.goal)) {
      end_service(*robot_.goal, std::max(service_end(*robot_.goal), robot_.committed_until()));
    }
    return std::move(steps_);
  }

 private:
  bool is_at(const Pose& pose, const Goal& goal) const {
    return (pose.position - goal.position).norm() <= metres_ &&
           (!goal.theta || std::abs(rotation_between(pose.theta, *goal.theta)) <= radians_);
  }
  double service_end(const Goal& goal) const { return std::max(free_from_, goal.not_before) + goal.service; }

  /// Serves the goals in this pose, in which the robot has been at rest since `free_from_` and is until
  /// `now`.
  void serve(const Pose& pose, double now) {
    while (served_ < robot_.via.size() && is_at(pose, robot_.via[served_])) {
      const Goal& goal = robot_.via[served_];
      const double end = service_end(goal);
      if (end > now + seconds_) return;
      end_service(goal, end);
      free_from_ = end;
      ++served_;
    }
  }

  void end_service(const Goal& goal, double t) {
    if (goal.changes_load()) steps_.push_back({t, after_service(steps_.back().load, goal)});
  }

  const Robot& robot_;
  double metres_;
  double radians_;
  double seconds_;
  double free_from_ = 0.0;  // begin of the next service at the earliest
  std::size_t served_ = 0;  // number of goals
  std::vector<CarriedLoads::Step> steps_;
};

}  // namespace

CarriedLoads::CarriedLoads(const Robot& robot, const RobotPlan* plan, const Tolerance& tolerance)
    : steps_{{0.0, load_at_start(robot)}}, seconds_(tolerance.seconds) {
  const bool does_nothing = robot.invalid || (plan == nullptr && robot.committed.empty());
  if (does_nothing || !any_changes_load(robot)) return;
  steps_ = Services(robot, tolerance).run(plan != nullptr ? plan->actions : robot.committed, plan != nullptr);
}

const CarriedLoad& CarriedLoads::at(double t) const {
  const auto next = std::upper_bound(steps_.begin() + 1, steps_.end(), t + seconds_,
                                     [](double time, const Step& step) { return time < step.t; });
  return std::prev(next)->load;
}

namespace {

/// Moves the legs until `t` from the begin of `legs` into a list of their own, and returns that list.
std::vector<Leg> take_until(double t, std::vector<Leg>& legs) {
  std::vector<Leg> taken;
  std::size_t whole = 0;
  while (whole < legs.size() && legs[whole].t_end <= t) taken.push_back(legs[whole++]);
  legs.erase(legs.begin(), legs.begin() + static_cast<std::ptrdiff_t>(whole));
  if (!legs.empty() && legs.front().t_begin < t) {
    Leg& divided = legs.front();
    taken.push_back(part_of(divided, divided.t_begin, t));
    divided = part_of(divided, t, divided.t_end);
  }
  return taken;
}

}  // namespace

std::vector<SizedLegs> sized_legs_of(const CarriedLoads& loads, std::vector<Leg> legs) {
  std::vector<SizedLegs> disks;
  double radius = loads.steps().front().load.radius;
  for (const auto& [t, load] : loads.steps()) {
    if (load.radius != radius) {
      std::vector<Leg> before = take_until(t, legs);
      if (!before.empty()) disks.push_back({radius, std::move(before)});
    }
    radius = load.radius;
  }
  disks.push_back({radius, std::move(legs)});
  return disks;
}

}  // namespace fleetplan::core
