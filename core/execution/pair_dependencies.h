#pragma once

// Which stretches of two robots are near each other, and the dependencies between the robots there.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/executed_actions.h"
#include "core/execution/staircase.h"
#include "core/geometry/bucket_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Two stretches of different robots whose disks would touch at some progress. There may be millions.
struct NearPair {
  std::uint32_t other_stretch = 0;  // a stretch of the robot that was added before
  std::uint32_t stretch = 0;        // a stretch of the robot in question, ascending in a list
};

/// The stretches of a robot that are near those of one robot that was added before.
struct NearRobot {
  std::size_t other = 0;
  std::vector<NearPair> pairs;
};

/// Finds the stretches of robots that are near those of others, by buckets of the plane.
class NearStretches {
 public:
  /// Indexes the stretches of robots, which are given by robot and must outlive this object.
  explicit NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot);

  /// Returns the robots added before that are near this one somewhere, ascending. Returns none if `stop` is
  /// met.
  std::optional<std::vector<NearRobot>> near(std::size_t robot, const StopCondition& stop);
  /// Adds a robot's stretches to the index. Returns false if `stop` is met.
  bool add(std::size_t robot, const StopCondition& stop);

 private:
  /// Finds the stretches near one stretch, by robot. Returns false if `stop` is met.
  bool find_near(std::size_t robot, std::size_t stretch, std::vector<std::vector<NearPair>>& by_other,
                 const StopCondition& stop);

  /// Looks at the stop condition once in many entries; stays true once it is met.
  bool stops_after(std::size_t looks, const StopCondition& stop);

  struct Entry {
    std::size_t robot = 0;
    std::size_t stretch = 0;
    std::uint64_t asked = 0;  // number of the last stretch that met this entry
  };

  const std::vector<std::vector<PlannedStretch>>& by_robot_;
  double largest_radius_ = 0.0;
  BucketGrid grid_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // indices of entries_
  std::vector<Entry> entries_;
  std::uint64_t asked_ = 0;
  std::size_t looks_ = 0;  // entries examined since the last look at the stop condition
  bool stopped_ = false;
};

/// The dependencies between two robots.
struct PairDependencies {
  std::vector<Step> for_second;  // the second robot waits for the first
  std::vector<Step> for_first;
  std::vector<Tightness> tight;
};

/// One of two robots: its motion in stretches, and when it is planned.
struct PacedRobot {
  const std::vector<PlannedStretch>& stretches;
  const Pace& pace;
};

/// Returns the dependencies between two robots that keep them apart by the sum of their radii less
/// `tolerance` (metres). `near`: stretches of the first robot (NearPair::other_stretch) near those of the
/// second. Returns none if the stop condition is met.
std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop);

}  // namespace fleetplan::core
