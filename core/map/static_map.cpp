#include "core/map/static_map.h"

#include <utility>

#include "core/map/refinement.h"

namespace fleetplan::core {

StaticMap::StaticMap(OccupancyGrid grid, const StopCondition& stop)
    : grid_(std::make_shared<OccupancyGrid>(std::move(grid))),
      sight_(*grid_, stop),
      own_bytes_(sizeof(StaticMap) + static_cast<std::size_t>(grid_->cell_count()) + sight_.bytes()) {}

StaticMap::StaticMap(std::shared_ptr<const StaticMap> walls, std::vector<Polygon> polygons)
    : walls_(std::move(walls)),
      grid_(walls_->grid_),
      sight_(walls_->sight_, BlockedPolygons(std::move(polygons), grid_->width(), grid_->height())) {}

std::shared_ptr<const FinerVertices> StaticMap::known(const Kind& kind) const {
  const std::lock_guard lock(mutex_);
  const auto found = finer_.find(kind);
  return found != finer_.end() ? found->second : nullptr;
}

std::shared_ptr<const StaticMap> static_map(OccupancyGrid grid, const StopCondition& stop) {
  auto map = std::make_shared<const StaticMap>(std::move(grid), stop);
  return map->finished() ? map : nullptr;
}

/// Computed without the lock, so that no request waits for another one.
std::shared_ptr<const FinerVertices> StaticMap::finer_vertices(const Lattice& lattice, double radius,
                                                               const StopCondition& stop) const {
  if (!may_need_refinement(*grid_, lattice, radius, !sight_.polygons().empty()))
    return std::make_shared<FinerVertices>();
  const Kind kind{lattice.spacing(), static_cast<int>(lattice.steps().size()), radius};
  if (auto before = known(kind)) return before;
  if (stop.met()) return std::make_shared<FinerVertices>();
  auto found = refine(*grid_, sight_, lattice, radius, stop);
  if (!found) return std::make_shared<FinerVertices>();
  auto made = std::make_shared<const FinerVertices>(std::move(*found));
  const std::lock_guard lock(mutex_);
  const auto [place, is_new] = finer_.try_emplace(kind, std::move(made));
  if (is_new) finer_bytes_.fetch_add(place->second->bytes(), std::memory_order_relaxed);
  return place->second;
}

}  // namespace fleetplan::core
