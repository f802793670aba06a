#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "core/map/static_map.h"
#include "core/runtime/memory_account.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr std::size_t kPlenty = std::size_t{64} << 20;

/// A hall of 200 x 100 cells with a wall, in which a door is as wide as told.
OccupancyGrid hall(int door, double resolution = 0.05) {
  OccupancyGrid grid(200, 100, resolution);
  for (int row = 0; row < grid.rows(); ++row) {
    if (row < 40 || row >= 40 + door) grid.block({100, row});
  }
  return grid;
}

std::size_t bytes_of(const OccupancyGrid& grid) { return StaticMap(grid, StopCondition::never()).bytes(); }

TEST(MapCache, KeepsMapsForEqualGrids) {
  MapCache cache(kPlenty);
  const auto first = cache.map_of(hall(14), StopCondition::never());
  EXPECT_EQ(cache.map_of(hall(14), StopCondition::never()), first);
  EXPECT_NE(cache.map_of(hall(15), StopCondition::never()), first) << "one cell differs";
  EXPECT_NE(cache.map_of(hall(14, 0.1), StopCondition::never()), first);
  OccupancyGrid turned(100, 200, 0.05);
  EXPECT_NE(cache.map_of(turned, StopCondition::never()), first);
  EXPECT_EQ(first->grid(), hall(14));
  EXPECT_EQ(cache.stats().hits, 1u);
  EXPECT_EQ(cache.stats().misses, 4u);
  EXPECT_EQ(cache.stats().maps, 4u);
}

TEST(MapCache, DropsTheMapsUsedLeastRecently) {
  MapCache cache(2 * bytes_of(hall(1)) + bytes_of(hall(1)) / 2);  // two maps
  for (const int door : {1, 2, 1, 3}) cache.map_of(hall(door), StopCondition::never());
  EXPECT_EQ(cache.stats().hits, 1u);
  EXPECT_EQ(cache.stats().maps, 2u);
  cache.map_of(hall(1), StopCondition::never());
  EXPECT_EQ(cache.stats().hits, 2u) << "1 was used after 2";
  cache.map_of(hall(2), StopCondition::never());
  EXPECT_EQ(cache.stats().misses, 4u);
}

TEST(MapCache, ItsLimitIsForMapsThatNobodyUses) {
  MapCache cache(bytes_of(hall(1)) / 2);
  auto used = cache.map_of(hall(1), StopCondition::never());
  EXPECT_EQ(cache.map_of(hall(1), StopCondition::never()), used);
  EXPECT_EQ(cache.stats().maps, 1u);
  EXPECT_EQ(cache.stats().bytes, used->bytes() + MapCache::kEntryBytes);
  used.reset();
  EXPECT_EQ(cache.stats().maps, 0u);
}

TEST(MapCache, CountsWhatIsDerivedLater) {
  MapCache cache(kPlenty);
  const auto map = cache.map_of(hall(14), StopCondition::never());
  const std::size_t before = cache.stats().bytes;
  const Lattice lattice(map->grid(), 8, 0.25);
  EXPECT_GT(map->finer_vertices(lattice, 0.3, StopCondition::never())->count(), 0);
  EXPECT_GT(cache.stats().bytes, before);
  const Lattice again(map->grid(), 8, 0.25);
  EXPECT_EQ(map->finer_vertices(again, 0.3, StopCondition::never()),
            map->finer_vertices(lattice, 0.3, StopCondition::never()));
}

TEST(MapCache, KeepsThousandsOfMaps) {
  constexpr int kMaps = 1000;
  const auto numbered = [](int number) {
    OccupancyGrid grid(64, 64, 1.0);
    for (int bit = 0; bit < 16; ++bit) {
      if ((number >> bit & 1) != 0) grid.block({bit, 0});
    }
    return grid;
  };
  MapCache cache(kPlenty);
  for (const int round : {0, 1}) {
    for (int k = 0; k < kMaps; ++k) {
      ASSERT_EQ(cache.map_of(numbered(k), StopCondition::never())->grid(), numbered(k)) << round;
    }
  }
  EXPECT_EQ(cache.stats().hits, static_cast<std::uint64_t>(kMaps));
  EXPECT_EQ(cache.stats().maps, static_cast<std::size_t>(kMaps));
  EXPECT_GT(cache.stats().bytes, kMaps * MapCache::kEntryBytes);
}

TEST(MapCache, KeepsNoSmallMap) {
  MapCache cache(kPlenty);
  const OccupancyGrid small(63, 65, 1.0);
  EXPECT_NE(cache.map_of(small, StopCondition::never()), cache.map_of(small, StopCondition::never()));
  EXPECT_EQ(cache.stats().maps, 0u);
}

TEST(MapCache, AMapThatIsTooLargeDropsNoOther) {
  MapCache cache(2 * bytes_of(hall(1)));
  cache.map_of(hall(1), StopCondition::never());
  cache.map_of(OccupancyGrid(400, 200, 0.05), StopCondition::never());
  EXPECT_EQ(cache.stats().maps, 1u);
  cache.map_of(hall(1), StopCondition::never());
  EXPECT_EQ(cache.stats().hits, 1u);
}

TEST(MapCache, WithoutMemoryKeepsNothing) {
  MapCache cache(0);
  const auto first = cache.map_of(hall(14), StopCondition::never());
  EXPECT_NE(cache.map_of(hall(14), StopCondition::never()), first);
  EXPECT_EQ(cache.stats().misses, 0u);
  EXPECT_EQ(cache.stats().bytes, 0u);
}

TEST(MapCache, MapsMayOutliveIt) {
  std::shared_ptr<const StaticMap> map;
  {
    MapCache cache(kPlenty);
    map = cache.map_of(hall(14), StopCondition::never());
  }
  EXPECT_EQ(map->grid(), hall(14));
}

TEST(MapCache, CountsAMapOnEveryJobThatUsesIt) {
  MapCache cache(kPlenty);
  const std::size_t bytes = cache.map_of(hall(14), StopCondition::never())->bytes();
  MemoryAccount job(4 * bytes);
  {
    const MemoryScope scope(&job);
    const auto map = cache.map_of(hall(14), StopCondition::never());
    EXPECT_GE(job.used(), static_cast<std::int64_t>(bytes));
  }
  MemoryAccount small(bytes - 1);
  const MemoryScope scope(&small);
  EXPECT_THROW(cache.map_of(hall(14), StopCondition::never()), std::bad_alloc);
  EXPECT_EQ(cache.stats().hits, 2u);
}

/// Otherwise that job could use as much memory in addition.
TEST(MapCache, MapsThatItDropsAreNotSubtractedFromAJob) {
  MapCache cache(bytes_of(hall(14)) * 3 / 2);
  cache.map_of(hall(14), StopCondition::never());
  MemoryAccount job(kPlenty);
  {
    const MemoryScope scope(&job);
    cache.map_of(hall(15), StopCondition::never());
  }
  EXPECT_EQ(cache.stats().maps, 1u);
  EXPECT_GE(job.used(), 0);
}

TEST(MapCache, ThreadsShareIt) {
  constexpr int kMaps = 4;
  constexpr double kRadius = 0.3;
  MapCache cache(2 * bytes_of(hall(14)));  // maps come and go
  std::array<std::vector<FinerVertices::Link>, kMaps> expected;
  const Lattice lattice(hall(14), 8, 0.25);
  for (int k = 0; k < kMaps; ++k) {
    const auto finer = StaticMap(hall(13 + k), StopCondition::never())
                           .finer_vertices(lattice, kRadius, StopCondition::never());
    const auto links = finer->links();
    expected[static_cast<std::size_t>(k)] = {links.begin(), links.end()};
  }
  std::array<int, 4> wrong{};
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
      threads.emplace_back([&, thread] {
        for (std::size_t round = 0; round < 12; ++round) {
          const std::size_t k = (thread + round * round) % kMaps;
          const auto map = cache.map_of(hall(13 + static_cast<int>(k)), StopCondition::never());
          const auto finer = map->finer_vertices(lattice, kRadius, StopCondition::never());
          const auto links = finer->links();
          if (!std::equal(links.begin(), links.end(), expected[k].begin(), expected[k].end()))
            ++wrong[thread];
          if (cache.stats().maps > kMaps) ++wrong[thread];
        }
      });
    }
  }
  for (const int count : wrong) EXPECT_EQ(count, 0);
  EXPECT_GT(cache.stats().hits, 0u);
  EXPECT_LE(cache.stats().bytes, 2 * bytes_of(hall(14)));
}

TEST(MapCache, KeepsNoMapThatIsNotFinished) {
  MapCache cache(std::size_t{1} << 20);
  support::StepLimit none(0);
  EXPECT_EQ(cache.map_of(OccupancyGrid(100, 100, 1.0), support::counted(none)), nullptr);
  EXPECT_EQ(cache.stats().maps, 0u);
  support::StepLimit enough;
  EXPECT_NE(cache.map_of(OccupancyGrid(100, 100, 1.0), support::counted(enough)), nullptr);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
