#include "core/model/action.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// How much of the action's amount its profile covers in so many seconds, as a share.
double share_of_profile(const Action& action, double amount, double seconds) {
  const double duration = action.t_end - action.t_start;
  const double covered = covered_after(*action.profile, duration, std::clamp(seconds, 0.0, duration));
  return std::clamp(covered / amount, 0.0, 1.0);
}

}  // namespace

double amount_of(const Action& action) {
  return action.type == Action::Type::rotate ? angle_between(action.from.theta, action.to.theta)
                                             : (action.to.position - action.from.position).norm();
}

double covered_by_profile(const Action& action) {
  const SpeedProfile& profile = *action.profile;
  const double cruises = action.t_end - action.t_start - profile.rise_time() - profile.fall_time();
  return profile.rise_length() + profile.cruise * cruises + profile.fall_length();
}

bool profile_fits(const Action& action) {
  const SpeedProfile& profile = *action.profile;
  if (!profile.is_possible()) return false;
  const double duration = action.t_end - action.t_start;
  return duration >= profile.rise_time() + profile.fall_time() - kContactTolerance &&
         std::abs(covered_by_profile(action) - amount_of(action)) <=
             kContactTolerance * (1.0 + profile.cruise);
}

double share_covered(const Action& action, double elapsed) {
  const double amount = action.profile ? amount_of(action) : 0.0;
  if (amount <= 0.0) return elapsed;
  return share_of_profile(action, amount, elapsed * (action.t_end - action.t_start));
}

double share_at(const Action& action, double t) {
  const double duration = action.t_end - action.t_start;
  if (duration <= 0.0) return 1.0;
  const double amount = action.profile ? amount_of(action) : 0.0;
  if (amount <= 0.0) return std::clamp((t - action.t_start) / duration, 0.0, 1.0);
  return share_of_profile(action, amount, t - action.t_start);
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
