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
  /// Reserves motion of a robot that it executes whatever is planned, besides its other reservation. It is
  /// never removed nor ignored, except in queries of the robot itself.
  void commit_certain(std::size_t robot, const std::vector<TimedSegment>& segments);

  /// Queries leave out the reservations of an ignored robot, except its certain motion.
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
  /// ascending. Certain motion is left out.
  std::vector<std::size_t> robots_hit(std::size_t robot, const std::vector<TimedSegment>& segments) const;
  /// Likewise those whose certain motion does.
  std::vector<std::size_t> robots_certainly_hit(std::size_t robot,
                                                const std::vector<TimedSegment>& segments) const;

 private:
  std::vector<std::size_t> hits(std::size_t robot, const std::vector<TimedSegment>& segments,
                                bool certain) const;

  std::unique_ptr<SegmentIndex> index_;
};

}  // namespace fleetplan::core
