#include "core/verify/geometry/relative_motion.h"

#include <cmath>
#include <limits>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

double cross(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the fraction of the motion, 0 to 1, at which the distance is least.
double closest_fraction(const RelativeMotion& motion) {
  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();
  if (length_squared <= 0.0) return 0.0;
  return std::clamp(-motion.from.dot(d) / length_squared, 0.0, 1.0);
}

double time_at(const RelativeMotion& motion, double fraction) {
  if (fraction <= 0.0) return motion.t_begin;
  if (fraction >= 1.0) return motion.t_end;
  return motion.t_begin + fraction * (motion.t_end - motion.t_begin);
}

}  // namespace

namespace {

/// Fractions of a motion that differ by less are the same: rounding.
constexpr double kLeastFraction = 1e-16;

/// The squared distance of a parabola as a function of the fraction of the motion, 0 to 1.
class Quartic {
 public:
  explicit Quartic(const RelativeMotion& motion)
      : from_(motion.from), slope_(motion.to - motion.from - motion.bend), bend_(motion.bend) {
    // Half the derivative: (from + slope f + bend f^2) . (slope + 2 bend f).
    const double c[4] = {from_.dot(slope_), slope_.squaredNorm() + 2.0 * from_.dot(bend_),
                         3.0 * slope_.dot(bend_), 2.0 * bend_.squaredNorm()};
    const auto derivative = [&c](double f) { return c[0] + f * (c[1] + f * (c[2] + f * c[3])); };
    std::vector<double> borders{0.0};
    for (const double f : roots_of_quadratic(c[1], 2.0 * c[2], 3.0 * c[3])) borders.push_back(f);
    borders.push_back(1.0);
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
      const double first = derivative(borders[k]);
      const double last = derivative(borders[k + 1]);
      if ((first < 0.0) == (last < 0.0)) continue;
      turns_.push_back(bisect(borders[k], borders[k + 1],
                              [&](double f) { return (derivative(f) < 0.0) == (first < 0.0); }));
    }
  }

  double at(double f) const { return (from_ + f * (slope_ + f * bend_)).squaredNorm(); }

  /// Where it is least.
  double argmin() const {
    double best = at(1.0) < at(0.0) ? 1.0 : 0.0;
    for (const double f : turns_) {
      if (at(f) < at(best)) best = f;
    }
    return best;
  }

  /// The first and the last fraction at which it is at most so much, if there is one with less.
  std::optional<TimeSpan> below(double squared) const {
    std::vector<double> borders{0.0};
    borders.insert(borders.end(), turns_.begin(), turns_.end());
    borders.push_back(1.0);
    std::optional<TimeSpan> found;
    for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
      const bool begins = at(borders[k]) < squared;
      const bool ends = at(borders[k + 1]) < squared;
      if (!begins && !ends) continue;
      double first = borders[k];
      double last = borders[k + 1];
      if (begins != ends) {
        const double crossing = bisect(first, last, [&](double f) { return (at(f) < squared) == begins; });
        (begins ? last : first) = crossing;
      }
      found = found ? TimeSpan{found->begin, last} : TimeSpan{first, last};
    }
    return found;
  }

 private:
  /// The roots of a + b f + c f^2 in (0, 1), ascending.
  static std::vector<double> roots_of_quadratic(double a, double b, double c) {
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant <= 0.0) return {};
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    std::vector<double> roots;
    for (const double f : {q / c, a / q}) {
      if (f > 0.0 && f < 1.0) roots.push_back(f);
    }
    std::sort(roots.begin(), roots.end());
    return roots;
  }

  /// The border between where `holds` does, from `first` on, and where it does not, up to `last`.
  template <typename Holds>
  static double bisect(double first, double last, const Holds& holds) {
    while (true) {
      const double middle = 0.5 * (first + last);
      if (middle <= first || middle >= last || last - first < kLeastFraction) return middle;
      (holds(middle) ? first : last) = middle;
    }
  }

  Position from_;
  Position slope_;
  Position bend_;
  std::vector<double> turns_;  // where the derivative changes its sign, ascending
};

}  // namespace

double least_squared_distance(const RelativeMotion& motion) {
  if (motion.bends()) {
    const Quartic distance(motion);
    return distance.at(distance.argmin());
  }
  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();
  if (length_squared <= 0.0) return motion.from.squaredNorm();
  const double progress = -motion.from.dot(d);
  if (progress <= 0.0) return motion.from.squaredNorm();
  if (progress >= length_squared) return motion.to.squaredNorm();
  // The distance to the line from the cross product: unlike |from|^2 - along^2 it has no cancellation.
  const double area = cross(motion.from, d);
  return std::min({area * area / length_squared, motion.from.squaredNorm(), motion.to.squaredNorm()});
}

ClosestMoment closest_moment(const RelativeMotion& motion) {
  const double distance = std::sqrt(least_squared_distance(motion));
  const bool from_the_beginning = motion.from.norm() <= distance + kSamePosition;
  if (!from_the_beginning && motion.bends()) return {time_at(motion, Quartic(motion).argmin()), distance};
  return {from_the_beginning ? motion.t_begin : time_at(motion, closest_fraction(motion)), distance};
}

std::optional<TimeSpan> span_closer_than(const RelativeMotion& motion, double distance) {
  if (distance <= 0.0) return std::nullopt;
  const double squared = distance * distance;
  if (motion.bends()) {
    const auto near = Quartic(motion).below(squared);
    if (!near) return std::nullopt;
    return TimeSpan{time_at(motion, near->begin), time_at(motion, near->end)};
  }
  const bool begins_inside = motion.from.squaredNorm() < squared;
  const bool ends_inside = motion.to.squaredNorm() < squared;
  // The distance is convex in time, so if both ends are inside, all of the motion is.
  if (begins_inside && ends_inside) return TimeSpan{motion.t_begin, motion.t_end};
  const double least = least_squared_distance(motion);
  if (least >= squared) return std::nullopt;

  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();  // > 0, as one end is inside or the middle is nearer
  const double area = cross(motion.from, d);
  const double middle = -motion.from.dot(d) / length_squared;
  const double half = std::sqrt(std::max(0.0, squared - area * area / length_squared) / length_squared);
  const double first = begins_inside ? 0.0 : std::clamp(middle - half, 0.0, 1.0);
  const double last = ends_inside ? 1.0 : std::clamp(middle + half, 0.0, 1.0);
  return TimeSpan{time_at(motion, first), time_at(motion, last)};
}

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

namespace {

/// A pair of times, and the displacement from one body to the other then. The displacement is affine in the
/// times, so pairs of times that form a convex polygon have displacements that form one, too.
struct Corner {
  double s;
  double t;
  Position apart{0.0, 0.0};
};

/// Returns the part of a convex polygon in which `sign * (s - t) <= margin`.
std::vector<Corner> clip(const std::vector<Corner>& polygon, double sign, double margin) {
  std::vector<Corner> kept;
  const auto beyond = [&](const Corner& corner) { return sign * (corner.s - corner.t) - margin; };
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& here = polygon[k];
    const Corner& next = polygon[(k + 1) % polygon.size()];
    const double here_beyond = beyond(here);
    const double next_beyond = beyond(next);
    if (here_beyond <= 0.0) kept.push_back(here);
    if ((here_beyond < 0.0 && next_beyond > 0.0) || (here_beyond > 0.0 && next_beyond < 0.0)) {
      const double part = here_beyond / (here_beyond - next_beyond);
      kept.push_back({here.s + part * (next.s - here.s), here.t + part * (next.t - here.t)});
    }
  }
  return kept;
}

/// The area, as a share of the square of the coordinates, below which a polygon is a line, whose edges have
/// its distances. The turns of a line to or from the origin are rounding (1e-15) and say nothing.
constexpr double kLeastArea = 1e-12;

/// Whether the origin is inside the polygon of displacements.
bool surrounds_origin(const std::vector<Corner>& polygon) {
  bool left = false;
  bool right = false;
  double area = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Position& a = polygon[k].apart;
    const Position& b = polygon[(k + 1) % polygon.size()].apart;
    const double turn = a.x() * b.y() - a.y() * b.x();
    area += turn;
    largest = std::max(largest, a.squaredNorm());
    left = left || turn > 0.0;
    right = right || turn < 0.0;
  }
  return std::abs(area) > kLeastArea * largest && left != right;
}

}  // namespace

namespace {

/// The motion at constant speed between two positions of a leg.
Leg chord_of(const Leg& leg, const TimeSpan& span) {
  if (leg.bend == Position(0.0, 0.0)) return leg;
  return {span.begin, span.end, position_at(leg, span.begin), position_at(leg, span.end)};
}

/// The least distance if the two legs go at constant speed during these spans.
ShiftedMoment least_shifted_distance_of_chords(const Leg& first_leg, const TimeSpan& first,
                                               const Leg& second_leg, const TimeSpan& second, double margin) {
  const Leg a = chord_of(first_leg, first);
  const Leg b = chord_of(second_leg, second);
  std::vector<Corner> polygon{{first.begin, second.begin},
                              {first.end, second.begin},
                              {first.end, second.end},
                              {first.begin, second.end}};
  polygon = clip(clip(polygon, 1.0, margin), -1.0, margin);
  ShiftedMoment nearest{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (Corner& corner : polygon) corner.apart = position_at(b, corner.t) - position_at(a, corner.s);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& from = polygon[k];
    const Corner& to = polygon[(k + 1) % polygon.size()];
    // The edge is passed as a motion whose time is the fraction of the edge.
    const ClosestMoment closest = closest_moment({0.0, 1.0, from.apart, to.apart});
    if (closest.distance >= nearest.distance) continue;
    nearest = {closest.distance, from.s + closest.t * (to.s - from.s), from.t + closest.t * (to.t - from.t)};
  }
  if (surrounds_origin(polygon)) nearest.distance = 0.0;
  return nearest;
}

/// How far a leg is at most, in metres, from where it would be at constant speed during this span.
double sag(const Leg& leg, const TimeSpan& span) {
  return 0.25 * bend_between(leg, span.begin, span.end).norm();
}

}  // namespace

ShiftedMoment least_shifted_distance(const Leg& a, const TimeSpan& first, const Leg& b,
                                     const TimeSpan& second, double margin, double enough) {
  ShiftedMoment nearest = least_shifted_distance_of_chords(a, first, b, second, margin);
  if (sag(a, first) + sag(b, second) <= 0.0) return nearest;
  // Branch and bound: halves of the spans, until their chords decide.
  struct Part {
    TimeSpan first;
    TimeSpan second;
  };
  nearest.distance = std::numeric_limits<double>::infinity();
  std::vector<Part> open{{first, second}};
  // Bounded: each halving makes the deviation from the chords a quarter, down to kSamePosition.
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    const ShiftedMoment chords = least_shifted_distance_of_chords(a, part.first, b, part.second, margin);
    const double mine = sag(a, part.first);
    const double its = sag(b, part.second);
    const double least = chords.distance - mine - its;
    // Two digits are enough for a distance that is too short.
    const double digits = nearest.distance < enough && std::isfinite(enough) ? 0.01 * enough : kSamePosition;
    if (least >= enough || least >= nearest.distance - digits) continue;
    const double there = (position_at(b, chords.t_second) - position_at(a, chords.t_first)).norm();
    if (there < nearest.distance) nearest = {there, chords.t_first, chords.t_second};
    if (mine + its <= kSamePosition) {
      if (chords.distance < nearest.distance) nearest = chords;
      continue;
    }
    const TimeSpan& divided = mine >= its ? part.first : part.second;
    const double middle = 0.5 * (divided.begin + divided.end);
    for (const TimeSpan& half : {TimeSpan{divided.begin, middle}, TimeSpan{middle, divided.end}}) {
      open.push_back(mine >= its ? Part{half, part.second} : Part{part.first, half});
    }
  }
  return nearest;
}

}  // namespace fleetplan::core
