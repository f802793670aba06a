#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "api/advance/advance.h"
#include "core/execution/executed_actions.h"

namespace fleetplan::api {

namespace {

using core::Action;
using core::ActionPlace;
using Actions = std::vector<Action>;

/// The place, at an end of its action if that is nearer than rounding (seconds).
ActionPlace at_end(const Actions& actions, ActionPlace place) {
  constexpr double kRounding = 1e-9;
  const double duration = actions[place.action].t_end - actions[place.action].t_start;
  if (place.fraction * duration <= kRounding) {
    place.fraction = 0.0;
  } else if ((1.0 - place.fraction) * duration <= kRounding) {
    place.fraction = 1.0;
  }
  return place;
}

/// The actions before a place, of which the one under way there is cut. The robot stands there.
Actions before_place(const Actions& actions, const ActionPlace& place) {
  const auto index = static_cast<std::ptrdiff_t>(place.action);
  Actions before(actions.begin(), actions.begin() + index);
  if (place.fraction > 0.0) {
    const Action& part = actions[place.action];
    before.push_back(part_until(part, core::time_at_share(part, place.fraction)));
  }
  return at_rest_in_the_end(std::move(before));
}

/// Lets the first actions begin at rest, if they were planned to be under way.
void start_at_rest(Actions& actions) {
  if (actions.empty() || !actions.front().profile || actions.front().profile->start <= 0.0) return;
  const auto end = actions.begin() + static_cast<std::ptrdiff_t>(end_of_chain(actions, 0));
  const Actions chain = driven_from(Actions(actions.begin(), end), actions.front().t_start, 0.0);
  std::copy(chain.begin(), chain.end(), actions.begin());
}

/// The actions after a place, as many seconds earlier.
Actions after_place(const Actions& actions, const ActionPlace& place, double earlier) {
  const Actions before = before_place(actions, place);
  Actions after = resumed_after(before, actions);
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
  Waits(const core::Robot& robot, const Actions& actions, double wait_before_move)
      : robot_(robot), actions_(actions), purposes_(core::wait_purposes(robot, actions, wait_before_move)) {}

  /// Whether the action is a wait that only gives way to others.
  bool gives_way(std::size_t index) const {
    const Action& action = actions_[index];
    const bool serves = action.goal && *action.goal < robot_.goal_count();
    return action.type == Action::Type::wait && !serves && purposes_[index].least <= 0.0;
  }

  /// Seconds that the action takes at least. A wait until its goal may be served takes as long as planned.
  double duration(std::size_t index, const Action& part) const {
    const double planned = part.t_end - part.t_start;
    if (part.type != Action::Type::wait || purposes_[index].not_before > 0.0) return planned;
    return std::min(planned, purposes_[index].least);
  }

 private:
  const core::Robot& robot_;
  const Actions& actions_;
  std::vector<core::WaitPurpose> purposes_;
};

/// Moves the actions from an index on together, without waits that give way, so that they end at `t_end`.
void pack(Actions& actions, std::size_t first, const Waits& waits, double t_end) {
  Actions packed;
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

}  // namespace

ReleasedRest released_rest(const core::Robot& robot, const Execution& execution, const Moment& moment) {
  const ActionPlace released = at_end(execution.actions, *execution.reported->released);
  const Waits waits(robot, execution.actions, moment.wait_before_move);
  Execution until = execution;
  ActionPlace& place = until.reported->place;
  while (place.action < released.action && waits.gives_way(place.action)) place = {place.action + 1, 0.0};
  until.actions = before_place(execution.actions, released);
  const bool is_cut = place.action == released.action && released.fraction > 0.0;
  if (is_cut) place.fraction = std::min(1.0, place.fraction / released.fraction);
  Actions after = after_place(execution.actions, released, moment.at);
  if (place.action >= until.actions.size()) {
    // It stands where it may stand, wherever it was measured.
    const Action& next = execution.actions[place.action];
    return {{pose_at(next, next.t_start), {}}, std::move(after)};
  }
  pack(until.actions, place.action + 1, waits, moment.at);  // late, so that they follow each other
  const TimedProgress progress = reported_progress(until.actions, *until.reported);
  return {remainder_of_reported(robot, until, progress, moment.at), std::move(after)};
}

}  // namespace fleetplan::api
