#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/polygon.h"
#include "core/geometry/position.h"

namespace fleetplan::core {

/// Polygons that are blocked like walls, with an index of where they are.
class BlockedPolygons {
 public:
  /// None.
  BlockedPolygons() = default;
  /// The map is [0, width] x [0, height] metres.
  BlockedPolygons(std::vector<Polygon> polygons, double width, double height);

  bool empty() const { return polygons_.empty(); }
  const std::vector<Polygon>& polygons() const { return polygons_; }

  /// Whether some point of the segment from `from` to `to` (possibly equal) is nearer than `distance` (> 0,
  /// metres) to one of them.
  bool come_near(const Position& from, const Position& to, double distance) const;

 private:
  static constexpr int kSide = 32;  // squares along each side of the map

  struct Squares {
    int first_column, last_column, first_row, last_row;
  };
  Squares squares(const Position& low, const Position& high) const;
  template <class Visit>
  void for_each_square(const Polygon& polygon, const Visit& visit) const;

  std::vector<Polygon> polygons_;
  Position squares_per_metre_{0.0, 0.0};
  // The polygons whose boxes overlap a square: those of square k, counted row by row, are at near_ from
  // begin_[k] to begin_[k + 1].
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> near_;
};

}  // namespace fleetplan::core
