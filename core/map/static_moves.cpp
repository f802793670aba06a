#include "core/map/static_moves.h"

#include <cstddef>

namespace fleetplan::core {

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
    if (sight_.may_sweep(here, lattice_.position(lattice_.vertex(c, r)), radius_)) mask |= 1u << k;
  }
  cached = {mask, true};
  return mask;
}

}  // namespace fleetplan::core
