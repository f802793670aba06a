#include "core/geometry/polygon.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

double squared_distance(const Position& point, const Position& a, const Position& b) {
  return (point - a - nearest_share({a, b}, point) * (b - a)).squaredNorm();
}

/// Whether the segments cross each other in their insides. Segments that only touch may give either answer.
bool cross_each_other(const Position& a, const Position& b, const Position& c, const Position& d) {
  const auto side = [](const Position& p, const Position& q, const Position& r) {
    return cross_product(q - p, r - p);
  };
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

}  // namespace

Polygon::Polygon(std::vector<Position> corners)
    : corners_(std::move(corners)), low_(corners_.front()), high_(corners_.front()) {
  for (const Position& corner : corners_) {
    low_ = low_.cwiseMin(corner);
    high_ = high_.cwiseMax(corner);
  }
}

double Polygon::twice_signed_area() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    sum += cross_product(corners_[k] - corners_.front(), corner_after(k) - corners_.front());
  }
  return sum;
}

bool Polygon::contains(const Position& point) const {
  bool inside = false;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const Position& a = corners_[k];
    const Position& b = corner_after(k);
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

bool Polygon::comes_near(const Position& from, const Position& to, double distance) const {
  const Position low = from.cwiseMin(to) - Position(distance, distance);
  const Position high = from.cwiseMax(to) + Position(distance, distance);
  const auto is_apart = [&](const Position& least, const Position& most) {
    return most.x() < low.x() || most.y() < low.y() || least.x() > high.x() || least.y() > high.y();
  };
  if (is_apart(low_, high_)) return false;
  const double squared = distance * distance;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const Position& a = corners_[k];
    const Position& b = corner_after(k);
    if (is_apart(a.cwiseMin(b), a.cwiseMax(b))) continue;
    if (squared_distance(from, a, b) < squared || squared_distance(to, a, b) < squared ||
        squared_distance(a, from, to) < squared || squared_distance(b, from, to) < squared ||
        cross_each_other(from, to, a, b)) {
      return true;
    }
  }
  return contains(from);
}

std::vector<Polygon::Span> Polygon::spans_inside(const Position& from, const Position& to) const {
  if (!box_meets(from, to)) return {};
  const Position way = to - from;
  // Where the line of the segment enters and leaves, in turns. A corner on the line counts to its left.
  std::vector<double> crossings;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const Position& a = corners_[k];
    const Position& b = corner_after(k);
    const double side_a = cross_product(way, a - from);
    const double side_b = cross_product(way, b - from);
    if ((side_a >= 0.0) == (side_b >= 0.0)) continue;
    const Position at = a + side_a / (side_a - side_b) * (b - a);
    crossings.push_back((at - from).dot(way) / way.squaredNorm());
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<Span> spans;
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    const Span span{std::max(0.0, crossings[k]), std::min(1.0, crossings[k + 1])};
    if (span.first < span.last && is_deep(from, to, span)) spans.push_back(span);
  }
  return spans;
}

/// Whether a part of a segment is anywhere deeper inside than kSamePosition. It cannot be in between corners
/// without being so halfway.
bool Polygon::is_deep(const Position& from, const Position& to, const Span& span) const {
  const Position way = to - from;
  std::vector<double> ends{span.first, span.last};
  for (const Position& corner : corners_) {
    const double at = (corner - from).dot(way) / way.squaredNorm();
    if (at > span.first && at < span.last) ends.push_back(at);
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (distance_to_border(from + 0.5 * (ends[k] + ends[k + 1]) * way) > kSamePosition) return true;
  }
  return false;
}

double Polygon::distance_to_border(const Position& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    least = std::min(least, squared_distance(point, corners_[k], corner_after(k)));
  }
  return std::sqrt(least);
}

namespace {

/// The most squares that are looked up for a segment; near more squares, all polygons are tested.
constexpr int kMaxSquares = 16;

}  // namespace

BlockedPolygons::BlockedPolygons(std::vector<Polygon> polygons, double width, double height)
    : polygons_(std::move(polygons)),
      squares_per_metre_(kSide / width, kSide / height),
      begin_(kSide * kSide + 1, 0) {
  for (const Polygon& polygon : polygons_) {
    for_each_square(polygon, [&](std::size_t square) { ++begin_[square + 1]; });
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  near_.resize(begin_.back());
  std::vector<std::uint32_t> next = begin_;
  for (std::uint32_t index = 0; index < polygons_.size(); ++index) {
    for_each_square(polygons_[index], [&](std::size_t square) { near_[next[square]++] = index; });
  }
}

template <class Visitor>
void BlockedPolygons::for_each_square(const Polygon& polygon, const Visitor& visit) const {
  const Squares box = squares(polygon.low(), polygon.high());
  // Bounded: all squares, kSide * kSide.
  for (int row = box.first_row; row <= box.last_row; ++row) {
    for (int column = box.first_column; column <= box.last_column; ++column) {
      visit(static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column));
    }
  }
}

/// Returns the squares that a box overlaps. The border squares reach beyond the map.
BlockedPolygons::Squares BlockedPolygons::squares(const Position& low, const Position& high) const {
  const auto square = [&](double coordinate, int axis) {
    return static_cast<int>(std::clamp(std::floor(coordinate * squares_per_metre_[axis]), 0.0, kSide - 1.0));
  };
  return {square(low.x(), 0), square(high.x(), 0), square(low.y(), 1), square(high.y(), 1)};
}

bool BlockedPolygons::come_near(const Position& from, const Position& to, double distance) const {
  if (polygons_.empty()) return false;
  const Position reach(distance, distance);
  const Squares box = squares(from.cwiseMin(to) - reach, from.cwiseMax(to) + reach);
  const int count = (box.last_column - box.first_column + 1) * (box.last_row - box.first_row + 1);
  if (count > kMaxSquares) {
    return std::any_of(polygons_.begin(), polygons_.end(),
                       [&](const Polygon& polygon) { return polygon.comes_near(from, to, distance); });
  }
  // Bounded: kMaxSquares squares, and the corners of all polygons, of which a request may have so many.
  for (int row = box.first_row; row <= box.last_row; ++row) {
    for (int column = box.first_column; column <= box.last_column; ++column) {
      const auto square = static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
      for (std::uint32_t k = begin_[square]; k < begin_[square + 1]; ++k) {
        if (polygons_[near_[k]].comes_near(from, to, distance)) return true;
      }
    }
  }
  return false;
}

}  // namespace fleetplan::core
