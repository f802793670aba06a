#include "core/map/static_map.h"

#include <algorithm>
#include <iterator>
#include <list>
#include <new>
#include <optional>
#include <unordered_map>
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

/// The vertices are computed without the lock, so that no request waits for another.
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

/// Maps of fewer cells are made anew. That takes less than 0.1 ms, and a few milliseconds if the lattice
/// needs more vertices. If many thousands were kept among the short-lived memory of requests, each would hold
/// a page.
constexpr std::int64_t kFewestCells = 4096;

/// Counts bytes that were allocated before on the account of this thread's job.
void charge(std::size_t bytes) {
  MemoryAccount* account = MemoryScope::current();
  if (account != nullptr && !account->reserve(static_cast<std::int64_t>(bytes))) throw std::bad_alloc();
}

}  // namespace

/// The maps that are kept, in time that does not depend on their number.
class MapCache::Shelf {
 public:
  using Map = std::shared_ptr<const StaticMap>;
  struct Entry {
    std::size_t hash;
    Map map;
    std::size_t users;
    std::size_t bytes;  // memory, from when it was last used
  };
  using Slot = std::list<Entry>::iterator;

  explicit Shelf(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns the place of the map that equals the grid, and counts one more user of it; none if there is
  /// none.
  std::optional<Slot> take(std::size_t hash, const OccupancyGrid& grid) {
    const std::lock_guard lock(mutex_);
    const std::optional<Slot> found = take_known(hash, grid);
    ++(found ? hits_ : misses_);
    return found;
  }

  /// Keeps a map, with its first user, unless an equal map is there by now. Returns the place of the map that
  /// is kept. None if there are too many others with this hash.
  std::optional<Slot> put(std::size_t hash, const Map& map) {
    const MemoryScope of_no_job(nullptr);
    std::list<Entry> entry{{hash, map, 1, 0}};
    const std::lock_guard lock(mutex_);
    if (const std::optional<Slot> known = take_known(hash, map->grid())) return known;
    if (by_hash_.count(hash) >= kMaxOfAHash) return std::nullopt;
    by_hash_.emplace(hash, entry.begin());
    used_.splice(used_.begin(), entry);
    return used_.begin();
  }

  /// Counts one user less of a map. Among maps without users, the least recently used ones leave.
  void give_back(Slot entry) {
    const MemoryScope of_no_job(nullptr);  // the maps that are destroyed were counted elsewhere
    std::list<Entry> leaving;              // destroyed without the lock
    const std::lock_guard lock(mutex_);
    if (--entry->users > 0) return;
    entry->bytes = bytes_of(*entry);
    if (entry->bytes > max_bytes_) {
      by_hash_.erase(index_of(entry));
      leaving.splice(leaving.end(), used_, entry);
      return;
    }
    unused_.splice(unused_.begin(), used_, entry);
    unused_bytes_ += entry->bytes;
    while (unused_bytes_ > max_bytes_) {
      const Slot last = std::prev(unused_.end());
      unused_bytes_ -= last->bytes;
      by_hash_.erase(index_of(last));
      leaving.splice(leaving.end(), unused_, last);
    }
  }

  Stats stats() const {
    const std::lock_guard lock(mutex_);
    Stats stats{hits_, misses_, used_.size() + unused_.size(), unused_bytes_};
    for (const Entry& entry : used_) stats.bytes += bytes_of(entry);
    return stats;
  }

 private:
  /// The most maps of one hash. Only an attack on the cache would make more.
  static constexpr std::size_t kMaxOfAHash = 8;

  static std::size_t bytes_of(const Entry& entry) { return entry.map->bytes() + kEntryBytes; }

  std::optional<Slot> take_known(std::size_t hash, const OccupancyGrid& grid) {
    const auto [begin, end] = by_hash_.equal_range(hash);
    const auto known =
        std::find_if(begin, end, [&](const auto& item) { return item.second->map->grid() == grid; });
    if (known == end) return std::nullopt;
    const Slot entry = known->second;
    if (++entry->users > 1) return entry;
    unused_bytes_ -= entry->bytes;
    used_.splice(used_.begin(), unused_, entry);
    return entry;
  }

  std::unordered_multimap<std::size_t, Slot>::iterator index_of(Slot entry) {
    const auto [begin, end] = by_hash_.equal_range(entry->hash);
    return std::find_if(begin, end, [&](const auto& item) { return item.second == entry; });
  }

  const std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::list<Entry> used_;
  std::list<Entry> unused_;  // those used most recently first
  std::size_t unused_bytes_ = 0;
  std::unordered_multimap<std::size_t, Slot> by_hash_;
  std::uint64_t hits_ = 0;
  std::uint64_t misses_ = 0;
};

MapCache::MapCache(std::size_t max_bytes)
    : shelf_(max_bytes > 0 ? std::make_shared<Shelf>(max_bytes) : nullptr) {}

std::shared_ptr<const StaticMap> MapCache::map_of(OccupancyGrid grid, const StopCondition& stop) {
  if (!shelf_ || grid.cell_count() < kFewestCells) return static_map(std::move(grid), stop);
  const std::size_t hash = grid.hash();
  std::optional<Shelf::Slot> kept = shelf_->take(hash, grid);
  Shelf::Map made;
  if (!kept) {
    made = static_map(std::move(grid), stop);
    if (!made) return nullptr;
    kept = shelf_->put(hash, made);
    if (!kept) return made;
  }
  Shelf::Map map((*kept)->map.get(),
                 [shelf = shelf_, place = *kept](const StaticMap* /*map*/) { shelf->give_back(place); });
  if (map != made) charge(map->bytes());
  return map;
}

MapCache::Stats MapCache::stats() const { return shelf_ ? shelf_->stats() : Stats{}; }

}  // namespace fleetplan::core
