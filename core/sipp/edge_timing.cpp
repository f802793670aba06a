#include "core/sipp/edge_timing.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fleetplan::core {
namespace {

/// The earliest departure of a move of several pieces, which follow each other without a stop.
std::optional<double> departure_of(const std::vector<DriveZones::Piece>& pieces,
                                   const ReservationTable& table, std::size_t robot, double t_min,
                                   double t_max, double narrower) {
  double t = t_min;
  for (std::size_t k = 0; k < pieces.size();) {
    const auto& [path, speed, begin, end] = pieces[k];
    const auto earliest =
        table.earliest_departure(robot, path, end - begin, t + begin, t_max + begin, narrower);
    if (!earliest) return std::nullopt;
    if (*earliest <= t + begin) {
      ++k;
      continue;
    }
    // Later: then the pieces before it may meet others.
    t = std::max(*earliest - begin, std::nextafter(t, kForever));
    if (t > t_max) return std::nullopt;
    k = 0;
  }
  return t;
}

}  // namespace

std::optional<double> EdgeTiming::earliest(const Move& move, const Segment& path, const SafeInterval& target,
                                           double narrower) const {
  const double latest = std::min(move.latest, target.end - move.duration);
  if (may_continue(move, target, latest)) {
    const auto at_once = departure(path, move.duration, move.arrival, move.arrival, narrower);
    if (at_once) return at_once;
  }
  const double begin = std::max(move.ready, target.begin - move.duration);
  if (begin > latest) return std::nullopt;
  return departure(path, move.duration, begin, latest, narrower);
}

std::optional<double> EdgeTiming::departure(const Segment& path, double duration, double t_min, double t_max,
                                            double narrower) const {
  if (zones_ != nullptr && zones_->limit_speeds()) {
    const std::vector<DriveZones::Piece> pieces = zones_->pieces(path.from, path.to);
    if (pieces.size() > 1) return departure_of(pieces, table_, robot_, t_min, t_max, narrower);
  }
  return table_.earliest_departure(robot_, path, duration, t_min, t_max, narrower);
}

}  // namespace fleetplan::core
