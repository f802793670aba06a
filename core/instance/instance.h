#pragma once

// A problem with its options, how each robot moves under them, and what is derived from all of this once.

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "core/commitments/contacts.h"
#include "core/commitments/fixed_reservations.h"
#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"
#include "core/map/lattice.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How one robot moves, with the plan's options applied.
struct Motion {
  double radius = 0.0;            // metres, to walls, inflation included
  double linear_speed = 0.0;      // metres per second
  double angular_speed = 0.0;     // radians per second
  double wait_before_move = 0.0;  // seconds
  double pair_radius = 0.0;       // metres, to other robots: vicinity and inflation included
  bool may_reverse = false;       // translate backwards, too

  Inertia linear_inertia = {};   // of translations
  Inertia angular_inertia = {};  // of rotations

  /// Seconds of a translation from rest to rest.
  double translation_time(double distance) const { return linear_inertia.time(distance, linear_speed); }
  /// Seconds at full speed.
  double cruise_time(double distance) const { return distance / linear_speed; }
  /// Seconds to turn from one normalised heading to another, the shorter way.
  double rotation_time(double from, double to) const {
    return angular_inertia.time(angle_between(from, to), angular_speed);
  }
};

/// Returns how the robot moves under these options while it carries this load.
inline Motion motion_of(const Robot& robot, const PlanOptions& options, const Load& load) {
  return {load.radius + options.inflation,
          load.linear_speed,
          robot.angular_speed,
          options.wait_before_move,
          load.radius + options.inflation + robot.vicinity,
          robot.may_reverse,
          load.linear_inertia(),
          robot.angular_inertia()};
}

/// Returns the spacing of the lattice that each robot is planned on, metres, by robot: that of the options.
/// By default, it is the map's resolution; where that is at most a quarter of the smallest radius that the
/// robot ever has, it is the largest odd multiple of the resolution up to this radius, so that vertices are
/// centres of cells as well. Robots of like radius share a lattice, and no robot's lattice depends on other
/// robots.
std::vector<double> lattice_spacings(const Problem& problem, const PlanOptions& options);

/// A problem with its options, the lattices and the static feasibility of moves: what stays the same while
/// one request is planned. Not thread-safe, because static moves are computed on first use.
class Instance {
 public:
  /// If the stop condition is met while obstacles and committed motion are indexed, nothing can be planned.
  Instance(const Problem& problem, const PlanOptions& options, const StopCondition& stop);
  /// With the fixed reservations of another instance of the same problem and options.
  Instance(const Problem& problem, const PlanOptions& options,
           std::shared_ptr<const FixedReservations> fixed_reservations, const StopCondition& stop);

  std::size_t size() const { return problem_.robots().size(); }
  const Problem& problem() const { return problem_; }
  const PlanOptions& options() const { return options_; }
  const Robot& robot(std::size_t index) const { return problem_.robots()[index]; }
  /// The motion of the robot with the load that it has when its plan begins.
  const Motion& motion(std::size_t index) const { return stages_[index].front().motion; }
  /// The motion in a stage: on the way to a goal that is left, by the goal's position in Itinerary::goals;
  /// or, one past the last goal, at rest there for good.
  const Motion& motion(std::size_t index, std::size_t stage) const { return stage_of(index, stage).motion; }
  /// The radius of the robot in a stage, metres; neither inflation nor vicinity included.
  double radius(std::size_t index, std::size_t stage) const { return stage_of(index, stage).load.radius; }
  /// Whether the robot has several loads on the way to the goals that are left, or after the last one.
  bool changes_load(std::size_t index) const { return stages_[index].size() > 1; }
  /// The largest disk of the robot at any time, commitments included.
  LargestDisk largest_disk(std::size_t index) const;
  /// The motion with the smallest radius on the way to the goals that are left.
  const Motion& slimmest_motion(std::size_t index) const;
  /// Returns the contiguous segments of a trajectory from t = 0 on, with the radius on each.
  std::vector<SizedSegment> segments(std::size_t index, const Trajectory& trajectory) const;
  /// The load of the robot in a stage.
  const Load& load(std::size_t index, std::size_t stage) const { return stage_of(index, stage).load; }
  /// The zones that limit how the robot drives in a stage; null if there are none.
  const DriveZones* drive_zones(std::size_t index, std::size_t stage = 0) const {
    return stage_of(index, stage).zones;
  }
  /// What is left to plan for the robot after its committed actions.
  const Itinerary& itinerary(std::size_t index) const { return itineraries_[index]; }
  /// The lattice that the robot is planned on.
  const Lattice& lattice(std::size_t index) const { return *lattices_[index]; }
  /// The line of sight past walls alone, and the one past the zones that are blocked for a robot, too.
  const LineOfSight& sight() const { return problem_.map()->sight(); }
  const LineOfSight& sight(std::size_t index) const { return problem_.map_of(index)->sight(); }
  /// The pairs of robots that begin or end too near to each other.
  const Contacts& contacts() const { return contacts_; }
  /// Obstacles and committed motion; never null. Instances for other threads may share them.
  const std::shared_ptr<const FixedReservations>& fixed_reservations() const { return fixed_reservations_; }
  /// The largest disk of the robot, inflated or not, that fits where its plan begins and at a goal: its
  /// radius, or less where a wall is nearer. At the goal of a stage, only contact is allowed for.
  double radius_at_start(std::size_t index) const;
  double radius_at_goal(std::size_t index, const Position& goal, std::size_t stage) const;
  /// No plan of the robot takes so long, seconds.
  double longest_plan(std::size_t index) const;
  bool fits_at_start(std::size_t index) const;
  /// Whether no wall is nearer than in contact where the robot's plan begins.
  bool is_clear_at_start(std::size_t index) const;
  /// Whether the robot's disk fits at all goals that are left, or is in contact with a wall.
  bool fits_at_goal(std::size_t index) const;
  /// Whether its disk fits at this position on the way to its first goal, or is in contact with a wall.
  bool fits_at(std::size_t index, const Position& position) const;
  /// Shared by all robots for which it is the same.
  FreeSpace& free_space(std::size_t index, std::size_t stage = 0) const {
    return *stage_of(index, stage).space;
  }

 private:
  /// A robot on the way to one of its goals, or at rest at the last one.
  struct Stage {
    Motion motion;
    Load load;
    FreeSpace* space = nullptr;
    const DriveZones* zones = nullptr;
  };

  const Stage& stage_of(std::size_t index, std::size_t stage) const {
    const std::vector<Stage>& all = stages_[index];
    return all[all.size() > 1 ? stage : 0];
  }
  Stage make_stage(std::size_t index, const Load& load, const std::optional<DriveZones>& zones,
                   const StopCondition& stop);

  const Problem& problem_;
  PlanOptions options_;
  std::vector<std::shared_ptr<const Lattice>> lattices_;  // by robot; those with one spacing share one
  std::vector<std::unique_ptr<const DriveZones>> drive_zones_;
  std::vector<Itinerary> itineraries_;
  Contacts contacts_;
  std::shared_ptr<const FixedReservations> fixed_reservations_;
  using SpaceKind = std::tuple<double, double, const StaticMap*>;  // spacing of the lattice, radius and map
  std::map<SpaceKind, std::unique_ptr<FreeSpace>> free_spaces_;
  /// By robot: one for each goal and one for the rest at the last one, or a single one for all.
  std::vector<std::vector<Stage>> stages_;
};

}  // namespace fleetplan::core
