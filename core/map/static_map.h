#pragma once

// Maps with everything derived from them, and a cache that keeps maps for later requests.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A map with everything that is derived from it alone. It never changes, so requests on the same map, and
/// threads, may share it. What only some requests need is computed on first use.
class StaticMap {
 public:
  /// The map of a grid. If `stop` is met first, the object is not finished() and must not be used.
  StaticMap(OccupancyGrid grid, const StopCondition& stop);
  /// The map `walls` (not null) with further polygons that are blocked.
  StaticMap(std::shared_ptr<const StaticMap> walls, std::vector<Polygon> polygons);

  bool finished() const { return sight_.finished(); }
  const OccupancyGrid& grid() const { return *grid_; }
  const LineOfSight& sight() const { return sight_; }

  /// Returns the vertices that refine a lattice for robots of this radius; never null. Empty if the lattice
  /// needs none, or if the stop condition was met first.
  std::shared_ptr<const FinerVertices> finer_vertices(const Lattice& lattice, double radius,
                                                      const StopCondition& stop) const;

  /// Approximate memory in use, without the memory of the map behind it. Grows with what is computed on first
  /// use.
  std::size_t bytes() const { return own_bytes_ + finer_bytes_.load(std::memory_order_relaxed); }

 private:
  using Kind = std::tuple<double, int, double>;  // spacing and connectivity of the lattice, robot's radius

  std::shared_ptr<const FinerVertices> known(const Kind& kind) const;

  std::shared_ptr<const StaticMap> walls_;  // the map without polygons; null if there are none
  std::shared_ptr<const OccupancyGrid> grid_;
  LineOfSight sight_;
  std::size_t own_bytes_ = 0;
  // The members below are computed on first use.
  mutable std::mutex mutex_;
  mutable std::map<Kind, std::shared_ptr<const FinerVertices>> finer_;
  mutable std::atomic<std::size_t> finer_bytes_{0};
};

/// Returns the map of a grid; null if `stop` is met first.
std::shared_ptr<const StaticMap> static_map(OccupancyGrid grid, const StopCondition& stop);

/// Keeps maps, with everything derived from them, for later requests on the same map: the size, the
/// resolution and all cells are equal. Plans do not depend on it. Thread-safe.
///
/// A map counts on the memory account of every thread that gets it, as if it was made there. The limit of the
/// cache is for maps without users. The least recently used maps are destroyed first.
class MapCache {
 public:
  struct Stats {
    std::uint64_t hits = 0;    // maps found since the start
    std::uint64_t misses = 0;  // maps not found since the start
    std::size_t maps = 0;
    std::size_t bytes = 0;  // memory of the maps, maps in use included
  };

  /// Bytes that count for a kept map in addition to its own: the cache's lists and index, and what the
  /// allocator adds. Measured with maps of 64 cells.
  static constexpr std::size_t kEntryBytes = 640;

  /// A cache of at most so many bytes. With 0 bytes it keeps no map and counts nothing.
  explicit MapCache(std::size_t max_bytes);

  /// Returns the map of a grid; null if `stop` is met before it is made. The map may outlive the cache.
  /// Throws std::bad_alloc if the job of this thread is not granted the memory.
  std::shared_ptr<const StaticMap> map_of(OccupancyGrid grid, const StopCondition& stop);

  Stats stats() const;

 private:
  class Shelf;

  std::shared_ptr<Shelf> shelf_;  // shared with the users of maps; null: keeps none
};

}  // namespace fleetplan::core
