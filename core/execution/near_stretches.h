#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/execution/pace.h"
#include "core/reservation/bucket_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Two stretches of different robots whose disks would touch at some progress. There may be millions.
struct NearPair {
  std::uint32_t other_stretch = 0;  // of a robot that was added before
  std::uint32_t stretch = 0;        // of the robot asked for, ascending in a list
};

/// The stretches of a robot near those of one that was added before.
struct NearRobot {
  std::size_t other = 0;
  std::vector<NearPair> pairs;
};

/// Finds the stretches of robots that are near those of others, by buckets of the plane.
class NearStretches {
 public:
  /// `by_robot`: the stretches of all robots; must outlive this.
  explicit NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot);

  /// The robots added before that are near this one somewhere, ascending. Nothing if `stop` is met.
  std::optional<std::vector<NearRobot>> near(std::size_t robot, const StopCondition& stop);
  /// False if `stop` is met.
  bool add(std::size_t robot, const StopCondition& stop);

 private:
  /// Those near one stretch. False if `stop` is met.
  bool find_near(std::size_t robot, std::size_t stretch, std::vector<std::vector<NearPair>>& by_other,
                 const StopCondition& stop);

  /// Looks at the stop condition once in many entries; stays true once it is met.
  bool stops_after(std::size_t looks, const StopCondition& stop);

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
  std::size_t looks_ = 0;  // at entries, since the last look at the stop condition
  bool stopped_ = false;
};

}  // namespace fleetplan::core
