#include <fleetplan/action.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.h"
#include "core/geometry/speed_profile.h"
#include "library/convert.h"

namespace fleetplan {

namespace {

/// Returns the share of its length or angle that an action has covered at a time within it.
double share_covered(const Action& action, double t) {
  const double duration = action.t_end - action.t_start;
  const double whole = action.type == Action::Type::rotate
                           ? core::angle_between(action.from.theta, action.to.theta)
                           : std::hypot(action.to.x - action.from.x, action.to.y - action.from.y);
  if (!action.profile || whole <= 0.0) return (t - action.t_start) / duration;
  const core::SpeedProfile profile = library::profile_of(*action.profile);
  return std::clamp(core::covered_after(profile, duration, t - action.t_start) / whole, 0.0, 1.0);
}

}  // namespace

Pose pose_at(std::span<const Action> actions, const Pose& start, double t) {
  if (actions.empty() || t <= actions.front().t_start) return start;
  const auto next = std::upper_bound(actions.begin(), actions.end(), t,
                                     [](double time, const Action& action) { return time < action.t_start; });
  const Action& action = *(next - 1);
  if (t >= action.t_end) return action.to;
  const double fraction = share_covered(action, t);
  const double turn = core::rotation_between(action.from.theta, action.to.theta);
  return {action.from.x + fraction * (action.to.x - action.from.x),
          action.from.y + fraction * (action.to.y - action.from.y),
          core::normalize_angle(action.from.theta + fraction * turn)};
}

}  // namespace fleetplan
