#include "core/map/static_map.h"

#include <algorithm>
#include <iterator>
#include <list>
#include <new>
#include <utility>

#include "core/map/refinement.h"
#include "core/runtime/memory_account.h"

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

/// The vertices are computed without the lock, so that no request waits for another one.
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

namespace {

/// Counts bytes that were allocated before on the account of this thread's job.
void charge(std::size_t bytes) {
  MemoryAccount* account = MemoryScope::current();
  if (account != nullptr && !account->reserve(static_cast<std::int64_t>(bytes))) throw std::bad_alloc();
}

}  // namespace

/// The maps, those used most recently first.
class MapCache::Shelf {
 public:
  using Map = std::shared_ptr<const StaticMap>;

  explicit Shelf(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Returns the map that equals the grid and counts one more user of it; null if there is none.
  Map take(std::size_t hash, const OccupancyGrid& grid) {
    const std::lock_guard lock(mutex_);
    Map found = take_known(hash, grid);
    ++(found ? hits_ : misses_);
    return found;
  }

  /// Keeps a map, with its first user, unless an equal one is there by now. Returns the map that is kept.
  Map put(std::size_t hash, Map map) {
    const MemoryScope of_no_job(nullptr);
    const std::lock_guard lock(mutex_);
    if (Map known = take_known(hash, map->grid())) return known;
    entries_.push_front({hash, map, 1});
    return map;
  }

  /// Counts one user less of a map of the shelf.
  void give_back(const StaticMap* map) {
    const MemoryScope of_no_job(nullptr);  // the maps that are destroyed were counted elsewhere
    std::list<Entry> leaving;
    const std::lock_guard lock(mutex_);
    const auto is_it = [&](const Entry& entry) { return entry.map.get() == map; };
    --std::find_if(entries_.begin(), entries_.end(), is_it)->users;
    std::size_t unused = 0;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
      const auto next = std::next(entry);
      if (entry->users == 0) {
        const std::size_t bytes = entry->map->bytes();
        if (unused + bytes > most_bytes_) {
          leaving.splice(leaving.end(), entries_, entry);
        } else {
          unused += bytes;
        }
      }
      entry = next;
    }
  }

  Stats stats() const {
    const std::lock_guard lock(mutex_);
    Stats stats{hits_, misses_, entries_.size(), 0};
    for (const Entry& entry : entries_) stats.bytes += entry.map->bytes();
    return stats;
  }

 private:
  struct Entry {
    std::size_t hash;
    Map map;
    std::size_t users;
  };

  Map take_known(std::size_t hash, const OccupancyGrid& grid) {
    const auto is_it = [&](const Entry& entry) { return entry.hash == hash && entry.map->grid() == grid; };
    const auto known = std::find_if(entries_.begin(), entries_.end(), is_it);
    if (known == entries_.end()) return nullptr;
    ++known->users;
    entries_.splice(entries_.begin(), entries_, known);
    return known->map;
  }

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;
  std::uint64_t hits_ = 0;
  std::uint64_t misses_ = 0;
};

MapCache::MapCache(std::size_t most_bytes)
    : shelf_(most_bytes > 0 ? std::make_shared<Shelf>(most_bytes) : nullptr) {}

std::shared_ptr<const StaticMap> MapCache::map_of(OccupancyGrid grid, const StopCondition& stop) {
  if (!shelf_) return static_map(std::move(grid), stop);
  const auto in_use = [this](const Shelf::Map& map) {
    return Shelf::Map(map.get(), [shelf = shelf_](const StaticMap* used) { shelf->give_back(used); });
  };
  const std::size_t hash = grid.hash();
  Shelf::Map kept = shelf_->take(hash, grid);
  Shelf::Map made;
  if (!kept) {
    made = static_map(std::move(grid), stop);
    if (!made) return nullptr;
    kept = shelf_->put(hash, made);
  }
  Shelf::Map map = in_use(kept);
  if (map != made) charge(map->bytes());
  return map;
}

MapCache::Stats MapCache::stats() const { return shelf_ ? shelf_->stats() : Stats{}; }

}  // namespace fleetplan::core
