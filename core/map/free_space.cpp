#include "core/map/free_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fleetplan::core {

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
    longest_step_ = std::max(longest_step_, lattice.spacing() * std::hypot(step.columns, step.rows));
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
