#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/motion_tree.h"
#include "core/geometry/segment.h"
#include "core/model/surroundings.h"
#include "core/reservation/contacts.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Reservations that no order of the robots can change: moving obstacles, and the committed motion of robots.
/// They are immutable, so all tables of a request share them, in any thread.
class FixedReservations {
 public:
  /// A robot's committed motion, and where the planned part begins.
  struct Committed {
    LargestDisk disk;
    Position start{0.0, 0.0};              // at t = 0
    Position committed_end{0.0, 0.0};      // where the committed motion ends; the start without any
    double committed_until = 0.0;          // seconds: when that ends; 0 without any
    std::vector<SizedSegment> committed;   // contiguous, from t = 0 to `committed_until`
    double radius_at_start = 0.0;          // metres, at t = 0
    double radius_at_committed_end = 0.0;  // metres, at `committed_until`
  };
  /// A part of the motion of an obstacle or of a robot.
  struct Occupant {
    MovingDisk disk;
    std::size_t index = 0;  // of the robot, or of the obstacle
    bool is_obstacle = false;
    bool from_start = false;             // of a robot: it stands at its start, or moves away from there
    Terminal terminal = Terminal::none;  // of a robot, see Contacts
    double radius = 0.0;                 // metres
    double pair_radius = 0.0;  // metres, of a robot to other robots: inflation and vicinity included
  };

  FixedReservations() = default;
  /// The map is [0, width] x [0, height] metres. Null `contacts`: no two robots are in contact. If the stop
  /// condition is met first, or memory is spent, the reservations are not known(), see below.
  FixedReservations(double width, double height, std::vector<Committed> robots,
                    const std::vector<MovingObstacle>& obstacles, const Contacts* contacts,
                    const StopCondition& stop);

  bool empty() const { return empty_; }
  /// False if the reservations could not be indexed. Then nothing may be planned.
  bool known() const { return known_; }
  /// The number of parts, see Occupant.
  std::size_t count() const { return owners_.size(); }
  /// Whether committed motion changes its speed.
  bool has_ramps() const { return has_ramps_; }
  const Committed& robot(std::size_t index) const { return robots_[index]; }
  /// Whether the robot stands at the place where its committed motion ends, or moves from there.
  bool begins_at_commitment_end(std::size_t robot, const Position& from) const;

  /// Calls visit(occupant) for every part of an obstacle or of another robot's committed motion that could
  /// touch this robot's disk. The disk has the given radius (metres), and the times may differ by up to
  /// `margin` seconds. A part may be visited more than once. Stops and returns false when visit returns
  /// false; otherwise returns true.
  template <class Visitor>
  bool visit(std::size_t robot, const MovingDisk& mine, double radius, double margin, Visitor&& visit) const {
    return tree_.visit(mine, radius, margin, [&](std::size_t index) {
      const Occupant other = occupant(index);
      return (!other.is_obstacle && other.index == robot) || visit(other);
    });
  }

 private:
  struct Owner {
    std::uint32_t index = 0;
    bool is_obstacle = false;
    bool from_start = false;
    Terminal terminal = Terminal::none;
    double radius = 0.0;
  };

  class Collector;

  Occupant occupant(std::size_t index) const {
    const Owner& owner = owners_[index];
    return {.disk = tree_[index].motion,
            .index = owner.index,
            .is_obstacle = owner.is_obstacle,
            .from_start = owner.from_start,
            .terminal = owner.terminal,
            .radius = owner.radius,
            .pair_radius = tree_[index].radius};
  }

  std::vector<Committed> robots_;
  MotionTree tree_;
  std::vector<Owner> owners_;  // of the disks of the tree
  bool empty_ = true;
  bool known_ = true;
  bool has_ramps_ = false;
};

}  // namespace fleetplan::core
