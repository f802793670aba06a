#include "core/advance/released.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/advance/inertia.h"
#include "core/advance/timeline.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

namespace {

/// The place, at an end of its action if that is nearer than rounding (seconds).
ActionPlace at_end(const ActionSequence& actions, ActionPlace place) {
  constexpr double kRounding = 1e-9;
  const double duration = actions[place.action].t_end - actions[place.action].t_start;
  if (place.fraction * duration <= kRounding) {
    place.fraction = 0.0;
  } else if ((1.0 - place.fraction) * duration <= kRounding) {
    place.fraction = 1.0;
  }
  return place;
}

/// The actions before a place. An action under way there is cut, and the robot stands there.
ActionSequence before_place(const ActionSequence& actions, const ActionPlace& place) {
  const auto index = static_cast<std::ptrdiff_t>(place.action);
  ActionSequence before(actions.begin(), actions.begin() + index);
  if (place.fraction > 0.0) {
    const Action& part = actions[place.action];
    before.push_back(part_until(part, time_at_share(part, place.fraction)));
  }
  return at_rest_in_the_end(std::move(before));
}

/// Lets the first actions begin at rest, if they were planned to be under way.
void start_at_rest(ActionSequence& actions) {
  if (actions.empty() || !actions.front().profile || actions.front().profile->start <= 0.0) return;
  const auto end = actions.begin() + static_cast<std::ptrdiff_t>(end_of_chain(actions, 0));
  const ActionSequence chain =
      driven_from(ActionSequence(actions.begin(), end), actions.front().t_start, 0.0);
  std::copy(chain.begin(), chain.end(), actions.begin());
}

/// The actions after a place, as many seconds earlier.
ActionSequence after_place(const ActionSequence& actions, const ActionPlace& place, double earlier) {
  const ActionSequence before = before_place(actions, place);
  ActionSequence after = resumed_after(before, actions);
  after.erase(after.begin(), after.begin() + static_cast<std::ptrdiff_t>(before.size()));
  start_at_rest(after);
  for (Action& action : after) {
    action.t_start -= earlier;
    action.t_end -= earlier;
  }
  return after;
}

/// What the waits of a robot are for.
class Waits {
 public:
  Waits(const Robot& robot, const ActionSequence& actions, double wait_before_move)
      : robot_(robot), actions_(actions), purposes_(wait_purposes(robot, actions, wait_before_move)) {}

  /// Whether the action is a wait that only gives way to others.
  bool gives_way(std::size_t index) const {
    const Action& action = actions_[index];
    const bool serves = action.goal && *action.goal < robot_.goal_count();
    return action.type == Action::Type::wait && !serves && purposes_[index].least <= 0.0;
  }

  /// Seconds that the action takes at least. A wait may begin before its goal can be served.
  double duration(std::size_t index, const Action& part) const {
    const double planned = part.t_end - part.t_start;
    if (part.type != Action::Type::wait) return planned;
    return std::min(planned, std::max(purposes_[index].least, kShortestWait));
  }

 private:
  const Robot& robot_;
  const ActionSequence& actions_;
  std::vector<WaitPurpose> purposes_;
};

/// Moves the actions from an index on together, without waits that give way, so that they end at `t_end`.
void pack(ActionSequence& actions, std::size_t first, const Waits& waits, double t_end) {
  ActionSequence packed;
  double now = 0.0;
  for (std::size_t k = first; k < actions.size(); ++k) {
    if (waits.gives_way(k)) continue;
    Action next = actions[k];
    next.t_start = now;
    next.t_end = now = now + waits.duration(k, actions[k]);
    packed.push_back(next);
  }
  actions.resize(std::min(first, actions.size()));
  for (Action& action : packed) {
    action.t_start += t_end - now;
    action.t_end += t_end - now;
    actions.push_back(action);
  }
}

/// Whether a wait is released in part.
bool is_cut_wait(const ActionSequence& actions, const ActionPlace& place) {
  return actions[place.action].type == Action::Type::wait && place.fraction > 0.0 && place.fraction < 1.0;
}

/// Lets the waits for goals among the actions from `first` to `end` last until these have been served. The
/// clock of the actions is `at` at their beginning.
void serve_in_time(const Robot& robot, ActionSequence& actions, std::size_t first, std::size_t end,
                   double at) {
  double late = 0.0;
  for (std::size_t k = first; k < actions.size(); ++k) {
    Action& action = actions[k];
    action.t_start += late;
    action.t_end += late;
    const bool serves = action.goal && *action.goal < robot.goal_count();
    if (action.type != Action::Type::wait || !serves || k >= end) continue;
    const double begin = std::max(action.t_start, robot.goal_at(*action.goal).not_before - at);
    const double later = begin - action.t_start;
    action.t_end += later;
    late += later;
  }
}

}  // namespace

ReleasedRest released_rest(const Robot& robot, const Execution& execution, const Moment& moment) {
  const ActionPlace released = at_end(execution.actions, *execution.reported->released);
  const Waits waits(robot, execution.actions, moment.wait_before_move);
  Execution until = execution;
  ActionPlace& place = until.reported->place;
  while (place.action < released.action && waits.gives_way(place.action)) place = {place.action + 1, 0.0};
  until.actions = before_place(execution.actions, released);
  const bool is_cut = place.action == released.action && released.fraction > 0.0;
  if (is_cut) place.fraction = std::min(1.0, place.fraction / released.fraction);
  ActionSequence after = after_place(execution.actions, released, moment.at);
  if (place.action >= until.actions.size()) {
    // It stands where it may stand, wherever it was measured.
    const Action& next = execution.actions[place.action];
    return {{pose_at(next, next.t_start), {}}, std::move(after)};
  }
  pack(until.actions, place.action + 1, waits, moment.at);  // late, so that they follow each other
  const TimedProgress progress = reported_progress(until.actions, *until.reported);
  Remainder rest = remainder_of_reported(robot, until, progress, moment.at);
  // The wait under way already takes only what is left of it. If it is cut, it is only released so far.
  const std::size_t begins = until.actions[place.action].type == Action::Type::wait ? 1 : 0;
  const bool ends_in_wait = is_cut_wait(execution.actions, released);
  if (rest.actions.size() > begins) {
    serve_in_time(robot, rest.actions, begins, rest.actions.size() - (ends_in_wait ? 1 : 0), moment.at);
  }
  return {std::move(rest), std::move(after)};
}

}  // namespace fleetplan::core
