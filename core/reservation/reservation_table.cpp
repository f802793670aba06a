#include "core/reservation/reservation_table.h"

#include <algorithm>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/reservation/fixed_reservations.h"
#include "core/reservation/segment_index.h"

namespace fleetplan::core {
namespace {

/// Seconds; safe intervals that are shorter are left out. This covers the rounding between neighbouring
/// segments of one trajectory.
constexpr double kShortestSafeInterval = 1e-9;
/// Parts of fixed motion; with more of them, queries may be costly.
constexpr std::size_t kManyFixed = 10'000;

// A query asks SegmentIndex for the reservations that come and go, and FixedReservations for obstacles and
// committed motion. Both call a function for every moving disk (Occupant) that may come too near within a
// window of time, until it returns false.
//
// - SegmentIndex does so in one bucket of a layer. So a move walks the buckets of each layer on its path.
// - FixedReservations does so for a whole move.
//
// Each pair has its own distance, CollisionDistance or FixedDistance. disk_motion.h computes when two disks
// are nearer than that.

using Occupant = SegmentIndex::Occupant;

/// The distance of the centres below which a robot on a straight path, or standing, collides with others. Two
/// robots that begin or end too near to each other (Contacts) may be as near as that at these ends.
class CollisionDistance {
 public:
  CollisionDistance(const SegmentIndex& index, const Footprint& mine, const Segment& path)
      : robot_(mine.robot),
        radius_(index.disk(mine.robot).pair_radius_with(mine.radius)),
        contacts_(index.contacts()) {
    if (contacts_ != nullptr) terminal_ = contacts_->terminal(mine.robot, path, mine.radius, mine.has_left);
  }

  double operator()(const Occupant& other) const {
    const double full = radius_ + other.radius - kSearchSlack;
    if (terminal_ == Terminal::none) return full;
    return contacts_->distance(robot_, terminal_, other.robot, other.terminal, full);
  }

 private:
  std::size_t robot_;
  double radius_;  // to other robots
  const Contacts* contacts_;
  Terminal terminal_ = Terminal::none;
};

/// The interval margin of a robot that stands somewhere. What has passed before the robot's commitment ended
/// there needs none.
struct MarginAtRest {
  double margin;          // seconds
  double commitment_end;  // seconds, if the robot stands there

  UnsafeInterval widened(const UnsafeInterval& hit) const {
    if (margin == 0.0 || hit.end <= commitment_end + kSameTime) return hit;
    return {hit.begin - margin, hit.end + margin};
  }
};

/// Whether the two come closer than `reach` at times that differ by at most `margin` seconds.
bool meet(const MovingDisk& a, const MovingDisk& b, double reach, double margin) {
  if (collide(a, b, reach)) return true;
  if (margin == 0.0) return false;
  if (a.velocity.squaredNorm() > 0.0) {
    const UnsafeInterval hit =
        forbidden_departures(a.from, a.velocity, a.t_end - a.t_start, b, reach, a.ramp);
    return !hit.empty() && hit.begin - margin < a.t_start && a.t_start < hit.end + margin;
  }
  const UnsafeInterval hit = unsafe_interval(a.from, b, reach);
  return !hit.empty() && hit.begin - margin < a.t_end && a.t_start < hit.end + margin;
}

std::vector<std::size_t> ascending(std::vector<std::size_t> all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

/// A straight move whose departure is delayed past others.
class ReservationTable::DelayedMove {
 public:
  DelayedMove(const Segment& path, double duration, double t_min, double t_max, double ramp)
      : duration_(duration), t_max_(t_max) {
    mine_.from = path.from;
    mine_.velocity = (path.to - path.from) / duration;
    mine_.t_start = t_min;
    mine_.t_end = t_min + duration;
    mine_.ramp = ramp;
  }

  const MovingDisk& disk() const { return mine_; }
  bool is_never() const { return never_; }
  /// Whether it has been delayed since the last round began.
  bool is_delayed() const { return delayed_; }
  void begin_round() { delayed_ = false; }

  /// Returns false if the move was delayed: then others may be in the way.
  bool delay_past(const MovingDisk& other, double distance, double margin) {
    if (margin > 0.0) return delay_past_with_margin(other, distance, margin);
    if (!collide(mine_, other, distance)) return true;
    const UnsafeInterval hit =
        forbidden_departures(mine_.from, mine_.velocity, duration_, other, distance, mine_.ramp);
    if (hit.empty() || is_outside(hit)) return true;
    if (other.t_end == kForever) {  // a later departure meets it as well
      never_ = true;
      return false;
    }
    delay_to(hit.end);
    return false;
  }

 private:
  bool delay_past_with_margin(const MovingDisk& other, double distance, double margin) {
    const UnsafeInterval hit =
        forbidden_departures(mine_.from, mine_.velocity, duration_, other, distance, mine_.ramp);
    if (hit.empty() || is_outside({hit.begin - margin, hit.end + margin})) return true;
    delay_to(hit.end + margin);
    return false;
  }

  /// Whether they only touch, up to rounding. The other robot may have been planned to pass just behind.
  bool is_outside(const UnsafeInterval& hit) const {
    return mine_.t_start <= hit.begin + kSameTime || hit.end <= mine_.t_start;
  }

  void delay_to(double t) {
    mine_.t_start = t;
    mine_.t_end = t + duration_;
    never_ = t > t_max_ || t == kForever;
    delayed_ = true;
  }

  MovingDisk mine_;
  double duration_;
  double t_max_;
  bool never_ = false;
  bool delayed_ = true;
};

/// The distance of the centres below which a robot on a straight path, or standing, collides with obstacles
/// and committed motion.
class ReservationTable::FixedDistance {
 public:
  FixedDistance(const ReservationTable& table, const Footprint& mine, const Segment& path)
      : fixed_(*table.fixed_),
        contacts_(table.index_->contacts()),
        robot_(mine.robot),
        radius_(mine.radius),
        pair_radius_(table.index_->disk(robot_).pair_radius_with(radius_)),
        begins_at_commitment_end_(fixed_.begins_at_commitment_end(robot_, path.from)),
        stays_(begins_at_commitment_end_ && path.from == path.to &&
               radius_ == fixed_.robot(robot_).radius_at_committed_end) {
    if (contacts_ != nullptr) terminal_ = contacts_->terminal(robot_, path, radius_, mine.has_left);
  }

  /// Inflation is for pairs of robots that may choose. A robot that still stands where its commitment ends
  /// need not leave because committed motion passes within only the inflated distance.
  double operator()(const FixedReservations::Occupant& other) const {
    if (other.is_obstacle) {
      const double slack = begins_at_commitment_end_ ? kContactTolerance : kSearchSlack;
      return radius_ + other.radius - slack;
    }
    double distance = pair_radius_ + other.pair_radius - kSearchSlack;
    if (terminal_ != Terminal::none) {
      distance = contacts_->distance(robot_, terminal_, other.index, other.terminal, distance);
    }
    if (!stays_) return distance;
    distance = std::min(distance, radius_ + other.radius - kContactTolerance);
    const FixedReservations::Committed& mine = fixed_.robot(robot_);
    const bool is_at_start = mine.start == mine.committed_end && radius_ == mine.radius_at_start;
    if (!other.from_start || !is_at_start) return distance;
    const Position& their_start = fixed_.robot(other.index).start;
    return std::min(distance, (mine.start - their_start).norm() - 2.0 * kSamePosition);
  }

 private:
  const FixedReservations& fixed_;
  const Contacts* contacts_;
  std::size_t robot_;
  double radius_;
  double pair_radius_;
  bool begins_at_commitment_end_;
  bool stays_;
  Terminal terminal_ = Terminal::none;
};

ReservationTable::ReservationTable(double width, double height, double cell_size,
                                   std::vector<LargestDisk> disks, const Contacts* contacts,
                                   const FixedReservations* fixed, double interval_margin)
    : index_(std::make_unique<SegmentIndex>(width, height, cell_size, std::move(disks), contacts)),
      fixed_(fixed),
      margin_(interval_margin) {}

ReservationTable::~ReservationTable() = default;

/// Departures past robots that change their speed are found by bisection.
bool ReservationTable::is_costly() const {
  if (index_->has_ramps()) return true;
  return fixed_ != nullptr && (fixed_->count() > kManyFixed || fixed_->has_ramps());
}

double ReservationTable::commitment_end(std::size_t robot) const {
  return fixed_ != nullptr ? fixed_->robot(robot).committed_until : 0.0;
}

bool ReservationTable::begins_at_commitment_end(std::size_t robot, const Position& from) const {
  return fixed_ != nullptr && fixed_->begins_at_commitment_end(robot, from);
}

void ReservationTable::reserve(std::size_t robot, const std::vector<SizedSegment>& segments) {
  index_->add(robot, segments);
}

void ReservationTable::remove(std::size_t robot) { index_->remove(robot); }

void ReservationTable::ignore(std::size_t robot, bool ignored) { index_->ignore(robot, ignored); }

std::vector<SafeInterval> ReservationTable::safe_intervals(const Footprint& footprint,
                                                           const Position& position, double t_from) const {
  const std::size_t robot = footprint.robot;
  std::vector<UnsafeInterval> unsafe;
  const MarginAtRest margin{margin_, begins_at_commitment_end(robot, position) ? commitment_end(robot) : 0.0};
  const Segment here{position, position};
  const CollisionDistance collision_distance(*index_, footprint, here);
  for (const SegmentIndex::Layer& layer : index_->layers(robot)) {
    index_->visit(
        layer, layer.grid().at(position), t_from - margin_ - kSameTime, kForever, [&](const Occupant& other) {
          const UnsafeInterval hit = unsafe_interval(position, other.disk, collision_distance(other));
          if (!hit.empty()) unsafe.push_back(margin.widened(hit));
          return true;
        });
  }
  if (fixed_ != nullptr) {
    if (!fixed_->known()) return {};
    const FixedDistance fixed_distance(*this, footprint, here);
    const MovingDisk mine({here, 0.0, kForever});
    fixed_->visit(robot, mine, index_->disk(robot).pair_radius, 0.0,
                  [&](const FixedReservations::Occupant& other) {
                    const UnsafeInterval hit = unsafe_interval(position, other.disk, fixed_distance(other));
                    if (!hit.empty()) unsafe.push_back(other.is_obstacle ? hit : margin.widened(hit));
                    return true;
                  });
  }
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

std::optional<double> ReservationTable::earliest_departure(const Footprint& footprint, const Segment& path,
                                                           double duration, double t_min, double t_max,
                                                           double ramp) const {
  const SegmentIndex& index = *index_;
  const std::size_t robot = footprint.robot;
  const CollisionDistance collision_distance(index, footprint, path);
  DelayedMove move(path, duration, t_min, t_max, ramp);
  const MovingDisk& mine = move.disk();
  const auto visit = [&](const Occupant& other) {
    return move.delay_past(other.disk, collision_distance(other), margin_);
  };
  const bool has_ramp = ramp != 0.0;
  // Bounded: each round is later than a reservation that the one before met.
  while (move.is_delayed()) {
    move.begin_round();
    for (const SegmentIndex::Layer& layer : index.layers(robot)) {
      layer.grid().walk(path.from, path.to, [&](std::size_t bucket, double enter, double exit) {
        if (has_ramp) [[unlikely]] {
          enter = elapsed_share(enter, ramp);
          exit = elapsed_share(exit, ramp);
        }
        while (!index.visit(layer, bucket, mine.t_start + enter * duration - margin_,
                            mine.t_start + exit * duration + margin_, visit)) {
          if (move.is_never()) return false;
        }
        return true;
      });
      if (move.is_never()) return std::nullopt;
    }
    if (fixed_ != nullptr && !delay_past_fixed(footprint, path, move)) return std::nullopt;
  }
  return mine.t_start;
}

/// Returns false if the move is never possible.
bool ReservationTable::delay_past_fixed(const Footprint& footprint, const Segment& path,
                                        DelayedMove& move) const {
  if (!fixed_->known()) return false;
  const std::size_t robot = footprint.robot;
  const FixedDistance fixed_distance(*this, footprint, path);
  const auto visit = [&](const FixedReservations::Occupant& other) {
    return move.delay_past(other.disk, fixed_distance(other), other.is_obstacle ? 0.0 : margin_);
  };
  while (!fixed_->visit(robot, move.disk(), index_->disk(robot).pair_radius, margin_, visit)) {
    if (move.is_never()) return false;
  }
  return true;
}

std::vector<std::size_t> ReservationTable::robots_hit(std::size_t robot,
                                                      const std::vector<SizedSegment>& segments) const {
  std::vector<std::size_t> hit;
  Footprint footprint{robot};
  for (const SizedSegment& segment : segments) {
    const MovingDisk mine(segment);
    footprint.radius = segment.radius;
    const CollisionDistance collision_distance(*index_, footprint, segment.path);
    footprint.has_left = footprint.has_left || segment.path.from != segment.path.to;
    const bool moving = mine.velocity.squaredNorm() > 0.0;
    const double duration = moving ? segment.duration() : 0.0;
    const double margin = margin_of(robot, segment);
    const auto visit = [&](const Occupant& other) {
      const double reach = std::max(0.0, collision_distance(other) - kSearchSlack);  // rounding
      if (other.robot != robot && meet(mine, other.disk, reach, margin)) hit.push_back(other.robot);
      return true;
    };
    // Bounded: a few layers.
    for (const SegmentIndex::Layer& layer : index_->layers(robot)) {
      layer.grid().walk(
          segment.path.from, segment.path.to, [&](std::size_t bucket, double enter, double exit) {
            const double t_begin = mine.t_start + elapsed_share(enter, mine.ramp) * duration - margin;
            const double t_end =
                (moving ? mine.t_start + elapsed_share(exit, mine.ramp) * duration : mine.t_end) + margin;
            return index_->visit(layer, bucket, t_begin, t_end, visit);
          });
    }
  }
  return ascending(std::move(hit));
}

std::vector<std::size_t> ReservationTable::robots_certainly_hit(
    std::size_t robot, const std::vector<SizedSegment>& segments) const {
  std::vector<std::size_t> hit;
  if (fixed_ == nullptr) return hit;
  Footprint footprint{robot};
  for (const SizedSegment& segment : segments) {
    const MovingDisk mine(segment);
    const double margin = margin_of(robot, segment);
    footprint.radius = segment.radius;
    const FixedDistance fixed_distance(*this, footprint, segment.path);
    footprint.has_left = footprint.has_left || segment.path.from != segment.path.to;
    fixed_->visit(robot, mine, index_->disk(robot).pair_radius, margin,
                  [&](const FixedReservations::Occupant& other) {
                    if (!other.is_obstacle && meet(mine, other.disk, fixed_distance(other), margin))
                      hit.push_back(other.index);
                    return true;
                  });
  }
  return ascending(std::move(hit));
}

/// A robot that has not yet left the place where its commitment ends needs no margin.
double ReservationTable::margin_of(std::size_t robot, const TimedSegment& segment) const {
  const bool stays = segment.path.from == segment.path.to && segment.t_start <= commitment_end(robot);
  return stays ? 0.0 : margin_;
}

}  // namespace fleetplan::core
