#include "core/reservation/reservation_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// More classes cost memory and commit time, fewer cost longer bucket lists.
constexpr std::size_t kMaxLayers = 6;
/// Buckets of all layers together, to bound memory on huge maps.
constexpr double kMaxBuckets = 1.5e6;
/// Shorter lists are scanned from the front.
constexpr std::size_t kShortList = 16;
/// Unsafe intervals nearer than this belong together, and safe intervals shorter than this are left out
/// (seconds): it covers the rounding between the neighbouring segments of one trajectory.
constexpr double kShortestSafeInterval = 1e-9;

/// The class radii, ascending: the distinct radii if they are few, else evenly spread quantiles.
std::vector<double> class_radii(std::vector<double> radii) {
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  if (radii.size() <= kMaxLayers) return radii;
  std::vector<double> chosen;
  for (std::size_t k = 1; k <= kMaxLayers; ++k) chosen.push_back(radii[k * radii.size() / kMaxLayers - 1]);
  return chosen;
}

double bucket_size(double width, double height, double cell_size, const std::vector<double>& radii) {
  std::vector<double> sorted = radii;
  std::sort(sorted.begin(), sorted.end());
  const double typical = sorted.empty() ? cell_size : sorted[sorted.size() / 2];
  const auto layers = static_cast<double>(class_radii(radii).size());
  return std::max({cell_size, typical, std::sqrt(width * height * layers / kMaxBuckets)});
}

}  // namespace

ReservationTable::ReservationTable(double width, double height, double cell_size, std::vector<double> radii)
    : radii_(std::move(radii)),
      grid_(width, height, bucket_size(width, height, cell_size, radii_)),
      layer_of_(radii_.size()),
      held_(radii_.size()),
      ignored_(radii_.size(), 0) {
  const std::vector<double> classes = class_radii(radii_);
  for (const double radius : classes) layers_.push_back({radius, std::vector<Bucket>(grid_.count())});
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    const auto it = std::lower_bound(classes.begin(), classes.end(), radii_[i]);
    layer_of_[i] = static_cast<std::size_t>(it - classes.begin());
  }
}

ReservationTable::DiskId ReservationTable::store(std::size_t robot, const TimedSegment& segment) {
  const Occupant occupant{MovingDisk(segment), radii_[robot], robot};
  if (vacant_.empty()) {
    occupants_.push_back(occupant);
    return static_cast<DiskId>(occupants_.size() - 1);
  }
  const DiskId id = vacant_.back();
  vacant_.pop_back();
  occupants_[id] = occupant;
  return id;
}

void ReservationTable::enter(Layer& layer, DiskId id) {
  const Occupant& occupant = occupants_[id];
  const bool endless = occupant.disk.t_end == kForever;
  grid_.cover(
      occupant.disk, occupant.radius + layer.radius, [&](std::size_t index, double t_begin, double t_end) {
        Bucket& bucket = layer.buckets[index];
        if (endless) {
          bucket.resting.push_back(id);
          return;
        }
        const auto later = std::upper_bound(bucket.passing.begin(), bucket.passing.end(), t_begin,
                                            [](double t, const Entry& entry) { return t < entry.t_begin; });
        bucket.passing.insert(later, {t_begin, t_end, id});
        bucket.longest = std::max(bucket.longest, t_end - t_begin);
      });
}

void ReservationTable::commit(std::size_t robot, const std::vector<TimedSegment>& segments) {
  for (const TimedSegment& segment : segments) {
    const DiskId id = store(robot, segment);
    held_[robot].push_back(id);
    for (Layer& layer : layers_) enter(layer, id);
  }
}

void ReservationTable::remove(std::size_t robot) {
  for (const DiskId id : held_[robot]) {
    const Occupant& occupant = occupants_[id];
    for (Layer& layer : layers_) {
      grid_.cover(occupant.disk, occupant.radius + layer.radius, [&](std::size_t index, double, double) {
        Bucket& bucket = layer.buckets[index];
        std::erase(bucket.resting, id);
        std::erase_if(bucket.passing, [id](const Entry& entry) { return entry.id == id; });
      });
    }
    vacant_.push_back(id);
  }
  held_[robot].clear();
}

double ReservationTable::reach(std::size_t robot, const Occupant& other) const {
  return radii_[robot] + other.radius - kSearchSlack;
}

template <class Visit>
bool ReservationTable::visit_bucket(const Bucket& bucket, double t_begin, double t_end, Visit&& visit) const {
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

std::vector<SafeInterval> ReservationTable::safe_intervals(std::size_t robot,
                                                           const Position& position) const {
  std::vector<UnsafeInterval> unsafe;
  const Bucket& bucket = layers_[layer_of_[robot]].buckets[grid_.at(position)];
  visit_bucket(bucket, -1.0, kForever, [&](const Occupant& other) {
    const UnsafeInterval hit = unsafe_interval(position, other.disk, reach(robot, other));
    if (!hit.empty()) unsafe.push_back(hit);
    return true;
  });
  std::sort(unsafe.begin(), unsafe.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  std::vector<SafeInterval> safe;
  double free_from = 0.0;
  for (const UnsafeInterval& hit : unsafe) {
    if (hit.begin > free_from + kShortestSafeInterval) safe.push_back({free_from, hit.begin});
    free_from = std::max(free_from, hit.end);
  }
  if (free_from < kForever) safe.push_back({free_from, kForever});
  return safe;
}

std::optional<double> ReservationTable::earliest_departure(std::size_t robot, const Segment& path,
                                                           double duration, double t_min,
                                                           double t_max) const {
  const Layer& layer = layers_[layer_of_[robot]];
  MovingDisk mine;
  mine.from = path.from;
  mine.velocity = (path.to - path.from) / duration;
  mine.t_start = t_min;
  mine.t_end = t_min + duration;
  bool never = false;
  bool delayed = true;
  const auto delay_past = [&](const Occupant& other) {  // false: delayed, look at the same bucket again
    const double distance = reach(robot, other);
    if (!collide(mine, other.disk, distance)) return true;
    if (other.disk.t_end == kForever) {  // whoever comes later meets it as well
      never = true;
      return false;
    }
    const UnsafeInterval hit = forbidden_departures(mine.from, mine.velocity, duration, other.disk, distance);
    if (hit.empty() || hit.end <= mine.t_start) return true;  // grazing, to within rounding
    mine.t_start = hit.end;
    mine.t_end = hit.end + duration;
    never = mine.t_start > t_max;
    delayed = true;
    return false;
  };
  while (delayed) {
    delayed = false;
    grid_.walk(path.from, path.to, [&](std::size_t bucket, double enter, double exit) {
      while (!visit_bucket(layer.buckets[bucket], mine.t_start + enter * duration,
                           mine.t_start + exit * duration, delay_past)) {
        if (never) return false;
      }
      return true;
    });
    if (never) return std::nullopt;
  }
  return mine.t_start;
}

std::vector<std::size_t> ReservationTable::robots_hit(std::size_t robot,
                                                      const std::vector<TimedSegment>& segments) const {
  std::vector<std::size_t> hit;
  const Layer& layer = layers_[layer_of_[robot]];
  for (const TimedSegment& segment : segments) {
    const MovingDisk mine(segment);
    const bool moving = mine.velocity.squaredNorm() > 0.0;
    const double duration = moving ? segment.duration() : 0.0;
    grid_.walk(segment.path.from, segment.path.to, [&](std::size_t bucket, double enter, double exit) {
      const double t_begin = mine.t_start + enter * duration;
      const double t_end = moving ? mine.t_start + exit * duration : mine.t_end;
      return visit_bucket(layer.buckets[bucket], t_begin, t_end, [&](const Occupant& other) {
        if (other.robot != robot && collide(mine, other.disk, reach(robot, other)))
          hit.push_back(other.robot);
        return true;
      });
    });
  }
  std::sort(hit.begin(), hit.end());
  hit.erase(std::unique(hit.begin(), hit.end()), hit.end());
  return hit;
}

}  // namespace fleetplan::core
