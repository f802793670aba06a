#include "core/model/action.h"

#include <fleetplan/action.h>

#include <algorithm>

#include "core/geometry/angle.h"
#include "library/convert.h"

namespace fleetplan {

Pose pose_at(std::span<const Action> actions, const Pose& start, double t) {
  if (actions.empty() || t <= actions.front().t_start) return start;
  const auto next = std::upper_bound(actions.begin(), actions.end(), t,
                                     [](double time, const Action& action) { return time < action.t_start; });
  const Action& action = *(next - 1);
  if (t >= action.t_end) return action.to;
  const double fraction = core::share_at(library::Frame().to_core(action), t);
  const double turn = core::rotation_between(action.from.theta, action.to.theta);
  return {action.from.x + fraction * (action.to.x - action.from.x),
          action.from.y + fraction * (action.to.y - action.from.y),
          core::normalize_angle(action.from.theta + fraction * turn)};
}

}  // namespace fleetplan
