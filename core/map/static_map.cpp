#include "core/map/static_map.h"

#include <utility>

#include "core/map/refinement.h"

namespace fleetplan::core {

StaticMap::StaticMap(OccupancyGrid grid) : grid_(std::move(grid)), sight_(grid_) {}

std::shared_ptr<const FinerVertices> StaticMap::finer_vertices(const Lattice& lattice, double radius,
                                                               const StopCondition& stop) const {
  if (!may_need_refinement(grid_, lattice, radius)) return std::make_shared<FinerVertices>();
  const Kind kind{lattice.spacing(), static_cast<int>(lattice.steps().size()), radius};
  const std::lock_guard lock(mutex_);
  const auto known = finer_.find(kind);
  if (known != finer_.end()) return known->second;
  if (stop.met()) return std::make_shared<FinerVertices>();
  if (!distances_) distances_.emplace(grid_);
  auto found = refine(grid_, *distances_, sight_, lattice, radius, stop);
  if (!found) return std::make_shared<FinerVertices>();
  return finer_[kind] = std::make_shared<FinerVertices>(std::move(*found));
}

}  // namespace fleetplan::core
