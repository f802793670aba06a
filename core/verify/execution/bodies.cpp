#include "core/verify/execution/bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

struct Change {
  double t;
  double radius;
};

/// Follows the actions and serves one goal after the other.
class Services {
 public:
  Services(const Robot& robot, const Tolerance& tolerance)
      : robot_(robot),
        metres_(std::max(tolerance.metres, kContactTolerance)),
        radians_(std::max(tolerance.radians, kContactTolerance)),
        seconds_(tolerance.seconds) {}

  std::vector<Change> run(const std::vector<Action>& actions, bool ends_at_goal) {
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
    return std::move(changes_);
  }

 private:
  bool is_at(const Pose& pose, const Goal& goal) const {
    return (pose.position - goal.position).norm() <= metres_ &&
           (!goal.theta || std::abs(rotation_between(pose.theta, *goal.theta)) <= radians_);
  }
  double service_end(const Goal& goal) const { return std::max(free_from_, goal.not_before) + goal.service; }

  /// The robot has been at rest in this pose since `free_from_`, and is until `now`.
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
    if (goal.radius_after) changes_.push_back({t, *goal.radius_after});
  }

  const Robot& robot_;
  double metres_;
  double radians_;
  double seconds_;
  double free_from_ = 0.0;  // for the next service
  std::size_t served_ = 0;  // goals
  std::vector<Change> changes_;
};

std::vector<Change> changes_of(const Robot& robot, const RobotPlan* plan, const Tolerance& tolerance) {
  const bool changes =
      robot.goal && !robot.invalid &&
      (robot.goal->radius_after || std::any_of(robot.via.begin(), robot.via.end(), [](const Goal& goal) {
         return goal.radius_after.has_value();
       }));
  const bool does_nothing = plan == nullptr && robot.committed.empty();
  if (!changes || does_nothing) return {};
  return Services(robot, tolerance).run(plan != nullptr ? plan->actions : robot.committed, plan != nullptr);
}

/// Moves the legs until `t` from the begin of `legs` into a list of their own.
std::vector<Leg> take_until(double t, std::vector<Leg>& legs) {
  std::vector<Leg> taken;
  std::size_t whole = 0;
  while (whole < legs.size() && legs[whole].t_end <= t) taken.push_back(legs[whole++]);
  legs.erase(legs.begin(), legs.begin() + static_cast<std::ptrdiff_t>(whole));
  if (!legs.empty() && legs.front().t_begin < t) {
    Leg& divided = legs.front();
    const Position there = position_at(divided, t);
    taken.push_back({divided.t_begin, t, divided.from, there});
    divided.t_begin = t;
    divided.from = there;
  }
  return taken;
}

}  // namespace

std::vector<Body> bodies_of(const Robot& robot, const RobotPlan* plan, std::vector<Leg> legs,
                            const Tolerance& tolerance) {
  std::vector<Body> bodies;
  double radius = robot.radius;
  for (const Change& change : changes_of(robot, plan, tolerance)) {
    if (change.radius != radius) {
      std::vector<Leg> before = take_until(change.t, legs);
      if (!before.empty()) bodies.push_back({radius, std::move(before)});
    }
    radius = change.radius;
  }
  bodies.push_back({radius, std::move(legs)});
  return bodies;
}

}  // namespace fleetplan::core
