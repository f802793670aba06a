#include "core/advance/inertia.h"

// Robots that need time to start and to stop: the parts of their actions, where they stand when they brake,
// and how they go on from there.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/advance/timeline.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

namespace {

/// Times that differ by less are the same (seconds): far above rounding, far below what matters.
constexpr double kRoundedTime = 1e-9;

/// An action that has less left is done (metres or radians).
constexpr double kLeft = kLeastAction;

/// Actions follow each other if no more time is between them (seconds): POST /v1/plan accepts twice as much.
constexpr double kGap = 0.5 * kContactTolerance;

/// Whether the robot goes on at speed after this action.
bool ends_at_speed(const Action& action) { return action.profile && action.profile->end > 0.0; }

/// The first of the actions up to an index that follow each other at speed.
std::size_t begin_of_chain(const ActionSequence& actions, std::size_t index) {
  while (index > 0 && ends_at_speed(actions[index - 1])) --index;
  return index;
}

/// Brakes from the end of the last driven action on. It is a part of the action with this index.
void brake(ActionSequence& driven, const ActionSequence& actions, std::size_t index) {
  for (;; ++index) {
    const Action& planned = actions[index];
    Action& last = driven.back();
    const Inertia& inertia = last.profile->inertia;
    const Position way = planned.to.position - planned.from.position;
    const double whole = way.norm();
    const double covered = (last.to.position - planned.from.position).norm();
    const double speed = last.profile->end;
    const double needed = 0.5 * speed * speed * inertia.fall;
    if (covered + needed <= whole + kLeft || end_of_chain(actions, index) == index + 1) {
      const double share = covered + needed < whole ? (covered + needed) / whole : 1.0;
      last.to.position = share < 1.0 ? Position(planned.from.position + share * way) : planned.to.position;
      last.t_end += speed * inertia.fall;
      last.profile->end = 0.0;
      return;
    }
    const double slower = std::sqrt(std::max(0.0, speed * speed - 2.0 * (whole - covered) / inertia.fall));
    last.to.position = planned.to.position;
    last.t_end += (speed - slower) * inertia.fall;
    last.profile->end = slower;
    Action following = actions[index + 1];
    following.t_start = following.t_end = last.t_end;
    following.to = following.from;
    following.profile->start = following.profile->cruise = following.profile->end = slower;
    driven.push_back(following);
  }
}

/// When a robot that drives these translations, which follow each other at speed, begins to brake to stand at
/// `t`. If that is too late, the begin of the translations.
double brakes_from(const ActionSequence& chain, double t) {
  // A robot that brakes at speed v stands v times `fall` later. While it speeds up or cruises, it stands
  // later the later it brakes. While it slows down, it brakes already.
  for (const Action& action : chain) {
    const SpeedProfile& profile = *action.profile;
    const double braking = profile.cruise * profile.inertia.fall;  // seconds, from the cruise speed
    const double cruises = action.t_start + profile.rise_time();
    const double slows = action.t_end - profile.fall_time();
    if (t < cruises + braking) {
      const double before = (cruises + braking - t) / (1.0 + profile.inertia.fall / profile.inertia.rise);
      return std::max(action.t_start, cruises - before);
    }
    if (t < slows + braking - kSameTime) return t - braking;
  }
  return chain.back().t_end;
}

/// The time at which actions are cut. It is the begin or the end of the action under way if the part on that
/// side is too small for an action. An action with a profile is not cut: the robot brakes.
double cut_time(const ActionSequence& actions, double t) {
  for (const Action& action : actions) {
    if (action.profile || t <= action.t_start || t >= action.t_end) continue;
    if (left_of(action, t) < kLeastAction) return action.t_end;
    const Action done = part_until(action, t);
    const bool waits = action.type == Action::Type::wait;
    if ((waits ? t - action.t_start : amount_of(done)) < kLeastAction) return action.t_start;
  }
  return t;
}

/// The length of the last actions that follow each other at speed.
double length_of_last(const ActionSequence& actions) {
  double length = 0.0;
  for (std::size_t k = begin_of_chain(actions, actions.size() - 1); k < actions.size(); ++k) {
    length += amount_of(actions[k]);
  }
  return length;
}

}  // namespace

double left_of(const Action& action, double t) {
  return action.type == Action::Type::wait ? action.t_end - t : amount_of(part_from(action, t));
}

Action part_until(Action action, double t) {
  const Pose to = pose_at(action, t);
  if (action.profile) {
    const double speed = speed_at(action, t);
    if (t - action.t_start <= action.profile->rise_time()) action.profile->cruise = speed;
    action.profile->end = speed;
  }
  action.to = to;
  action.t_end = t;
  return action;
}

Action part_from(Action action, double t) {
  const Pose from = pose_at(action, t);
  if (action.profile) {
    const double speed = speed_at(action, t);
    if (t > action.t_end - action.profile->fall_time()) action.profile->cruise = speed;
    action.profile->start = speed;
  }
  action.from = from;
  action.t_start = t;
  return action;
}

std::size_t end_of_chain(const ActionSequence& actions, std::size_t first) {
  std::size_t last = first;
  while (last + 1 < actions.size() && ends_at_speed(actions[last]) && actions[last + 1].profile) ++last;
  return last + 1;
}

ActionSequence driven_from(ActionSequence chain, double t, double speed) {
  std::vector<LimitedPart> parts;
  for (const Action& action : chain) parts.push_back({amount_of(action), action.profile->cruise});
  const auto profiles = fastest_profiles(parts, chain.front().profile->inertia, speed);
  for (std::size_t k = 0; k < chain.size(); ++k) {
    chain[k].profile = profiles[k];
    chain[k].t_start = t;
    t += duration(profiles[k], parts[k].length);
    chain[k].t_end = t;
  }
  return chain;
}

ActionSequence at_rest_in_the_end(ActionSequence actions) {
  if (actions.empty() || !ends_at_speed(actions.back())) return actions;
  const auto begin =
      actions.begin() + static_cast<std::ptrdiff_t>(begin_of_chain(actions, actions.size() - 1));
  const ActionSequence chain =
      driven_from(ActionSequence(begin, actions.end()), begin->t_start, begin->profile->start);
  std::copy(chain.begin(), chain.end(), begin);
  return actions;
}

ActionSequence executed_until(const ActionSequence& actions, double t) {
  t = cut_time(actions, t);
  ActionSequence done;
  for (const Action& action : actions) {
    if (action.t_start >= t - kRoundedTime) break;
    done.push_back(action.t_end <= t + kRoundedTime ? action : part_until(action, t));
  }
  return done;
}

ActionSequence braked(const ActionSequence& actions, double t) {
  std::size_t index = 0;
  while (index < actions.size() && actions[index].t_end <= t + kRoundedTime) ++index;
  ActionSequence driven(actions.begin(), actions.begin() + static_cast<std::ptrdiff_t>(index));
  if (index == actions.size() || !actions[index].profile) return driven;
  const Action& under_way = actions[index];
  const bool has_begun = t > under_way.t_start + kRoundedTime;
  if (!has_begun && under_way.profile->start <= 0.0) return driven;
  if (under_way.type == Action::Type::rotate) {  // it takes little time
    driven.push_back(under_way);
    return driven;
  }
  ActionSequence before = driven;
  // A robot that has hardly set out brakes later, so that it drives for more than nothing.
  constexpr double kLater = 1e-6;  // seconds
  for (double later = 0.0; t + later < under_way.t_end; later = std::max(kLater, 2.0 * later)) {
    driven = before;
    driven.push_back(part_until(under_way, std::max(t, under_way.t_start) + later));
    brake(driven, actions, index);
    if (length_of_last(driven) >= kLeastAction) return driven;
    if (under_way.profile->start <= 0.0) return before;
  }
  driven = before;
  driven.push_back(part_until(under_way, std::max(t, under_way.t_start)));
  brake(driven, actions, index);
  return driven;
}

ActionSequence stopped_by(const ActionSequence& actions, double t) {
  t = cut_time(actions, t);
  std::size_t index = 0;
  while (index < actions.size() && actions[index].t_end <= t + kRoundedTime) ++index;
  const bool is_cut = index < actions.size() && actions[index].t_start < t - kRoundedTime;
  const bool is_between = index > 0 && ends_at_speed(actions[index - 1]);
  if (!is_between && !(is_cut && actions[index].profile)) return executed_until(actions, t);
  // The translations that follow each other at speed, from rest or from the begin of the actions.
  const std::size_t first = begin_of_chain(actions, is_between && !is_cut ? index - 1 : index);
  const auto begin = actions.begin() + static_cast<std::ptrdiff_t>(first);
  ActionSequence stopped(actions.begin(), begin);
  const ActionSequence chain(begin,
                             actions.begin() + static_cast<std::ptrdiff_t>(end_of_chain(actions, first)));
  ActionSequence to_rest;
  if (chain.front().type == Action::Type::translate) {
    to_rest = braked(chain, brakes_from(chain, t));
  } else if (chain.front().profile->start > 0.0) {
    to_rest = chain;
  }
  stopped.insert(stopped.end(), to_rest.begin(), to_rest.end());
  return stopped;
}

ActionSequence resumed_after(const ActionSequence& stopped, const ActionSequence& actions) {
  ActionSequence all = stopped;
  if (stopped.empty()) return actions;
  const std::size_t index = stopped.size() - 1;
  const Action& last = stopped.back();
  const Action& planned = actions[index];
  const double left = amount_of(planned) - amount_of(last);
  std::size_t next = index + 1;
  double late = 0.0;
  if (last.profile && (left > kLeft || (planned.profile && planned.profile->end > 0.0))) {
    const std::size_t end = end_of_chain(actions, index);
    ActionSequence chain(actions.begin() + static_cast<std::ptrdiff_t>(index),
                         actions.begin() + static_cast<std::ptrdiff_t>(end));
    chain.front().from = last.to;
    if (left <= kLeft) chain.erase(chain.begin());
    if (!chain.empty()) {
      chain = driven_from(std::move(chain), last.t_end, 0.0);
      late = chain.back().t_end - actions[end - 1].t_end;
      all.insert(all.end(), chain.begin(), chain.end());
    }
    next = end;
  } else if (last.profile && next < actions.size() && planned.t_end - last.t_end > kGap) {
    // It is there already: what follows begins when it was planned to.
    all.push_back({Action::Type::wait, last.t_end, planned.t_end, last.to, last.to});
  } else if (!last.profile && last.t_end < planned.t_end && left_of(planned, last.t_end) >= kLeastAction) {
    Action later = planned;
    later.t_start = last.t_end;
    later.from = last.to;
    all.push_back(later);
  }
  for (std::size_t k = next; k < actions.size(); ++k) {
    all.push_back(actions[k]);
    all.back().t_start += late;
    all.back().t_end += late;
  }
  return all;
}

}  // namespace fleetplan::core
