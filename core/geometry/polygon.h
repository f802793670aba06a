#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// A simple polygon, its inside included: at least three corners in either order, metres.
class Polygon {
 public:
  explicit Polygon(std::vector<Position> corners);

  const std::vector<Position>& corners() const { return corners_; }
  const Position& low() const { return low_; }
  const Position& high() const { return high_; }
  /// Twice the area in square metres; > 0 if the corners are in counter-clockwise order.
  double twice_signed_area() const;

  /// Whether a point is inside, by the even-odd rule. Either answer is possible on the border.
  bool contains(const Position& point) const;
  /// Whether the bounding boxes of the polygon and of the segment between two points (possibly equal) share a
  /// point.
  bool box_meets(const Position& a, const Position& b) const {
    return std::min(a.x(), b.x()) <= high_.x() && std::max(a.x(), b.x()) >= low_.x() &&
           std::min(a.y(), b.y()) <= high_.y() && std::max(a.y(), b.y()) >= low_.y();
  }
  /// Whether any point of the segment from `from` to `to` (possibly equal) is nearer than `distance` (> 0,
  /// metres) to the polygon.
  bool comes_near(const Position& from, const Position& to, double distance) const;
  /// A part of a segment that is inside, as fractions of the segment.
  struct Span {
    double first = 0.0;
    double last = 1.0;
  };
  std::vector<Span> spans_inside(const Position& from, const Position& to) const;
  /// The distance of a point from the border, metres.
  double distance_to_border(const Position& point) const;

 private:
  bool is_deep(const Position& from, const Position& to, const Span& span) const;
  const Position& corner_after(std::size_t k) const { return corners_[k + 1 < corners_.size() ? k + 1 : 0]; }

  std::vector<Position> corners_;
  Position low_;  // lower left corner of the bounding box
  Position high_;
};

/// Polygons that are blocked like walls, with an index by position.
class BlockedPolygons {
 public:
  /// No polygons.
  BlockedPolygons() = default;
  /// Indexes polygons on a map of [0, width] x [0, height] metres.
  BlockedPolygons(std::vector<Polygon> polygons, double width, double height);

  bool empty() const { return polygons_.empty(); }
  const std::vector<Polygon>& polygons() const { return polygons_; }

  /// Whether any point of the segment from `from` to `to` (possibly equal) is nearer than `distance` (> 0,
  /// metres) to any of the polygons.
  bool come_near(const Position& from, const Position& to, double distance) const;

 private:
  static constexpr int kSide = 32;  // squares along each side of the map

  struct Squares {
    int first_column, last_column, first_row, last_row;
  };
  Squares squares(const Position& low, const Position& high) const;
  template <class Visitor>
  void for_each_square(const Polygon& polygon, const Visitor& visit) const;

  std::vector<Polygon> polygons_;
  Position squares_per_metre_{0.0, 0.0};
  // The polygons whose boxes overlap a square. For square k, counted row by row, they are in near_ from
  // begin_[k] to begin_[k + 1].
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> near_;
};

}  // namespace fleetplan::core
