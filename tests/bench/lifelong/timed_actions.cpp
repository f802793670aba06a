#include "tests/bench/lifelong/timed_actions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/position.h"

namespace fleetplan::bench {
namespace {

using core::Action;
using core::Pose;

/// Seconds, metres and radians: what remains of rounding after many cuts.
constexpr double kSame = 1e-6;

Pose pose_during(const Action& action, double t) {
  if (t <= action.t_start) return action.from;
  if (t >= action.t_end) return action.to;
  const double share = (t - action.t_start) / (action.t_end - action.t_start);
  const Pose& from = action.from;
  const Pose& to = action.to;
  const double turn = core::rotation_between(from.theta, to.theta);
  return {from.position + share * (to.position - from.position),
          core::normalize_angle(from.theta + share * turn)};
}

bool same_pose(const Pose& a, const Pose& b) {
  return (a.position - b.position).norm() < kSame && core::angle_between(a.theta, b.theta) < kSame;
}

/// Whether `next` continues `action` at the same speed.
bool continues(const Action& action, const Action& next) {
  if (action.type != next.type || next.t_start - action.t_end > kSame) return false;
  Action both = action;
  both.t_end = next.t_end;
  both.to = next.to;
  return same_pose(pose_during(both, action.t_end), action.to);
}

/// The rotations and translations, each in one piece.
Actions moves_of(const Actions& actions) {
  Actions moves;
  for (const Action& action : actions) {
    if (action.type == Action::Type::wait || action.t_end - action.t_start < kSame) continue;
    if (!moves.empty() && continues(moves.back(), action)) {
      moves.back().t_end = action.t_end;
      moves.back().to = action.to;
    } else {
      moves.push_back(action);
    }
  }
  return moves;
}

Action wait(const Pose& pose, double from, double to) {
  return {Action::Type::wait, from, to, pose, pose, {}};
}

}  // namespace

Pose pose_at(const Actions& actions, double t, const Pose& rest) {
  if (actions.empty()) return rest;
  for (const Action& action : actions) {
    if (t < action.t_end) return pose_during(action, t);
  }
  return actions.back().to;
}

CutActions cut(const Actions& actions, double t) {
  CutActions parts;
  for (const Action& action : actions) {
    if (action.t_end <= t) {
      parts.before.push_back(action);
    } else if (action.t_start >= t) {
      parts.after.push_back(action);
    } else {
      const Pose there = pose_during(action, t);
      parts.before.push_back(action);
      parts.before.back().t_end = t;
      parts.before.back().to = there;
      parts.after.push_back(action);
      parts.after.back().t_start = t;
      parts.after.back().from = there;
    }
  }
  return parts;
}

Actions shifted(Actions actions, double seconds) {
  for (Action& action : actions) {
    action.t_start += seconds;
    action.t_end += seconds;
  }
  return actions;
}

Actions waiting_until(Actions actions, double t, double begin, const Pose& rest) {
  const double end = actions.empty() ? begin : actions.back().t_end;
  const Pose there = actions.empty() ? rest : actions.back().to;
  if (end < t) actions.push_back(wait(there, end, t));
  return actions;
}

Actions paused(const Actions& actions, double t, double seconds) {
  auto [before, after] = cut(actions, t);
  if (after.empty()) return actions;
  before.push_back(wait(after.front().from, after.front().t_start, after.front().t_start + seconds));
  after = shifted(std::move(after), seconds);
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

double moving_time(const Actions& actions, double from, double to) {
  double sum = 0.0;
  for (const Action& action : actions) {
    if (action.type == Action::Type::wait) continue;
    sum += std::max(0.0, std::min(to, action.t_end) - std::max(from, action.t_start));
  }
  return sum;
}

bool same_motion(const Actions& a, const Actions& b) {
  const Actions moves = moves_of(a);
  const Actions others = moves_of(b);
  return std::equal(moves.begin(), moves.end(), others.begin(), others.end(),
                    [](const Action& one, const Action& other) {
                      return one.type == other.type && std::abs(one.t_start - other.t_start) < kSame &&
                             std::abs(one.t_end - other.t_end) < kSame && same_pose(one.from, other.from) &&
                             same_pose(one.to, other.to);
                    });
}

}  // namespace fleetplan::bench
