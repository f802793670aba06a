#include "core/reservation/reservation_table.h"

#include <algorithm>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/reservation/segment_index.h"

namespace fleetplan::core {
namespace {

/// Seconds; safe intervals that are shorter are left out. This covers the rounding between neighbouring
/// segments of one trajectory.
constexpr double kShortestSafeInterval = 1e-9;

using Occupant = SegmentIndex::Occupant;

/// The distance of the centres below which a robot on a straight path, or standing, collides with others.
class CollisionDistance {
 public:
  CollisionDistance(const SegmentIndex& index, std::size_t robot, const Segment& path)
      : robot_(robot), radius_(index.radius(robot)), contacts_(index.contacts()) {
    if (contacts_ != nullptr) endpoint_ = contacts_->endpoint(robot, path);
  }

  double operator()(const Occupant& other) const {
    const double full = radius_ + other.radius - kSearchSlack;
    if (endpoint_ == Endpoint::none) return full;
    return contacts_->distance(robot_, endpoint_, other.robot, other.endpoint, full);
  }

 private:
  std::size_t robot_;
  double radius_;
  const Contacts* contacts_;
  Endpoint endpoint_ = Endpoint::none;
};

}  // namespace

ReservationTable::ReservationTable(double width, double height, double cell_size, std::vector<double> radii,
                                   const Contacts* contacts)
    : index_(std::make_unique<SegmentIndex>(width, height, cell_size, std::move(radii), contacts)) {}

ReservationTable::~ReservationTable() = default;

void ReservationTable::commit(std::size_t robot, const std::vector<TimedSegment>& segments) {
  index_->add(robot, segments, false);
}

void ReservationTable::commit_certain(std::size_t robot, const std::vector<TimedSegment>& segments) {
  index_->add(robot, segments, true);
}

void ReservationTable::remove(std::size_t robot) { index_->remove(robot); }

void ReservationTable::ignore(std::size_t robot, bool ignored) { index_->ignore(robot, ignored); }

std::vector<SafeInterval> ReservationTable::safe_intervals(std::size_t robot,
                                                           const Position& position) const {
  std::vector<UnsafeInterval> unsafe;
  const CollisionDistance collision_distance(*index_, robot, {position, position});
  index_->visit(robot, index_->grid().at(position), -1.0, kForever, [&](const Occupant& other) {
    const UnsafeInterval hit = unsafe_interval(position, other.disk, collision_distance(other));
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
  const SegmentIndex& index = *index_;
  const CollisionDistance collision_distance(index, robot, path);
  MovingDisk mine;
  mine.from = path.from;
  mine.velocity = (path.to - path.from) / duration;
  mine.t_start = t_min;
  mine.t_end = t_min + duration;
  bool never = false;
  bool delayed = true;
  const auto delay_past = [&](const Occupant& other) {  // false: delayed, visit the same bucket again
    const double distance = collision_distance(other);
    if (!collide(mine, other.disk, distance)) return true;
    if (other.disk.t_end == kForever) {  // a later departure meets it as well
      never = true;
      return false;
    }
    const UnsafeInterval hit = forbidden_departures(mine.from, mine.velocity, duration, other.disk, distance);
    if (hit.empty() || hit.end <= mine.t_start) return true;  // they only touch, up to rounding
    mine.t_start = hit.end;
    mine.t_end = hit.end + duration;
    never = mine.t_start > t_max;
    delayed = true;
    return false;
  };
  while (delayed) {
    delayed = false;
    index.grid().walk(path.from, path.to, [&](std::size_t bucket, double enter, double exit) {
      while (!index.visit(robot, bucket, mine.t_start + enter * duration, mine.t_start + exit * duration,
                          delay_past)) {
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
  return hits(robot, segments, false);
}

std::vector<std::size_t> ReservationTable::robots_certainly_hit(
    std::size_t robot, const std::vector<TimedSegment>& segments) const {
  return hits(robot, segments, true);
}

std::vector<std::size_t> ReservationTable::hits(std::size_t robot, const std::vector<TimedSegment>& segments,
                                                bool certain) const {
  std::vector<std::size_t> hit;
  for (const TimedSegment& segment : segments) {
    const CollisionDistance collision_distance(*index_, robot, segment.path);
    const MovingDisk mine(segment);
    const bool moving = mine.velocity.squaredNorm() > 0.0;
    const double duration = moving ? segment.duration() : 0.0;
    index_->grid().walk(
        segment.path.from, segment.path.to, [&](std::size_t bucket, double enter, double exit) {
          const double t_begin = mine.t_start + enter * duration;
          const double t_end = moving ? mine.t_start + exit * duration : mine.t_end;
          return index_->visit(robot, bucket, t_begin, t_end, [&](const Occupant& other) {
            if (other.certain == certain && collide(mine, other.disk, collision_distance(other)))
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
