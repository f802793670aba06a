#include "core/map/free_space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fleetplan::core {

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
