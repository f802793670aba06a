#include "core/reservation/segment_index.h"

#include <cmath>
#include <utility>

namespace fleetplan::core {
namespace {

/// More classes cost memory and time to reserve, fewer cost longer bucket lists.
constexpr std::size_t kMaxClasses = 6;
/// Buckets of all classes together, and of them for each robot, to bound memory and time on huge maps.
constexpr double kMaxBuckets = 2.5e5;
constexpr double kMaxBucketsPerRobot = 4096.0;

std::vector<double> pair_radii(const std::vector<LargestDisk>& disks) {
  std::vector<double> radii;
  radii.reserve(disks.size());
  for (const LargestDisk& disk : disks) radii.push_back(disk.pair_radius);
  return radii;
}

/// The class radii, ascending: the distinct radii if they are few, else evenly spread quantiles.
std::vector<double> class_radii(std::vector<double> radii) {
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  if (radii.size() <= kMaxClasses) return radii;
  std::vector<double> chosen;
  for (std::size_t k = 1; k <= kMaxClasses; ++k) chosen.push_back(radii[k * radii.size() / kMaxClasses - 1]);
  return chosen;
}

double bucket_size(double width, double height, double cell_size, const std::vector<double>& radii) {
  std::vector<double> sorted = radii;
  std::sort(sorted.begin(), sorted.end());
  const double typical = sorted.empty() ? cell_size : sorted[sorted.size() / 2];
  const auto classes = static_cast<double>(class_radii(radii).size());
  const auto robots = static_cast<double>(std::max<std::size_t>(radii.size(), 1));
  const double most = std::min(kMaxBuckets, kMaxBucketsPerRobot * robots);
  return std::max({cell_size, typical, std::sqrt(width * height * classes / most)});
}

}  // namespace

SegmentIndex::SegmentIndex(double width, double height, double cell_size, std::vector<LargestDisk> disks,
                           const Contacts* contacts)
    : disks_(std::move(disks)),
      contacts_(contacts),
      grid_(width, height, bucket_size(width, height, cell_size, pair_radii(disks_))),
      class_of_(disks_.size()),
      held_(disks_.size()),
      ignored_(disks_.size(), 0) {
  const std::vector<double> classes = class_radii(pair_radii(disks_));
  for (const double radius : classes) classes_.push_back({radius, std::vector<Bucket>(grid_.count())});
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    const auto it = std::lower_bound(classes.begin(), classes.end(), disks_[i].pair_radius);
    class_of_[i] = static_cast<std::size_t>(it - classes.begin());
  }
}

SegmentIndex::DiskId SegmentIndex::store(std::size_t robot, const SizedSegment& segment, bool has_left) {
  const Endpoint endpoint = contacts_ != nullptr
                                ? contacts_->endpoint(robot, segment.path, segment.radius, has_left)
                                : Endpoint::none;
  const double radius = disks_[robot].pair_radius_with(segment.radius);
  const Occupant occupant{MovingDisk(segment), radius, robot, endpoint};
  has_ramps_ = has_ramps_ || segment.ramp != 0.0;
  if (vacant_.empty()) return occupants_.push_back(occupant);
  const DiskId id = vacant_.back();
  vacant_.pop_back();
  occupants_[id] = occupant;
  return id;
}

void SegmentIndex::enter(RadiusClass& radius_class, DiskId id) {
  const Occupant& occupant = occupants_[id];
  const bool endless = occupant.disk.t_end == kForever;
  grid_.cover(occupant.disk, occupant.radius + radius_class.radius,
              [&](std::size_t index, double t_begin, double t_end) {
                Bucket& bucket = radius_class.buckets[index];
                if (endless) {
                  bucket.resting.push_back(id);
                  return;
                }
                const auto later =
                    std::upper_bound(bucket.passing.begin(), bucket.passing.end(), t_begin,
                                     [](double t, const Entry& entry) { return t < entry.t_begin; });
                bucket.passing.insert(later, {t_begin, t_end, id});
                bucket.longest = std::max(bucket.longest, t_end - t_begin);
              });
}

void SegmentIndex::add(std::size_t robot, const std::vector<SizedSegment>& segments) {
  // Bounded: the segments of one trajectory, and a few classes.
  bool has_left = false;
  for (const SizedSegment& segment : segments) {
    const DiskId id = store(robot, segment, has_left);
    held_[robot].push_back(id);
    for (RadiusClass& radius_class : classes_) enter(radius_class, id);
    has_left = has_left || segment.path.from != segment.path.to;
  }
}

void SegmentIndex::remove(std::size_t robot) {
  // Bounded: the segments of one trajectory, and a few classes.
  for (const DiskId id : held_[robot]) {
    const Occupant& occupant = occupants_[id];
    for (RadiusClass& radius_class : classes_) {
      grid_.cover(occupant.disk, occupant.radius + radius_class.radius,
                  [&](std::size_t index, double, double) {
                    Bucket& bucket = radius_class.buckets[index];
                    std::erase(bucket.resting, id);
                    std::erase_if(bucket.passing, [id](const Entry& entry) { return entry.id == id; });
                  });
    }
    vacant_.push_back(id);
  }
  held_[robot].clear();
}

}  // namespace fleetplan::core
