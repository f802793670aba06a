#pragma once

// What a robot is on the way to each of its goals: its load, and how it moves with that.

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/segment.h"
#include "core/map/lattice.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/model/motion.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A robot with one of its loads.
struct LoadedRobot {
  Load load;
  Motion motion;
  std::shared_ptr<FreeSpace> free_space;    // never null; of all robots for which it is the same
  std::shared_ptr<const DriveZones> zones;  // those that limit how the robot drives; null if there are none
};

/// A robot in the stages of its plan. A stage is the way to a goal that is left, by the goal's position in
/// Itinerary::goals; or, one past the last goal, the rest there for good.
class RobotStages {
 public:
  /// `loads`: one for each stage, or a single one for all. `largest_disk`: at any time, commitments included.
  RobotStages(std::vector<LoadedRobot> loads, const LargestDisk& largest_disk)
      : loads_(std::move(loads)), largest_disk_(largest_disk) {}

  /// Whether the robot has several loads in these stages.
  bool changes_load() const { return loads_.size() > 1; }
  const LoadedRobot& operator[](std::size_t stage) const { return loads_[changes_load() ? stage : 0]; }

  const LargestDisk& largest_disk() const { return largest_disk_; }
  /// The motion with the smallest radius.
  const Motion& slimmest_motion() const;
  /// No plan of the robot takes so long, seconds.
  double longest_plan() const;

 private:
  std::vector<LoadedRobot> loads_;
  LargestDisk largest_disk_;
};

/// Returns the stages of all robots. `itineraries` and `lattices` are by robot. The problem and the lattices
/// outlive the result.
std::vector<RobotStages> stages_of_robots(const Problem& problem, const PlanOptions& options,
                                          const std::vector<Itinerary>& itineraries,
                                          const std::vector<std::shared_ptr<const Lattice>>& lattices,
                                          const StopCondition& stop);

}  // namespace fleetplan::core
