#pragma once

// Which stretches of two robots are near each other, and what the robots ask of each other there.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/executed_actions.h"
#include "core/execution/staircase.h"
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
  /// Finds the stretches near one. False if `stop` is met.
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

/// What two robots ask of each other.
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

/// `near`: stretches of the first robot (NearPair::other_stretch) near those of the second. `tolerance`
/// (metres) is subtracted from the sum of the radii. Nothing if the stop condition is met.
std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop);

}  // namespace fleetplan::core
