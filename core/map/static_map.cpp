#include "core/map/static_map.h"

#include <utility>

#include "core/map/refinement.h"

namespace fleetplan::core {

StaticMap::StaticMap(OccupancyGrid grid)
    : grid_(std::make_shared<OccupancyGrid>(std::move(grid))), sight_(*grid_) {}

StaticMap::StaticMap(std::shared_ptr<const StaticMap> walls, std::vector<Polygon> polygons)
    : walls_(std::move(walls)),
      grid_(walls_->grid_),
      sight_(walls_->sight_, BlockedPolygons(std::move(polygons), grid_->width(), grid_->height())) {}

const DistanceTransform& StaticMap::distances() const {
  if (walls_) return walls_->distances();
  const std::lock_guard lock(distances_mutex_);
  if (!distances_) distances_.emplace(*grid_);
  return *distances_;
}

std::shared_ptr<const FinerVertices> StaticMap::finer_vertices(const Lattice& lattice, double radius,
                                                               const StopCondition& stop) const {
  if (!may_need_refinement(*grid_, lattice, radius, !sight_.polygons().empty()))
    return std::make_shared<FinerVertices>();
  const Kind kind{lattice.spacing(), static_cast<int>(lattice.steps().size()), radius};
  const std::lock_guard lock(mutex_);
  const auto known = finer_.find(kind);
  if (known != finer_.end()) return known->second;
  if (stop.met()) return std::make_shared<FinerVertices>();
  auto found = refine(*grid_, distances(), sight_, lattice, radius, stop);
  if (!found) return std::make_shared<FinerVertices>();
  return finer_[kind] = std::make_shared<FinerVertices>(std::move(*found));
}

}  // namespace fleetplan::core
