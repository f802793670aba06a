#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/interval.h"
#include "core/geometry/segment.h"

namespace fleetplan::core {

class Contacts;
class SegmentIndex;

/// The reserved trajectories, which all other robots avoid, and what a search asks about them: safe
/// intervals, earliest departures, conflicts.
class ReservationTable {
 public:
  /// `radii[i]` is the radius of robot i in metres, inflation included; the map is [0, width] x [0, height]
  /// metres. `contacts` outlives the table; null if no two robots are in contact.
  ReservationTable(double width, double height, double cell_size, std::vector<double> radii,
                   const Contacts* contacts = nullptr);
  ~ReservationTable();

  /// Reserves contiguous segments for a robot that has no reservation yet.
  void commit(std::size_t robot, const std::vector<TimedSegment>& segments);
  /// Removes the robot's reservation; no effect if it has none.
  void remove(std::size_t robot);

  /// Queries leave out the reservations of an ignored robot.
  void ignore(std::size_t robot, bool ignored);

  /// When the robot may stand at `position` (paper, "Computing intervals"); ascending, without intervals
  /// shorter than 1e-9 s.
  std::vector<SafeInterval> safe_intervals(std::size_t robot, const Position& position) const;

  /// The earliest departure in [t_min, t_max] at which the robot can make the straight move of `duration`
  /// seconds (> 0) without a collision on the way; none if there is none. The caller ensures that the robot
  /// is in safe intervals before and after the move.
  std::optional<double> earliest_departure(std::size_t robot, const Segment& path, double duration,
                                           double t_min, double t_max) const;

  /// The robots whose reservations come nearer to these segments of `robot` than they are kept apart,
  /// ascending.
  std::vector<std::size_t> robots_hit(std::size_t robot, const std::vector<TimedSegment>& segments) const;

 private:
  std::unique_ptr<SegmentIndex> index_;
};

}  // namespace fleetplan::core
