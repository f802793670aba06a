#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/interval.h"
#include "core/geometry/segment.h"
#include "core/reservation/bucket_grid.h"

namespace fleetplan::core {

/// The trajectories that others must keep clear of, indexed in space and time, and the questions a search
/// asks of them.
///
/// Robots are sorted into a few classes of radii. For each class there is a layer of buckets, and a committed
/// segment is entered into every bucket of a layer where it could touch a robot of that class, with the time
/// window in which it could. A query therefore only looks into the buckets on its own centre line, and there
/// only at entries of the right time, however long the source interval is.
class ReservationTable {
 public:
  /// `radii[i]` is the radius of robot i in metres, inflation included; the map is [0, width] x [0, height]
  /// metres.
  ReservationTable(double width, double height, double cell_size, std::vector<double> radii);

  /// Reserves contiguous segments for a robot that has no reservation yet.
  void commit(std::size_t robot, const std::vector<TimedSegment>& segments);
  /// Takes the robot's reservation back; no effect if it has none.
  void remove(std::size_t robot);

  /// Queries pass over the reservations of an ignored robot.
  void ignore(std::size_t robot, bool ignored) { ignored_[robot] = ignored; }

  /// When the robot may stand at `position`, by time; without intervals too short to matter.
  std::vector<SafeInterval> safe_intervals(std::size_t robot, const Position& position) const;

  /// The earliest departure in [t_min, t_max] at which the robot can make the straight move of `duration`
  /// seconds (> 0) without touching anybody; none if there is none. Standing before and after is a matter of
  /// safe intervals.
  std::optional<double> earliest_departure(std::size_t robot, const Segment& path, double duration,
                                           double t_min, double t_max) const;

  /// The robots whose reservations overlap these segments of `robot` by more than kContactTolerance,
  /// ascending.
  std::vector<std::size_t> robots_hit(std::size_t robot, const std::vector<TimedSegment>& segments) const;

 private:
  using DiskId = std::uint32_t;
  struct Occupant {
    MovingDisk disk;
    double radius = 0.0;
    std::size_t robot = 0;
  };
  struct Entry {
    double t_begin;
    double t_end;
    DiskId id;
  };
  struct Bucket {
    std::vector<Entry> passing;   // by t_begin
    std::vector<DiskId> resting;  // without end
    double longest = 0.0;         // duration of the longest entry that was ever in `passing`
  };
  struct Layer {
    double radius;  // of the largest robot in the class
    std::vector<Bucket> buckets;
  };

  DiskId store(std::size_t robot, const TimedSegment& segment);
  void enter(Layer& layer, DiskId id);
  double reach(std::size_t robot, const Occupant& other) const;
  /// Calls visit(occupant) for the bucket's entries within the open time window until it returns false;
  /// returns whether it got through.
  template <class Visit>
  bool visit_bucket(const Bucket& bucket, double t_begin, double t_end, Visit&& visit) const;

  std::vector<double> radii_;
  BucketGrid grid_;
  std::vector<Layer> layers_;
  std::vector<std::size_t> layer_of_;  // by robot
  std::vector<Occupant> occupants_;    // by DiskId
  std::vector<DiskId> vacant_;
  std::vector<std::vector<DiskId>> held_;  // by robot
  std::vector<char> ignored_;              // by robot; not bool, for speed
};

}  // namespace fleetplan::core
