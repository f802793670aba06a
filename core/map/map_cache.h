#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/map/static_map.h"

namespace fleetplan::core {

/// Keeps maps, with what has been derived from them, for later requests on the same map: one of the same size
/// and resolution, all of whose cells are equal. Plans do not depend on it. Thread-safe.
///
/// A map counts on the memory account of every thread that gets it, as if it was made there. The limit of the
/// cache is for the maps that nobody uses: those used least recently are destroyed first.
class MapCache {
 public:
  struct Stats {
    std::uint64_t hits = 0;    // since the start
    std::uint64_t misses = 0;  // likewise
    std::size_t maps = 0;
    std::size_t bytes = 0;  // of the maps, those in use included
  };

  /// 0 bytes: keeps no map and counts nothing.
  explicit MapCache(std::size_t most_bytes);

  /// The map of a grid; null if `stop` is met before it is made. It may outlive the cache. Throws
  /// std::bad_alloc if the job of this thread is not granted the memory.
  std::shared_ptr<const StaticMap> map_of(OccupancyGrid grid, const StopCondition& stop);

  Stats stats() const;

 private:
  class Shelf;

  std::shared_ptr<Shelf> shelf_;  // shared with the users of maps; null: keeps none
};

}  // namespace fleetplan::core
