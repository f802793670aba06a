#include "core/advance/timeline.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/advance/inertia.h"
#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

/// An action that has less left is done (seconds): far above the rounding of times, far below what matters.
constexpr double kDone = 1e-9;

/// A measured pose that is nearer to the end of a translation has reached it (metres).
constexpr double kReached = 1e-6;

/// Translations whose headings differ by less lead on in one line (radians): more than the rounding of
/// numbers in text.
constexpr double kSameLine = 1e-6;

/// A measured pose that is nearer to the planned line is on it (metres).
constexpr double kOnLine = 1e-8;

double turn(const Action& action) { return rotation_between(action.from.theta, action.to.theta); }

/// The actions from an index on, on the clock of the moment.
ActionSequence shifted(const ActionSequence& actions, std::size_t first, double at) {
  ActionSequence rest(actions.begin() + static_cast<std::ptrdiff_t>(std::min(first, actions.size())),
                      actions.end());
  for (Action& action : rest) {
    action.t_start -= at;
    action.t_end -= at;
  }
  return rest;
}

void delay(ActionSequence& actions, std::size_t first, double seconds) {
  for (std::size_t k = first; k < actions.size(); ++k) {
    actions[k].t_start += seconds;
    actions[k].t_end += seconds;
  }
}

/// How far along a translation the pose is, from 0 to 1.
double fraction(const Action& action, const Pose& pose) {
  const Position path = action.to.position - action.from.position;
  const double squared = path.squaredNorm();
  return squared > 0.0 ? std::clamp((pose.position - action.from.position).dot(path) / squared, 0.0, 1.0)
                       : 1.0;
}

/// The planned time at which the robot is where it was measured, if that is on the path of the action.
std::optional<double> time_of(const Action& action, const Pose& pose, double at, double tolerance) {
  if (action.type == Action::Type::translate) {
    const double along = fraction(action, pose);
    const Position nearest = action.from.position + along * (action.to.position - action.from.position);
    const bool is_near = (nearest - pose.position).norm() <= tolerance &&
                         angle_between(action.from.theta, pose.theta) <= tolerance;
    return is_near ? std::optional(time_at_share(action, along)) : std::nullopt;
  }
  if ((action.from.position - pose.position).norm() > tolerance) return std::nullopt;
  const double left = rotation_between(pose.theta, action.to.theta);
  if (action.type == Action::Type::wait) {
    if (std::abs(left) > tolerance) return std::nullopt;
    return std::clamp(at, action.t_start, action.t_end);
  }
  const double whole = turn(action);
  const double done = whole != 0.0 ? 1.0 - left / whole : 1.0;
  const double slack = whole != 0.0 ? tolerance / std::abs(whole) : 0.0;
  if (done < -slack || done > 1.0 + slack) return std::nullopt;
  return time_at_share(action, std::clamp(done, 0.0, 1.0));
}

/// The duration of an action with another length, or angle, at its planned speed and no faster than the
/// robot. The planned speed of a short action is that only up to rounding, which must not grow with its
/// length.
double scaled(double duration, double planned, double amount, double speed) {
  return std::max(planned > 0.0 ? amount * duration / planned : 0.0, amount / speed);
}

/// After a translation along another line than planned, the next rotation begins with the heading of this
/// line. If no rotation follows, a new one turns the robot to its planned heading.
void turn_back(ActionSequence& driven, ActionSequence& following, double planned_heading,
               const Robot& robot) {
  const double angular_speed = robot.angular_speed;
  const Inertia inertia = robot.angular_inertia();
  const Action& last = driven.back();
  if (!following.empty() && following.front().type == Action::Type::rotate) {
    Action& next = following.front();
    const double planned_turn = std::abs(turn(next));
    const double duration = next.t_end - next.t_start;
    next.from.theta = last.to.theta;
    double turned = scaled(duration, planned_turn, std::abs(turn(next)), angular_speed);
    if (next.profile) {
      next.profile = fastest_profile(std::abs(turn(next)), next.profile->cruise, inertia);
      turned = core::duration(*next.profile, std::abs(turn(next)));
      next.t_end = next.t_start + turned;
    }
    const double longer = turned - std::max(0.0, duration);
    if (longer > 0.0) {
      if (!next.profile) next.t_end += longer;
      delay(following, 1, longer);
    }
    return;
  }
  const double angle = angle_between(last.to.theta, planned_heading);
  if (angle < kLeastAction) return;
  const double end = last.t_end + inertia.time(angle, angular_speed);
  driven.push_back({Action::Type::rotate, last.t_end, end, last.to, {last.to.position, planned_heading}});
  if (inertia.is_limited) driven.back().profile = fastest_profile(angle, angular_speed, inertia);
}

/// The heading of a robot that drives along a path; backwards if it has planned to.
double heading_along(const Position& path, const Action& planned) {
  const Position ahead = unit_vector(planned.from.theta);
  const Position planned_path = planned.to.position - planned.from.position;
  const double aside = cross_product(ahead, path);
  if (std::abs(aside) <= kOnLine && ahead.dot(path) * ahead.dot(planned_path) > 0.0)
    return planned.from.theta;
  const double sign = ahead.dot(planned_path) < 0.0 ? -1.0 : 1.0;
  return heading_of(sign * path);
}

/// The action under way as it goes on from a measured pose; nothing if it is done. `left`: seconds, of a
/// wait. `linear_speed`: the greatest of the robot with its load.
std::optional<Action> continued(const Robot& robot, double linear_speed, Action action, const Pose& pose,
                                double left) {
  const double duration = action.t_end - action.t_start;
  if (action.type == Action::Type::translate) {
    const Position path = action.to.position - pose.position;
    const bool has_reached = path.norm() <= kReached || amount_of(action) <= 0.0;
    left = has_reached ? 0.0 : scaled(duration, amount_of(action), path.norm(), linear_speed);
    action.from = {pose.position, heading_along(path, action)};
    action.to.theta = action.from.theta;
  } else if (action.type == Action::Type::rotate) {
    const double angle = std::abs(rotation_between(pose.theta, action.to.theta));
    const bool has_turned = angle < kLeastAction || turn(action) == 0.0;
    left = has_turned ? 0.0 : scaled(duration, std::abs(turn(action)), angle, robot.angular_speed);
    action.from.theta = pose.theta;
  }
  action.t_start = 0.0;
  action.t_end = left;
  return left > kDone ? std::optional(action) : std::nullopt;
}

/// Drives the first action, and the actions that follow it at speed, from this speed on. If it leads along
/// another line than planned, the robot stands at its end, where it turns. The next actions then begin from
/// rest.
void go_on_at(double speed, ActionSequence& driven, ActionSequence& following) {
  ActionSequence chain = driven;
  chain.insert(chain.end(), following.begin(), following.end());
  chain.resize(end_of_chain(chain, 0));
  const auto next = following.begin() + static_cast<std::ptrdiff_t>(chain.size() - 1);
  const bool turns = chain.size() > 1 && angle_between(chain[0].to.theta, chain[1].from.theta) > kSameLine;
  if (turns) {
    const ActionSequence from_rest =
        driven_from(ActionSequence(following.begin(), next), following.front().t_start, 0.0);
    const double later = from_rest.back().t_end - std::prev(next)->t_end;
    std::copy(from_rest.begin(), from_rest.end(), following.begin());
    delay(following, from_rest.size(), later);
    chain.resize(1);
  } else {
    following.erase(following.begin(), next);
  }
  driven = driven_from(std::move(chain), 0.0, speed);
}

/// The action with this index continued from a pose, and the others after it. `speed`: of the robot, if the
/// action has a profile.
Remainder continued_from(const Robot& robot, const ActionSequence& actions, std::size_t index,
                         const Pose& pose, ActionSequence following, double left_of_wait, double speed) {
  const Action& planned = actions[index];
  const double linear_speed = load_during(robot, actions, index).linear_speed;
  Remainder rest{planned.to, {}};
  if (const auto action = continued(robot, linear_speed, planned, pose, left_of_wait)) {
    rest.start = action->from;
    rest.actions.push_back(*action);
    if (action->profile) go_on_at(speed, rest.actions, following);
    if (planned.type == Action::Type::translate) {
      turn_back(rest.actions, following, planned.to.theta, robot);
    }
  }
  append(rest.actions, following);
  return rest;
}

/// What is left of a wait at its planned time `t`, when it is `at`: only a goal's `not_before` has a time of
/// its own. `service_left`: seconds, if it is known.
double wait_left(const Robot& robot, const Action& wait, double t, std::optional<double> service_left,
                 double at) {
  const bool is_service = wait.goal && *wait.goal < robot.goal_count();
  const double begin = is_service ? std::min(robot.goal_at(*wait.goal).not_before, wait.t_end) : 0.0;
  const double left = service_left.value_or(wait.t_end - std::max(t, begin));
  return t < begin ? std::max(0.0, begin - at) + left : left;
}

/// The measured speed, or the planned one at a time.
double speed_of(const Action& action, double t, const std::optional<double>& measured) {
  return measured ? std::abs(*measured) : speed_at(action, t);
}

/// The last of the actions from this one on that go on with the same service.
std::size_t end_of_service(const ActionSequence& actions, std::size_t index) {
  const auto goes_on = [&](std::size_t next) {
    return actions[next].type == Action::Type::wait && actions[next].goal == actions[index].goal;
  };
  std::size_t last = index;
  while (last + 1 < actions.size() && goes_on(last + 1)) ++last;
  return last;
}

}  // namespace

void append(ActionSequence& actions, const ActionSequence& following) {
  double late = 0.0;
  for (Action next : following) {
    const double end = actions.empty() ? 0.0 : actions.back().t_end;
    next.t_start += late;
    next.t_end += late;
    if (end > next.t_start) {
      const double later = end - next.t_start;
      next.t_end += later;
      late += later;
    }
    const bool waits = next.type == Action::Type::wait && !next.goal;
    if (end < next.t_start - kDone && !waits) {
      actions.push_back({Action::Type::wait, end, next.t_start, next.from, next.from});
    } else {
      next.t_start = end;
    }
    next.t_end = std::max(next.t_start, next.t_end);  // an action of an invalid plan may end before it begins
    actions.push_back(next);
  }
}

Pose pose_at(const Action& action, double t) {
  const double duration = action.t_end - action.t_start;
  double left = duration > 0.0 ? std::clamp((action.t_end - t) / duration, 0.0, 1.0) : 0.0;
  if (action.profile) left = 1.0 - share_at(action, t);
  if (left == 1.0) return action.from;
  Pose pose = action.to;
  if (action.type == Action::Type::translate) {
    pose.position -= left * (action.to.position - action.from.position);
  } else if (action.type == Action::Type::rotate) {
    pose.theta = normalize_angle(action.to.theta - left * turn(action));
  }
  return pose;
}

TimedProgress planned_progress(const ActionSequence& actions, double at) {
  std::size_t index = 0;
  const auto is_done = [&](const Action& action) {
    return action.t_end <= at + kDone || (at > action.t_start && left_of(action, at) < kLeastAction);
  };
  while (index < actions.size() && is_done(actions[index])) ++index;
  return {index, at};
}

std::optional<TimedProgress> measured_progress(const Robot& robot, const ActionSequence& actions,
                                               const Pose& pose, double at, double tolerance) {
  std::size_t index = planned_progress(actions, at).action;
  if (index == actions.size()) {
    const Pose end = actions.empty() ? robot.start : actions.back().to;
    if (is_near(end, pose, tolerance)) return TimedProgress{index, at};
  } else {
    ++index;
  }
  while (index-- > 0) {
    if (const auto t = time_of(actions[index], pose, at, tolerance)) return TimedProgress{index, *t};
  }
  return std::nullopt;
}

TimedProgress reported_progress(const ActionSequence& actions, const ReportedState& reported) {
  const auto [action, fraction] = reported.place;
  if (!reported.service_left) return {action, time_at_share(actions[action], fraction)};
  const double begin = actions[action].t_start;
  return {action, *reported.service_left > kDone ? begin : actions[end_of_service(actions, action)].t_end};
}

Pose pose_of(const ActionSequence& actions, const ReportedState& reported) {
  return pose_at(actions[reported.place.action], reported_progress(actions, reported).t);
}

bool is_near(const Pose& pose, const Pose& other, double tolerance) {
  return (pose.position - other.position).norm() <= tolerance &&
         angle_between(pose.theta, other.theta) <= tolerance;
}

Pose planned_pose(const Robot& robot, const ActionSequence& actions, double at) {
  const std::size_t under_way = planned_progress(actions, at).action;
  if (under_way < actions.size()) return pose_at(actions[under_way], at);
  return actions.empty() ? robot.start : actions.back().to;
}

Remainder remainder(const Robot& robot, const ActionSequence& actions, double at) {
  const std::size_t under_way = planned_progress(actions, at).action;
  Remainder rest{planned_pose(robot, actions, at), {}};
  if (under_way == actions.size()) return rest;
  const Action& planned = actions[under_way];
  Action action = part_from(planned, std::max(at, planned.t_start));
  // Hardly anything of the previous action is left, so it is done. This action begins, unless the robot stood
  // in between.
  const bool begins_later =
      at < planned.t_start && under_way > 0 && !goes_on(actions[under_way - 1], planned);
  if (begins_later && planned.type != Action::Type::wait && planned.t_start - at >= kLeastAction) {
    rest.actions.push_back({Action::Type::wait, 0.0, planned.t_start - at, rest.start, rest.start});
  }
  action.t_start = rest.actions.empty() ? 0.0 : rest.actions.back().t_end;
  action.t_end -= at;
  action.from = rest.start;
  rest.actions.push_back(action);
  append(rest.actions, shifted(actions, under_way + 1, at));
  return rest;
}

Remainder remainder_of_measured(const Robot& robot, const ActionSequence& actions, const Pose& pose,
                                const TimedProgress& progress, double at, std::optional<double> speed) {
  if (progress.action == actions.size()) return remainder(robot, actions, at);
  const Action& planned = actions[progress.action];
  return continued_from(robot, actions, progress.action, pose, shifted(actions, progress.action + 1, at),
                        std::max(0.0, planned.t_end - at), speed_of(planned, progress.t, speed));
}

Remainder remainder_of_reported(const Robot& robot, const Execution& execution, const TimedProgress& progress,
                                double at) {
  const ActionSequence& actions = execution.actions;
  const Action& planned = actions[progress.action];
  const auto& service_left = execution.reported->service_left;
  const std::size_t last = service_left ? end_of_service(actions, progress.action) : progress.action;
  return continued_from(
      robot, actions, progress.action, execution.measured.value_or(pose_at(planned, progress.t)),
      shifted(actions, last + 1, at), wait_left(robot, planned, progress.t, service_left, at),
      speed_of(planned, progress.t, execution.speed));
}

bool goes_on(const Action& action, const Action& next) {
  return action.type == Action::Type::translate && next.type == Action::Type::translate &&
         action.reverse == next.reverse && next.t_start <= action.t_end + kDone &&
         angle_between(action.to.theta, next.from.theta) <= kSameLine;
}

ActionSequence driven_until(const ActionSequence& actions, double metres) {
  ActionSequence driven;
  for (const Action& action : actions) {
    const bool is_next =
        driven.empty() ? action.type == Action::Type::translate : goes_on(driven.back(), action);
    if (!is_next || metres <= kReached) break;
    const double whole = amount_of(action);
    const double share = whole > metres ? metres / whole : 1.0;
    metres -= whole;
    driven.push_back(action);
    if (share == 1.0) continue;
    driven.back().t_end = time_at_share(action, share);
    driven.back().to = pose_at(action, driven.back().t_end);
  }
  return driven;
}

ActionSequence split_at(const ActionSequence& actions, double t) {
  return resumed_after(stopped_by(actions, t), actions);
}

void hold(Remainder& rest, double from, double until) {
  if (until < from) return;
  ActionSequence& actions = rest.actions;
  actions = split_at(actions, from);
  std::size_t first = 0;
  while (first < actions.size() && actions[first].t_start < from - kDone) ++first;
  const Pose pose = first == 0 ? rest.start : actions[first - 1].to;
  const auto is_wait = [&](std::size_t index, bool serves) {
    return index < actions.size() && actions[index].type == Action::Type::wait &&
           actions[index].goal.has_value() == serves;
  };
  std::size_t served = first;  // behind the waits for the service under way
  while (is_wait(served, true)) ++served;
  const std::size_t next = is_wait(served, false) ? served + 1 : served;
  const double service_end = served == first ? from : actions[served - 1].t_end;
  const double stand_end = next == first ? from : actions[next - 1].t_end;
  // The rest of a wait after a service gives way to the hold. It may be left from an earlier hold.
  const double end = std::max({until, service_end, served == first ? stand_end : from});
  delay(actions, next, end - stand_end);
  const auto at = [&](std::size_t index) { return actions.begin() + static_cast<std::ptrdiff_t>(index); };
  actions.erase(at(served), at(next));
  if (end > service_end + kDone) {
    actions.insert(at(served), {Action::Type::wait, service_end, end, pose, pose});
  }
  actions = split_at(actions, until);
}

}  // namespace fleetplan::core
