#include "core/map/lattice.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Moves are rarely longer, and the table fits into a processor's cache.
constexpr int kMaxTableSize = 96;

/// The moves in angular order; each doubling inserts the sum of every two neighbours.
std::vector<Lattice::Step> neighbourhood(int connectivity) {
  std::vector<Lattice::Step> steps{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
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

}  // namespace

Lattice::Lattice(const OccupancyGrid& grid, int connectivity)
    : columns_(grid.columns()),
      rows_(grid.rows()),
      spacing_(grid.resolution()),
      steps_(neighbourhood(connectivity)),
      table_columns_(std::min(columns_, kMaxTableSize)),
      table_rows_(std::min(rows_, kMaxTableSize)) {
  first_quadrant_.reserve(static_cast<std::size_t>(table_columns_) * static_cast<std::size_t>(table_rows_));
  for (int row = 0; row < table_rows_; ++row) {
    for (int column = 0; column < table_columns_; ++column) {
      first_quadrant_.push_back(displacement(column, row));
    }
  }
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
  const int candidate = vertex({column, row});
  return (this->position(candidate) - position).norm() <= kContactTolerance ? candidate : -1;
}

std::vector<int> Lattice::vertices_near(const Position& position, double distance) const {
  const auto index = [&](double x) { return x / spacing_ - 0.5; };
  const int column_min = std::max(0, static_cast<int>(std::ceil(index(position.x() - distance))));
  const int column_max = std::min(columns_ - 1, static_cast<int>(std::floor(index(position.x() + distance))));
  const int row_min = std::max(0, static_cast<int>(std::ceil(index(position.y() - distance))));
  const int row_max = std::min(rows_ - 1, static_cast<int>(std::floor(index(position.y() + distance))));
  std::vector<int> near;
  for (int row = row_min; row <= row_max; ++row) {
    for (int column = column_min; column <= column_max; ++column) {
      const int candidate = vertex({column, row});
      if ((this->position(candidate) - position).norm() <= distance) near.push_back(candidate);
    }
  }
  return near;
}

StaticMoves::StaticMoves(const Lattice& lattice, const LineOfSight& sight, double radius)
    : lattice_(lattice),
      sight_(sight),
      radius_(radius),
      masks_(static_cast<std::size_t>(lattice.vertex_count())) {}

std::uint32_t StaticMoves::from(int vertex) {
  Mask& cached = masks_[static_cast<std::size_t>(vertex)];
  if (cached.known) return cached.steps;
  const int column = vertex % lattice_.columns();
  const int row = vertex / lattice_.columns();
  const Position here = lattice_.position(vertex);
  std::uint32_t mask = 0;
  for (std::size_t k = 0; k < lattice_.steps().size(); ++k) {
    const auto [dc, dr] = lattice_.steps()[k];
    const int c = column + dc;
    const int r = row + dr;
    if (c < 0 || c >= lattice_.columns() || r < 0 || r >= lattice_.rows()) continue;
    if (sight_.may_sweep(here, lattice_.position(lattice_.vertex({c, r})), radius_)) mask |= 1u << k;
  }
  cached = {mask, true};
  return mask;
}

}  // namespace fleetplan::core
