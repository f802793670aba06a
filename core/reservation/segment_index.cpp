#include "core/reservation/segment_index.h"

#include <cmath>
#include <utility>

namespace fleetplan::core {
namespace {

/// More classes cost memory and time to reserve, fewer cost longer bucket lists.
constexpr std::size_t kMaxClasses = 6;
/// The side of a bucket in cells, and in typical radii. With smaller buckets, a disk is entered into more of
/// them, and a move visits more. Larger buckets have longer lists.
constexpr double kSideRatio = 2.0;
/// Buckets of all classes together, and of them for each robot, to bound memory and time on huge maps.
constexpr double kMaxBuckets = 2.5e5;
constexpr double kMaxBucketsPerRobot = 4096.0;
/// The sides of buckets within which a disk at rest is entered: into a few hundred buckets of its layer.
constexpr double kMaxReach = 8.0;
/// The ratio of a bucket's side to the side of buckets in the layer before, as a power of 2.
constexpr int kLayerExponent = 2;

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
  const double max_buckets = std::min(kMaxBuckets, kMaxBucketsPerRobot * robots);
  return std::max(kSideRatio * std::max(cell_size, typical),
                  std::sqrt(width * height * classes / max_buckets));
}

}  // namespace

SegmentIndex::SegmentIndex(double width, double height, double cell_size, std::vector<LargestDisk> disks,
                           const Contacts* contacts)
    : disks_(std::move(disks)),
      contacts_(contacts),
      width_(width),
      height_(height),
      bucket_size_(bucket_size(width, height, cell_size, pair_radii(disks_))),
      class_of_(disks_.size()),
      held_(disks_.size()),
      ignored_(disks_.size(), 0) {
  const std::vector<double> classes = class_radii(pair_radii(disks_));
  const BucketGrid grid(width, height, bucket_size_);
  for (const double radius : classes) classes_.push_back({radius, {Layer(0, grid)}});
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    const auto it = std::lower_bound(classes.begin(), classes.end(), disks_[i].pair_radius);
    class_of_[i] = static_cast<std::size_t>(it - classes.begin());
  }
}

SegmentIndex::DiskId SegmentIndex::store(std::size_t robot, const SizedSegment& segment, bool has_left) {
  const Terminal terminal = contacts_ != nullptr
                                ? contacts_->terminal(robot, segment.path, segment.radius, has_left)
                                : Terminal::none;
  const double radius = disks_[robot].pair_radius_with(segment.radius);
  const Occupant occupant{MovingDisk(segment), radius, robot, terminal};
  has_ramps_ = has_ramps_ || segment.ramp != 0.0;
  if (vacant_.empty()) {
    numbers_.resize(occupants_.size() + 1);  // first, as memory may be spent
    const DiskId id = occupants_.push_back(occupant);
    numbers_[id] = added_++;
    return id;
  }
  const DiskId id = vacant_.back();
  vacant_.pop_back();
  occupants_[id] = occupant;
  numbers_[id] = added_++;
  return id;
}

double SegmentIndex::size_of(int level) const { return std::ldexp(bucket_size_, kLayerExponent * level); }

/// Of the layer in which robots of the class meet the occupant.
int SegmentIndex::level_of(const RadiusClass& radius_class, const Occupant& occupant) const {
  const double reach = occupant.radius + radius_class.radius + occupant.disk.sag();
  const double most = std::max(width_, height_);
  int level = 0;
  while (reach > kMaxReach * size_of(level) && size_of(level) < most) ++level;
  return level;
}

SegmentIndex::Layer& SegmentIndex::layer_of(RadiusClass& radius_class, int level) const {
  std::vector<Layer>& layers = radius_class.layers;
  const auto at = std::find_if(layers.begin(), layers.end(), [&](auto& l) { return l.level_ >= level; });
  if (at != layers.end() && at->level_ == level) return *at;
  return *layers.insert(at, Layer(level, BucketGrid(width_, height_, size_of(level))));
}

void SegmentIndex::enter(RadiusClass& radius_class, DiskId id) {
  const Occupant& occupant = occupants_[id];
  const bool endless = occupant.disk.t_end == kForever;
  Layer& layer = layer_of(radius_class, level_of(radius_class, occupant));
  layer.grid_.cover(occupant.disk, occupant.radius + radius_class.radius,
                    [&](std::size_t index, double t_begin, double t_end) {
                      Bucket& bucket = layer.buckets_[index];
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

/// Undoes enter(). Time windows are computed again, which gives the same ones. Where memory was spent before
/// the disk was entered, there is no entry.
void SegmentIndex::leave(RadiusClass& radius_class, DiskId id) {
  const Occupant& occupant = occupants_[id];
  const bool endless = occupant.disk.t_end == kForever;
  const auto is_earlier = [&](DiskId other) { return numbers_[other] < numbers_[id]; };
  const int level = level_of(radius_class, occupant);
  std::vector<Layer>& layers = radius_class.layers;
  const auto layer = std::find_if(layers.begin(), layers.end(), [&](auto& l) { return l.level_ == level; });
  if (layer == layers.end()) return;
  layer->grid_.cover(
      occupant.disk, occupant.radius + radius_class.radius, [&](std::size_t index, double t_begin, double) {
        if (endless) {
          std::vector<DiskId>& resting = layer->buckets_[index].resting;
          const auto at = std::partition_point(resting.begin(), resting.end(), is_earlier);
          if (at != resting.end() && *at == id) resting.erase(at);
          return;
        }
        std::vector<Entry>& passing = layer->buckets_[index].passing;
        const auto at = std::partition_point(passing.begin(), passing.end(), [&](const Entry& entry) {
          return entry.t_begin == t_begin ? is_earlier(entry.id) : entry.t_begin < t_begin;
        });
        if (at != passing.end() && at->id == id) passing.erase(at);
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
    for (RadiusClass& radius_class : classes_) leave(radius_class, id);
    vacant_.push_back(id);
  }
  held_[robot].clear();
}

}  // namespace fleetplan::core
