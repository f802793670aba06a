#include "core/map/lattice.h"

#include <algorithm>
#include <cmath>

#include "core/map/occupancy_grid.h"

namespace fleetplan::core {
namespace {

/// Columns and rows of the table of displacements: moves are rarely longer, and it fits into a CPU's cache.
constexpr int kMaxTableSize = 96;

/// Returns the moves in angular order. Each doubling of the connectivity inserts the sum of every two
/// neighbours.
std::vector<Lattice::Step> neighbourhood(int connectivity) {
  std::vector<Lattice::Step> steps{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  // Bounded: the connectivity, which is small.
  while (static_cast<int>(steps.size()) < connectivity) {
    std::vector<Lattice::Step> finer;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Lattice::Step next = steps[(i + 1) % steps.size()];
      finer.push_back(steps[i]);
      finer.push_back({steps[i].columns + next.columns, steps[i].rows + next.rows});
    }
    steps = std::move(finer);
  }
  return steps;
}

/// Returns the cosine of half the angle between the first two moves, which is the largest such angle.
double cosine_of_half(const Lattice::Step& second) {
  return std::cos(0.5 * std::atan2(second.rows, second.columns));
}

}  // namespace

Lattice::Lattice(const OccupancyGrid& grid, int connectivity)
    : Lattice(grid, connectivity, grid.resolution()) {}

Lattice::Lattice(const OccupancyGrid& grid, int connectivity, double spacing)
    : columns_(static_cast<int>(vertices_along(grid.width(), spacing))),
      rows_(static_cast<int>(vertices_along(grid.height(), spacing))),
      spacing_(spacing),
      steps_(neighbourhood(connectivity)),
      least_straight_(cosine_of_half(steps_[1])),
      table_columns_(std::min(columns_, kMaxTableSize)),
      table_rows_(std::min(rows_, kMaxTableSize)) {
  first_quadrant_.reserve(static_cast<std::size_t>(table_columns_) * static_cast<std::size_t>(table_rows_));
  // Bounded: kMaxTableSize * kMaxTableSize.
  for (int row = 0; row < table_rows_; ++row) {
    for (int column = 0; column < table_columns_; ++column) {
      first_quadrant_.push_back(displacement(column, row));
    }
  }
}

/// The square of the last vertex may reach beyond the map, but not its centre.
std::int64_t Lattice::vertices_along(double length, double spacing) {
  return static_cast<std::int64_t>(std::floor(length / spacing + 0.5));
}

Displacement Displacement::between(const Position& from, const Position& to) {
  const Position d = to - from;
  return {std::atan2(d.y(), d.x()), d.norm()};
}

Displacement Lattice::displacement(int columns, int rows) const {
  return Displacement::between({0.0, 0.0}, {columns * spacing_, rows * spacing_});
}

int Lattice::vertex_at(const Position& position) const {
  const int column = static_cast<int>(std::floor(position.x() / spacing_));
  const int row = static_cast<int>(std::floor(position.y() / spacing_));
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return -1;
  const int candidate = vertex(column, row);
  return is_same_position(this->position(candidate), position) ? candidate : -1;
}

std::vector<int> Lattice::vertices_near(const Position& position, double distance) const {
  const auto index = [&](double x) { return x / spacing_ - 0.5; };
  const int column_min = std::max(0, static_cast<int>(std::ceil(index(position.x() - distance))));
  const int column_max = std::min(columns_ - 1, static_cast<int>(std::floor(index(position.x() + distance))));
  const int row_min = std::max(0, static_cast<int>(std::ceil(index(position.y() - distance))));
  const int row_max = std::min(rows_ - 1, static_cast<int>(std::floor(index(position.y() + distance))));
  std::vector<int> near;
  // Bounded: callers ask for vertices within a few spacings.
  for (int row = row_min; row <= row_max; ++row) {
    for (int column = column_min; column <= column_max; ++column) {
      const int candidate = vertex(column, row);
      if ((this->position(candidate) - position).norm() <= distance) near.push_back(candidate);
    }
  }
  return near;
}

double default_lattice_spacing(const OccupancyGrid& grid, double radius) {
  constexpr double kFineCells = 4.0 * (1.0 - 1e-9);  // cells are fine if the radius has so many
  constexpr double kLargestSpacing = 1.0;            // in units of the radius; see docs/method.md
  const double resolution = grid.resolution();
  if (radius < kFineCells * resolution) return resolution;
  const double shorter_side = std::min(grid.width(), grid.height());
  const double cells = std::min(kLargestSpacing * radius, shorter_side) / resolution * (1.0 + 1e-9);
  return (2.0 * std::floor(0.5 * (cells - 1.0)) + 1.0) * resolution;
}

}  // namespace fleetplan::core
