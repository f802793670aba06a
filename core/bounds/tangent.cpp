#include "core/bounds/tangent.h"

#include <array>
#include <numbers>

#include "core/geometry/angle.h"

namespace fleetplan::core {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of headings along an axis (radians): a move grazes a quarter within this of its end.
constexpr double kGrazing = 1e-12;

/// The headings on the bend around the corner.
const Quadrant& quadrant(const Corner& corner, bool left) {
  static constexpr std::array<Quadrant, 4> kQuadrants = {Quadrant{-1.0, -1.0, -0.75 * kPi},
                                                         {1.0, -1.0, -0.25 * kPi},
                                                         {-1.0, 1.0, 0.75 * kPi},
                                                         {1.0, 1.0, 0.25 * kPi}};
  // With the corner on the left, the direction away from the blocked cell is to the right.
  const bool east = left ? corner.away_y < 0 : corner.away_y > 0;
  const bool north = left ? corner.away_x > 0 : corner.away_x < 0;
  return kQuadrants[(north ? 2U : 0U) + (east ? 1U : 0U)];
}

/// The place on the bend at which the disk has this heading.
double angle_on_bend(const TangentEnd& end, double heading) {
  if (end.quadrant == nullptr) return 0.0;
  const double turned = rotation_between(end.quadrant->middle, heading);
  return end.offset > 0.0 ? turned : -turned;
}

}  // namespace

TangentEnd circle_around(const Corner& corner, const Position& center, double offset) {
  return {center, offset, &quadrant(corner, offset > 0.0)};
}

std::optional<Tangent> common_tangent(const TangentEnd& from, const TangentEnd& to) {
  const Position d = to.center - from.center;
  const double across = to.offset - from.offset;
  const double distance = d.norm();
  if (!(distance > std::abs(across))) return std::nullopt;
  const double sine = across / distance;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Position along = Position(d.x() * cosine + d.y() * sine, d.y() * cosine - d.x() * sine) / distance;
  if (!is_heading_of(from, along, kDirectionRounding) || !is_heading_of(to, along, kDirectionRounding)) {
    return std::nullopt;
  }
  Tangent tangent;
  tangent.heading = std::atan2(along.y(), along.x());
  tangent.leave_angle = angle_on_bend(from, tangent.heading);
  tangent.arrive_angle = angle_on_bend(to, tangent.heading);
  const bool grazes_first = std::abs(tangent.leave_angle + 0.25 * kPi) < kGrazing;
  const bool grazes_last = std::abs(tangent.arrive_angle - 0.25 * kPi) < kGrazing;
  if (grazes_first || grazes_last) return std::nullopt;
  tangent.length = distance * cosine;
  const Position left(-along.y(), along.x());
  tangent.begin = from.center - from.offset * left;
  tangent.end = to.center - to.offset * left;
  return tangent;
}

}  // namespace fleetplan::core
