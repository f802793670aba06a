#include "core/sipp/moves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/model/drive_zones.h"

namespace fleetplan::core {

std::vector<TimedSegment> parts_of(const std::vector<DriveZones::Piece>& pieces) {
  std::vector<TimedSegment> parts;
  // Bounded: the pieces of one move, and at most three phases of each.
  for (const DriveZones::Piece& piece : pieces) {
    const TimedSegment move{piece.path, piece.begin, piece.end};
    if (!piece.profile) {
      parts.push_back(move);
      continue;
    }
    for (const TimedSegment& phase : phases(move, *piece.profile)) parts.push_back(phase);
  }
  return parts;
}

namespace {

/// The earliest departure of a move of several parts, which follow each other without a stop.
std::optional<double> departure_of(const ReservationTable& table, const std::vector<TimedSegment>& parts,
                                   double t_min, double t_max, const Footprint& footprint) {
  double t = t_min;
  for (std::size_t k = 0; k < parts.size();) {
    const auto& [path, begin, end, ramp] = parts[k];
    const auto earliest =
        table.earliest_departure(footprint, path, end - begin, t + begin, t_max + begin, ramp);
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

std::optional<double> earliest_departure(const ReservationTable& table, const Footprint& footprint,
                                         const MoveTimes& times, const Segment& way, double duration,
                                         double t_min, double t_max) {
  if (times.have_parts()) {
    const std::vector<TimedSegment> parts = parts_of(times.pieces(way));
    if (parts.size() > 1 || parts.front().ramp != 0.0) {
      return departure_of(table, parts, t_min, t_max, footprint);
    }
  }
  return table.earliest_departure(footprint, way, duration, t_min, t_max);
}

std::vector<TimedMove> timed_moves(const MoveTimes& times, const Segment& way, double departure,
                                   double arrival, bool reverse) {
  if (!times.have_parts()) return {{{way, departure, arrival}, {}, reverse}};
  std::vector<TimedMove> moves;
  const std::vector<DriveZones::Piece> pieces = times.pieces(way);
  for (const DriveZones::Piece& piece : pieces) {
    const double t_end = &piece == &pieces.back() ? arrival : departure + piece.end;
    moves.push_back({{piece.path, departure + piece.begin, t_end}, piece.profile, reverse, !moves.empty()});
  }
  return moves;
}

}  // namespace fleetplan::core
