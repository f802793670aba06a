#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/segment.h"

namespace fleetplan::core {

class Contacts;
class FixedReservations;
class SegmentIndex;

/// The reserved trajectories, which all other robots avoid. It answers what a search asks about them: safe
/// intervals, earliest departures, conflicts.
///
/// Obstacles and committed motion (FixedReservations) are reserved at all times: they are neither removed nor
/// ignored. No robot collides with its own commitment. A robot's reservation counts from the end of its
/// commitment on.
class ReservationTable {
 public:
  /// The disks are by robot. The map is [0, width] x [0, height] metres. `contacts` (null: no two robots are
  /// in contact) and `fixed`, the obstacles and committed motion (null: there are none), must outlive the
  /// table. The interval margin (PlanOptions) is in seconds.
  ReservationTable(double width, double height, double cell_size, std::vector<LargestDisk> disks,
                   const Contacts* contacts = nullptr, const FixedReservations* fixed = nullptr,
                   double interval_margin = 0.0);
  ~ReservationTable();

  /// Reserves contiguous segments for a robot that has no reservation yet; they follow its commitment.
  void reserve(std::size_t robot, const std::vector<SizedSegment>& segments);
  /// Removes the robot's reservation; no effect if it has none.
  void remove(std::size_t robot);

  /// Queries leave out the reservations of an ignored robot.
  void ignore(std::size_t robot, bool ignored);

  /// Whether a query may take a millisecond. Then a search asks its stop condition more often.
  bool is_costly() const;

  /// When the robot may stand at `position` (paper, "Computing intervals"): all times except the open
  /// intervals in which others are too near. Ascending, without intervals shorter than 1e-9 s. `t_from` is
  /// the earliest time at which the robot can be there. Robots that pass before it may be left out, which
  /// saves time.
  std::vector<SafeInterval> safe_intervals(const Footprint& footprint, const Position& position,
                                           double t_from = 0.0) const;

  /// The earliest departure in [t_min, t_max] at which the robot can make the straight move of `duration`
  /// seconds (> 0) without a collision on the way. None if there is no such departure. The caller ensures
  /// that the robot is in safe intervals before and after the move.
  ///
  /// Each robot in the way forbids an interval of departures. The departure is delayed to the end of such
  /// intervals until the robot meets no other robot. For `ramp` see TimedSegment.
  std::optional<double> earliest_departure(const Footprint& footprint, const Segment& path, double duration,
                                           double t_min, double t_max, double ramp = 0.0) const;

  /// The robots whose reservations come nearer to these segments of `robot` than robots are kept apart,
  /// ascending. Robots that it only touches, up to rounding, are left out, because departures are delayed
  /// until then. Committed motion is left out. The segments follow the robot's commitment.
  std::vector<std::size_t> robots_hit(std::size_t robot, const std::vector<SizedSegment>& segments) const;
  /// The robots whose committed motion comes nearer to these segments of `robot` than robots are kept apart,
  /// ascending.
  std::vector<std::size_t> robots_certainly_hit(std::size_t robot,
                                                const std::vector<SizedSegment>& segments) const;

 private:
  class DelayedMove;
  class FixedDistance;

  bool delay_past_fixed(const Footprint& footprint, const Segment& path, DelayedMove& move) const;
  double margin_of(std::size_t robot, const TimedSegment& segment) const;
  bool begins_at_commitment_end(std::size_t robot, const Position& from) const;
  double commitment_end(std::size_t robot) const;

  std::unique_ptr<SegmentIndex> index_;
  const FixedReservations* fixed_ = nullptr;  // null: none
  double margin_ = 0.0;                       // seconds
};

}  // namespace fleetplan::core
