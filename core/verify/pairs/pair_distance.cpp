#include "core/verify/pairs/pair_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/verify/pairs/common_pieces.h"

namespace fleetplan::core {

double least_distance(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span) {
  double squared = std::numeric_limits<double>::infinity();
  visit_common_pieces(a, b, span, [&](const RelativeMotion& motion) {
    squared = std::min(squared, least_squared_distance(motion));
    return true;
  });
  return std::sqrt(squared);
}

std::optional<TimeSpan> time_together(const std::vector<Leg>& a, const std::vector<Leg>& b, double distance,
                                      double t) {
  std::optional<TimeSpan> together;
  const TimeSpan all_time{0.0, std::numeric_limits<double>::infinity()};
  visit_common_pieces(a, b, all_time, [&](const RelativeMotion& motion) {
    const auto near = span_closer_than(motion, distance);
    if (near) {
      if (together && together->end == near->begin) {
        together->end = near->end;
      } else if (together && together->end >= t) {
        return false;
      } else {
        together = near;
      }
    }
    return motion.t_begin <= t || (together && together->end == motion.t_end);
  });
  if (!together || together->begin > t || together->end < t) return std::nullopt;
  return together;
}

}  // namespace fleetplan::core
