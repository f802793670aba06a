#include "core/map/map_cache.h"

#include <algorithm>
#include <iterator>
#include <list>
#include <mutex>
#include <new>
#include <utility>

#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// Counts bytes that were allocated before on the job of this thread.
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

  /// The map that equals the grid, which gets one more user, or null.
  Map take(std::size_t hash, const OccupancyGrid& grid) {
    const std::lock_guard lock(mutex_);
    Map found = take_known(hash, grid);
    ++(found ? hits_ : misses_);
    return found;
  }

  /// Keeps a map, with its first user, unless there is an equal one by now; returns the one that is kept.
  Map put(std::size_t hash, Map map) {
    const MemoryScope of_no_job(nullptr);
    const std::lock_guard lock(mutex_);
    if (Map known = take_known(hash, map->grid())) return known;
    entries_.push_front({hash, map, 1});
    return map;
  }

  /// A user is done with a map of the shelf.
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
