#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/bucket_grid.h"
#include "core/geometry/disk_motion.h"
#include "core/geometry/segment.h"
#include "core/reservation/contacts.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

/// The timed segments of robots, indexed in space and time.
///
/// Robots are sorted into a few classes by the largest radius that they ever have. Each class has its own
/// buckets. A segment is entered into every bucket in which it could touch a robot of the class, with the
/// time window of the contact. So a query only visits the buckets on its own centre line, and in them only
/// the entries whose time window overlaps its own.
///
/// A class has layers of buckets, each with larger buckets than the layer before. Let d be the distance at
/// which a segment could touch a robot of the class. The segment is entered into the first layer whose
/// buckets are not much smaller than d. So a robot that is much larger than others is in few buckets.
class SegmentIndex {
 public:
  /// A robot on one of its segments.
  struct Occupant {
    MovingDisk disk;
    double radius = 0.0;  // metres, to other robots
    std::size_t robot = 0;
    Terminal terminal = Terminal::none;
  };

 private:
  enum class DiskId : int {};
  struct Entry {
    double t_begin;
    double t_end;
    DiskId id;
  };
  struct Bucket {
    std::vector<Entry> passing;   // by t_begin, then by number
    std::vector<DiskId> resting;  // without end; by number
    double longest = 0.0;         // the longest duration of an entry that was ever in `passing`
  };

 public:
  /// Buckets of one size.
  class Layer {
   public:
    const BucketGrid& grid() const { return grid_; }

   private:
    friend class SegmentIndex;
    Layer(int level, const BucketGrid& grid) : level_(level), grid_(grid), buckets_(grid.count()) {}

    int level_;
    BucketGrid grid_;
    std::vector<Bucket> buckets_;
  };

  /// An empty index; for the arguments see ReservationTable.
  SegmentIndex(double width, double height, double cell_size, std::vector<LargestDisk> disks,
               const Contacts* contacts);

  const LargestDisk& disk(std::size_t robot) const { return disks_[robot]; }
  /// The layers with everything that could touch `robot`, at least one. A query visits all of them.
  const std::vector<Layer>& layers(std::size_t robot) const { return classes_[class_of_[robot]].layers; }
  /// Whether any segment that is or was in the index changes its speed.
  bool has_ramps() const { return has_ramps_; }
  /// Null if no two robots are in contact.
  const Contacts* contacts() const { return contacts_; }

  void add(std::size_t robot, const std::vector<SizedSegment>& segments);
  /// Removes all segments of a robot.
  void remove(std::size_t robot);
  /// Visits leave out the segments of an ignored robot.
  void ignore(std::size_t robot, bool ignored) { ignored_[robot] = ignored; }

  /// Calls visit(occupant) for every occupant of a layer that could touch its robot in this bucket of the
  /// layer's grid within the open time window. Occupants that rest for ever come first, in the order in which
  /// they were added. The others follow by the beginning of their time windows, then in the order in which
  /// they were added. Stops and returns false when visit returns false; otherwise returns true.
  template <class Visitor>
  bool visit(const Layer& layer, std::size_t bucket, double t_begin, double t_end, Visitor&& visit) const {
    return visit_bucket(layer.buckets_[bucket], t_begin, t_end, visit);
  }

 private:
  /// Shorter lists are scanned from the front.
  static constexpr std::size_t kShortList = 16;

  /// The buckets for robots of about one size.
  struct RadiusClass {
    double radius;              // of the largest robot in the class
    std::vector<Layer> layers;  // by level: the first one, and others that have or had entries
  };

  DiskId store(std::size_t robot, const SizedSegment& segment, bool has_left);
  double size_of(int level) const;
  int level_of(const RadiusClass& radius_class, const Occupant& occupant) const;
  Layer& layer_of(RadiusClass& radius_class, int level) const;
  void enter(RadiusClass& radius_class, DiskId id);
  void leave(RadiusClass& radius_class, DiskId id);

  template <class Visitor>
  bool visit_bucket(const Bucket& bucket, double t_begin, double t_end, Visitor& visit) const {
    const auto pass = [&](const Occupant& occupant) { return ignored_[occupant.robot] || visit(occupant); };
    for (const DiskId id : bucket.resting) {
      if (occupants_[id].disk.t_start < t_end && !pass(occupants_[id])) return false;
    }
    auto entry = bucket.passing.begin();
    if (bucket.passing.size() > kShortList) {
      entry = std::lower_bound(bucket.passing.begin(), bucket.passing.end(), t_begin - bucket.longest,
                               [](const Entry& e, double t) { return e.t_begin < t; });
    }
    for (; entry != bucket.passing.end() && entry->t_begin < t_end; ++entry) {
      if (entry->t_end > t_begin && !pass(occupants_[entry->id])) return false;
    }
    return true;
  }

  std::vector<LargestDisk> disks_;  // by robot
  const Contacts* contacts_;
  double width_;        // metres, of the map
  double height_;       // metres
  double bucket_size_;  // metres, of the first layer
  std::vector<RadiusClass> classes_;
  std::vector<std::size_t> class_of_;  // by robot
  IndexedVector<Occupant, DiskId> occupants_;
  IndexedVector<std::uint64_t, DiskId> numbers_;  // of the occupants, among all that were ever added
  std::vector<DiskId> vacant_;
  std::vector<std::vector<DiskId>> held_;  // by robot
  std::vector<char> ignored_;              // by robot; not bool, for speed
  std::uint64_t added_ = 0;
  bool has_ramps_ = false;
};

}  // namespace fleetplan::core
