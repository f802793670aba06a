#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/execution/pace.h"
#include "core/reservation/bucket_grid.h"

namespace fleetplan::core {

/// Two stretches of different robots whose disks would touch at some progress.
struct NearPair {
  std::size_t other = 0;          // a robot that was added before
  std::size_t other_stretch = 0;  // of it
  std::size_t stretch = 0;        // of the robot asked for
};

/// Finds the stretches of robots that are near those of others, by buckets of the plane.
class NearStretches {
 public:
  /// `by_robot`: the stretches of all robots; must outlive this.
  explicit NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot);

  /// The pairs of a robot with those added before, ordered by the other robot.
  std::vector<NearPair> near(std::size_t robot);
  void add(std::size_t robot);

 private:
  struct Entry {
    std::size_t robot = 0;
    std::size_t stretch = 0;
    std::uint64_t asked = 0;  // by the last stretch that met it
  };

  const std::vector<std::vector<PlannedStretch>>& by_robot_;
  double largest_radius_ = 0.0;
  BucketGrid grid_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // entries
  std::vector<Entry> entries_;
  std::uint64_t asked_ = 0;
};

}  // namespace fleetplan::core
