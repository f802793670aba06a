#include "core/model/action.h"

#include <algorithm>

#include "core/geometry/angle.h"

namespace fleetplan::core {

double amount_of(const Action& action) {
  return action.type == Action::Type::rotate ? angle_between(action.from.theta, action.to.theta)
                                             : (action.to.position - action.from.position).norm();
}

double share_at(const Action& action, double t) {
  const double duration = action.t_end - action.t_start;
  if (duration <= 0.0) return 1.0;
  const double amount = action.profile ? amount_of(action) : 0.0;
  double share = (t - action.t_start) / duration;
  if (amount > 0.0) {
    share = covered_after(*action.profile, duration, std::clamp(t - action.t_start, 0.0, duration)) / amount;
  }
  return std::clamp(share, 0.0, 1.0);
}

double time_at_share(const Action& action, double share) {
  const double duration = action.t_end - action.t_start;
  if (!action.profile) return action.t_start + share * duration;
  return action.t_start + elapsed_at(*action.profile, duration, share * amount_of(action));
}

double speed_at(const Action& action, double t) {
  const double duration = action.t_end - action.t_start;
  if (action.profile) return speed_after(*action.profile, duration, t - action.t_start);
  return duration > 0.0 ? amount_of(action) / duration : 0.0;
}

}  // namespace fleetplan::core
