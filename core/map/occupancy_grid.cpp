#include "core/map/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <functional>

namespace fleetplan::core {

OccupancyGrid::OccupancyGrid(int columns, int rows, double resolution)
    : columns_(columns),
      rows_(rows),
      resolution_(resolution),
      blocked_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

std::size_t OccupancyGrid::hash() const {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
  std::uint64_t hash = std::hash<double>{}(resolution_) + static_cast<std::uint64_t>(columns_);
  const auto mix = [&](std::uint64_t word) {
    hash = (hash ^ word) * kOdd;
    hash ^= hash >> 32U;
  };
  std::size_t at = 0;
  for (std::uint64_t word = 0; at + sizeof word <= blocked_.size(); at += sizeof word) {
    std::memcpy(&word, blocked_.data() + at, sizeof word);
    mix(word);
  }
  for (; at < blocked_.size(); ++at) mix(blocked_[at]);
  return hash;
}

Cell OccupancyGrid::cell_at(const Position& position) const {
  return {static_cast<int>(std::floor(position.x() / resolution_)),
          static_cast<int>(std::floor(position.y() / resolution_))};
}

namespace {

/// The distance of a coordinate from the cell of this column or row.
double distance_to_cell(double coordinate, int cell, double resolution) {
  return std::max({cell * resolution - coordinate, coordinate - (cell + 1) * resolution, 0.0});
}

}  // namespace

double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit) {
  const double edge =
      std::min({position.x(), position.y(), grid.width() - position.x(), grid.height() - position.y()});
  if (edge <= 0.0) return edge;
  double nearest = std::min(limit, edge);
  const double resolution = grid.resolution();
  const Cell centre = grid.cell_at(position);
  // Row after row away from the position, and in each row cell after cell, as long as they can be nearer.
  const auto look_along_row = [&](int row, double dy) {
    // Bounded: the cells of a row nearer than `limit`; a request has few faults whose distance is wanted.
    for (const int step : {1, -1}) {
      for (int column = centre.column; column >= 0 && column < grid.columns(); column += step) {
        const double dx = distance_to_cell(position.x(), column, resolution);
        if (dx >= nearest) break;
        if (!grid.blocked({column, row})) continue;
        nearest = std::min(nearest, Position(dx, dy).norm());
        break;
      }
    }
  };
  // Bounded: the rows nearer than `limit`.
  for (const int step : {1, -1}) {
    for (int row = centre.row; row >= 0 && row < grid.rows(); row += step) {
      const double dy = distance_to_cell(position.y(), row, resolution);
      if (dy >= nearest) break;
      look_along_row(row, dy);
    }
  }
  return nearest;
}

namespace {

constexpr std::uint16_t kMax = 255;
/// Rows between two checks of the stop condition.
constexpr std::size_t kStopStride = 16;

/// The lower envelope of the parabolas of one row. Places are columns + 1, so that 0 and the last are outside
/// the map.
class Envelope {
 public:
  explicit Envelope(int columns)
      : heights_(static_cast<std::size_t>(columns) + 2), parabolas_(heights_.size()) {}

  /// Replaces the distances along the columns by the distances in the plane.
  void transform(std::uint16_t* row) {
    const int last = static_cast<int>(heights_.size()) - 1;
    heights_.front() = heights_.back() = 0;
    for (int place = 1; place < last; ++place) height(place) = std::int64_t{row[place - 1]} * row[place - 1];
    int top = 0;
    parabola(0) = {0, 0};
    // Bounded: the columns of a row; each enters and leaves the envelope once.
    for (int place = 1; place <= last; ++place) {
      while (top >= 0 && at(parabola(top).begin, parabola(top).place) > at(parabola(top).begin, place)) --top;
      const std::int64_t begin = top < 0 ? 0 : 1 + crossing(parabola(top).place, place);
      if (begin <= last) parabola(++top) = {place, static_cast<int>(begin)};
    }
    for (int place = last; place > 0; --place) {
      if (place < last) {
        const auto squared =
            std::min<std::int64_t>(at(place, parabola(top).place), DistanceTransform::kMaxSquared);
        row[place - 1] = static_cast<std::uint16_t>(squared);
      }
      if (place == parabola(top).begin) --top;
    }
  }

 private:
  struct Parabola {
    int place;
    int begin;  // where it becomes the lowest
  };

  std::int64_t& height(int place) { return heights_[static_cast<std::size_t>(place)]; }
  Parabola& parabola(int index) { return parabolas_[static_cast<std::size_t>(index)]; }
  std::int64_t at(std::int64_t x, int place) { return (x - place) * (x - place) + height(place); }
  /// The last place where the parabola of the first point is not above the parabola of the second.
  std::int64_t crossing(std::int64_t first, std::int64_t second) {
    const std::int64_t difference =
        second * second - first * first + height(static_cast<int>(second)) - height(static_cast<int>(first));
    return difference / (2 * (second - first));
  }

  std::vector<std::int64_t> heights_;
  std::vector<Parabola> parabolas_;
};

}  // namespace

DistanceTransform::DistanceTransform(const OccupancyGrid& grid, const StopCondition& stop)
    : columns_(grid.columns()),
      rows_(grid.rows()),
      stride_((static_cast<std::size_t>(columns_) + kTileColumns - 1) / kTileColumns * kTileColumns),
      squared_((static_cast<std::size_t>(rows_) + kTileRows - 1) / kTileRows * kTileRows * stride_) {
  StopStride stops(stop, kStopStride);
  finished_ = scan_columns(grid, stops) && scan_rows(stops) && make_tiles(stops);
}

/// Computes for each cell the distance to the nearest blocked cell of the same column. Returns false if
/// `stop` is met.
bool DistanceTransform::scan_columns(const OccupancyGrid& grid, StopStride& stop) {
  for (int row = 0; row < rows_; ++row) {
    if (stop.met_at_step()) return false;
    std::uint16_t* cell = squared_.data() + static_cast<std::size_t>(row) * stride_;
    for (int column = 0; column < columns_; ++column, ++cell) {
      const int below = row > 0 ? *(cell - stride_) : 0;
      *cell = grid.blocked({column, row}) ? 0 : static_cast<std::uint16_t>(std::min<int>(kMax, below + 1));
    }
  }
  for (int row = rows_ - 1; row >= 0; --row) {
    if (stop.met_at_step()) return false;
    std::uint16_t* cell = squared_.data() + static_cast<std::size_t>(row) * stride_;
    for (int column = 0; column < columns_; ++column, ++cell) {
      const int above = row + 1 < rows_ ? *(cell + stride_) : 0;
      *cell = std::min<std::uint16_t>(*cell, static_cast<std::uint16_t>(above + 1));
    }
  }
  return true;
}

bool DistanceTransform::scan_rows(StopStride& stop) {
  Envelope envelope(columns_);
  for (int row = 0; row < rows_; ++row) {
    if (stop.met_at_step()) return false;
    envelope.transform(squared_.data() + static_cast<std::size_t>(row) * stride_);
  }
  return true;
}

/// Arranges the distances, which are stored row by row, in tiles. Returns false if `stop` is met.
bool DistanceTransform::make_tiles(StopStride& stop) {
  std::vector<std::uint16_t> rows(kTileRows * stride_);
  for (std::size_t begin = 0; begin < squared_.size(); begin += rows.size()) {
    if (stop.met_at_step()) return false;
    std::copy_n(squared_.data() + begin, rows.size(), rows.data());
    for (std::size_t row = 0; row < kTileRows; ++row) {
      for (std::size_t column = 0; column < stride_; ++column) {
        squared_[begin + tiled(column, row)] = rows[row * stride_ + column];
      }
    }
  }
  return true;
}

}  // namespace fleetplan::core
