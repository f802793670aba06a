#include "core/map/lattice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/elementary_functions.h"

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
  return cosine(0.5 * arctangent(second.rows, second.columns));
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
  return {heading_of(d), d.norm()};
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

FinerVertices::FinerVertices(int first, std::vector<Position> positions, std::vector<Link> links)
    : first_(first), positions_(std::move(positions)), links_(std::move(links)) {
  const std::size_t given = links_.size();
  for (std::size_t k = 0; k < given; ++k) links_.emplace_back(links_[k].second, links_[k].first);
  std::sort(links_.begin(), links_.end());
  links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  links_.shrink_to_fit();
  blocks_.resize(block_of(first + count()) + 2);
  for (const Link& link : links_) ++blocks_[block_of(link.first) + 1];
  std::partial_sum(blocks_.begin(), blocks_.end(), blocks_.begin());
  by_x_.resize(positions_.size());
  std::iota(by_x_.begin(), by_x_.end(), first);
  std::sort(by_x_.begin(), by_x_.end(), [&](int a, int b) {
    const double difference = position(a).x() - position(b).x();
    return difference != 0.0 ? difference < 0.0 : a < b;
  });
}

std::span<const FinerVertices::Link> FinerVertices::links_from(int vertex) const {
  if (links_.empty()) return {};
  const std::size_t block = block_of(vertex);
  auto begin = links_.begin() + blocks_[block];
  const auto last = links_.begin() + blocks_[block + 1];
  while (begin != last && begin->first < vertex) ++begin;
  auto end = begin;
  while (end != last && end->first == vertex) ++end;
  return {begin, end};
}

std::vector<int> FinerVertices::near(const Position& position, double distance) const {
  std::vector<int> found;
  auto vertex = std::lower_bound(by_x_.begin(), by_x_.end(), position.x() - distance,
                                 [&](int id, double x) { return this->position(id).x() < x; });
  for (; vertex != by_x_.end() && this->position(*vertex).x() <= position.x() + distance; ++vertex) {
    if ((this->position(*vertex) - position).norm() <= distance) found.push_back(*vertex);
  }
  std::sort(found.begin(), found.end());
  return found;
}

FreeSpace::FreeSpace(const Lattice& lattice, const LineOfSight& sight, double radius,
                     std::shared_ptr<const FinerVertices> finer)
    : lattice_(lattice),
      sight_(sight),
      radius_(radius),
      finer_(finer ? std::move(finer) : std::make_shared<FinerVertices>()),
      masks_(static_cast<std::size_t>(lattice.vertex_count())) {
  for (const Lattice::Step& step : lattice.steps()) {
    longest_step_ = std::max(longest_step_, lattice.spacing() * Position(step.columns, step.rows).norm());
    all_steps_ = all_steps_ << 1 | 1u;
  }
}

std::uint32_t FreeSpace::steps_from(int vertex) {
  Mask& cached = masks_[static_cast<std::size_t>(vertex)];
  if (cached.known) return cached.steps;
  const int column = vertex % lattice_.columns();
  const int row = vertex / lattice_.columns();
  const Position here = lattice_.position(vertex);
  const double surely_free = sight_.surely_free(here, radius_);
  if (surely_free >= longest_step_) {  // which is inside the map, hence between vertices
    cached = {all_steps_, true};
    return all_steps_;
  }
  std::uint32_t mask = 0;
  for (std::size_t k = 0; k < lattice_.steps().size(); ++k) {
    const auto [dc, dr] = lattice_.steps()[k];
    const int c = column + dc;
    const int r = row + dr;
    if (c < 0 || c >= lattice_.columns() || r < 0 || r >= lattice_.rows()) continue;
    const Position there = lattice_.position(lattice_.vertex(c, r));
    const bool is_free = (there - here).squaredNorm() <= surely_free * surely_free && surely_free > 0.0;
    if (is_free || may_sweep(here, there, radius_)) mask |= 1u << k;
  }
  cached = {mask, true};
  return mask;
}

}  // namespace fleetplan::core
