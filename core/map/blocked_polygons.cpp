#include "core/map/blocked_polygons.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace fleetplan::core {
namespace {

/// For a segment near more squares than this, all polygons are tested.
constexpr int kMostSquares = 16;

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

template <class Visit>
void BlockedPolygons::for_each_square(const Polygon& polygon, const Visit& visit) const {
  const Squares box = squares(polygon.low(), polygon.high());
  // Bounded: all squares, kSide * kSide.
  for (int row = box.first_row; row <= box.last_row; ++row) {
    for (int column = box.first_column; column <= box.last_column; ++column) {
      visit(static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column));
    }
  }
}

/// Those of the border squares reach beyond the map.
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
  if (count > kMostSquares) {
    return std::any_of(polygons_.begin(), polygons_.end(),
                       [&](const Polygon& polygon) { return polygon.comes_near(from, to, distance); });
  }
  // Bounded: kMostSquares squares, and the corners of all polygons, of which a request may have so many.
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
