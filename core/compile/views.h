#pragma once

// What a robot is on the way to each of its goals, with its load at that time, and where it may be.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/segment.h"
#include "core/map/lattice.h"
#include "core/model/body.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A robot with one of its loads, and where it may be and move with this load.
struct View {
  Body body;
  std::shared_ptr<FreeSpace> free_space;    // never null; of all robots for which it is the same
  std::shared_ptr<const DriveZones> zones;  // the zones that limit how the robot drives; null if there are
                                            // none

  /// Whether walls and zones allow the straight move.
  bool allows(const Position& from, const Position& to) const {
    return free_space->may_sweep(from, to, body.wall_radius) && (zones == nullptr || zones->allow(from, to));
  }
};

/// The views of a robot by stage. A stage is the way to a goal that is left; its number is the goal's
/// position in Itinerary::goals. One more stage follows: the rest at the last goal for good.
class Views {
 public:
  /// The same view in all stages. `largest_disk`: at any time, commitments included.
  Views(View view, const LargestDisk& largest_disk) : views_{std::move(view)}, largest_disk_(largest_disk) {}
  /// `views` are different, in the order in which the stages first use them. `of_stages`: for each stage, the
  /// number of its view.
  Views(std::vector<View> views, std::vector<std::uint32_t> of_stages, const LargestDisk& largest_disk)
      : views_(std::move(views)), of_stages_(std::move(of_stages)), largest_disk_(largest_disk) {}

  /// How many there are: one for each load.
  std::size_t count() const { return views_.size(); }
  /// Whether the load changes in these stages.
  bool change() const { return count() > 1; }
  std::size_t number(std::size_t stage) const { return of_stages_.empty() ? 0 : of_stages_[stage]; }
  const View& operator[](std::size_t stage) const { return views_[number(stage)]; }

  /// The bodies in the first so many stages.
  std::vector<Body> bodies(std::size_t stages) const;
  const LargestDisk& largest_disk() const { return largest_disk_; }
  /// The body with the smallest radius.
  const Body& slimmest_body() const;
  /// An upper bound of how long the robot's plans take, seconds.
  double longest_plan() const;

 private:
  std::vector<View> views_;
  std::vector<std::uint32_t> of_stages_;  // empty if there is one view
  LargestDisk largest_disk_;
};

/// Returns the views of all robots. `itineraries` and `lattices` are by robot. The problem and the lattices
/// must outlive the result.
std::vector<Views> views_of_robots(const Problem& problem, const PlanOptions& options,
                                   const std::vector<Itinerary>& itineraries,
                                   const std::vector<std::shared_ptr<const Lattice>>& lattices,
                                   const StopCondition& stop);

}  // namespace fleetplan::core
