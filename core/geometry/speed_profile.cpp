#include "core/geometry/speed_profile.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

namespace {

/// The fastest profile between two speeds that the length allows.
SpeedProfile between(double start, double end, const LimitedPart& part, const Inertia& inertia) {
  SpeedProfile profile{start, part.limit, end, inertia};
  const double inverse = inertia.rise + inertia.fall;
  if (inverse > 0.0) {
    const double square =
        (2.0 * part.length + start * start * inertia.rise + end * end * inertia.fall) / inverse;
    profile.cruise = std::max({start, end, std::min(part.limit, std::sqrt(square))});
  }
  return profile;
}

/// The speed after a change over this length, at most.
double reached(double speed, double length, double inverse_acceleration, double limit) {
  if (inverse_acceleration <= 0.0) return limit;
  return std::min(limit, std::sqrt(speed * speed + 2.0 * std::max(0.0, length) / inverse_acceleration));
}

}  // namespace

std::vector<SpeedProfile> fastest_profiles(const std::vector<LimitedPart>& parts, const Inertia& inertia,
                                           double start_speed) {
  const std::size_t count = parts.size();
  // The speed between two parts: what both allow, what can be reached from behind, and what can be lost
  // ahead.
  std::vector<double> speeds(count + 1, 0.0);
  speeds[0] = start_speed > 0.0 ? std::min(start_speed, parts.front().limit) : 0.0;
  for (std::size_t k = 1; k < count; ++k) {
    const double limit = std::min({parts[k - 1].limit, parts[k - 1].end_limit, parts[k].limit});
    speeds[k] = reached(speeds[k - 1], parts[k - 1].length, inertia.rise, limit);
  }
  for (std::size_t k = count; k-- > 0;) {
    speeds[k] = reached(speeds[k + 1], parts[k].length, inertia.fall, speeds[k]);
  }
  std::vector<SpeedProfile> profiles;
  profiles.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    profiles.push_back(between(speeds[k], speeds[k + 1], parts[k], inertia));
  }
  return profiles;
}

SpeedProfile fastest_profile(double distance, double speed, const Inertia& inertia) {
  return between(0.0, 0.0, {distance, speed}, inertia);
}

double duration(const SpeedProfile& profile, double distance) {
  const double cruised = std::max(0.0, distance - profile.rise_length() - profile.fall_length());
  return profile.rise_time() + profile.fall_time() + cruised / profile.cruise;
}

double speed_after(const SpeedProfile& profile, double duration, double t) {
  if (t <= 0.0) return profile.start;
  const double left = duration - t;
  if (t < profile.rise_time()) return std::min(profile.cruise, profile.start + t / profile.inertia.rise);
  if (left < profile.fall_time()) return std::min(profile.cruise, profile.end + left / profile.inertia.fall);
  return profile.cruise;
}

double covered_after(const SpeedProfile& profile, double duration, double t) {
  const double rise = std::min(t, profile.rise_time());
  const double fall = std::max(0.0, t - (duration - profile.fall_time()));
  double covered = profile.cruise * std::max(0.0, t - rise - fall);
  if (rise > 0.0) covered += rise * (profile.start + 0.5 * rise / profile.inertia.rise);
  if (fall > 0.0) covered += fall * (profile.cruise - 0.5 * fall / profile.inertia.fall);
  return covered;
}

double elapsed_at(const SpeedProfile& profile, double duration, double distance) {
  // Each phase begins at a speed u and gains b per second: distance = u t + b t^2 / 2.
  const auto elapsed = [](double speed, double gain, double way) {
    const double root = std::sqrt(std::max(0.0, speed * speed + 2.0 * gain * way));
    return speed + root > 0.0 ? 2.0 * way / (speed + root) : 0.0;
  };
  const double rise = profile.rise_length();
  const double cruise = covered_after(profile, duration, duration - profile.fall_time());
  if (distance < rise) return elapsed(profile.start, 1.0 / profile.inertia.rise, std::max(0.0, distance));
  if (distance <= cruise) return profile.rise_time() + (distance - rise) / profile.cruise;
  if (profile.fall_time() <= 0.0) return duration;
  const double falling = elapsed(profile.cruise, -1.0 / profile.inertia.fall, distance - cruise);
  return std::min(duration, duration - profile.fall_time() + falling);
}

double fastest_between(const SpeedProfile& profile, double first, double last, double length) {
  return std::min(reached(profile.start, last, profile.inertia.rise, profile.cruise),
                  reached(profile.end, length - first, profile.inertia.fall, profile.cruise));
}

std::vector<TimedSegment> phases(const TimedSegment& move, const SpeedProfile& profile) {
  const double length = move.path.length();
  const double rise = profile.rise_time() > kSameTime ? profile.rise_time() : 0.0;
  const double fall = profile.fall_time() > kSameTime ? profile.fall_time() : 0.0;
  const double first = 0.5 * (profile.start + profile.cruise) * rise / length;
  const double last = 1.0 - 0.5 * (profile.cruise + profile.end) * fall / length;
  const double t_cruise = move.t_start + rise;
  const double t_fall = move.t_end - fall;
  const bool cruises = t_fall - t_cruise > kSameTime;
  std::vector<TimedSegment> parts;
  /// Adds a part that ends after this share of the way, the last one at its end.
  const auto add = [&](double share, double t_end, bool is_last, double from_speed, double to_speed) {
    const Position from = parts.empty() ? move.path.from : parts.back().path.to;
    const double t_start = parts.empty() ? move.t_start : parts.back().t_end;
    const double ramp = from_speed == to_speed ? 0.0 : (to_speed - from_speed) / (to_speed + from_speed);
    if (is_last) {
      parts.push_back({{from, move.path.to}, t_start, move.t_end, ramp});
    } else {
      parts.push_back({{from, move.path.at(share)}, t_start, t_end, ramp});
    }
  };
  const bool falls = fall > 0.0;
  if (rise > 0.0) add(first, cruises ? t_cruise : t_fall, !cruises && !falls, profile.start, profile.cruise);
  if (cruises) add(last, t_fall, !falls, profile.cruise, profile.cruise);
  if (falls) add(1.0, move.t_end, true, profile.cruise, profile.end);
  if (parts.empty()) parts.push_back(move);
  return parts;
}

}  // namespace fleetplan::core
