#include "core/execution/pair_dependencies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/disk_motion.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kLooksBetweenPolls = 1024;
/// The most buckets, which bounds memory on huge maps.
constexpr double kMostBuckets = 2.5e5;

double largest_radius(const std::vector<std::vector<PlannedStretch>>& by_robot) {
  double largest = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) largest = std::max(largest, stretch.radius);
  }
  return largest;
}

/// Returns a grid that covers all places of all robots.
BucketGrid grid_of(const std::vector<std::vector<PlannedStretch>>& by_robot, double radius) {
  double width = 0.0;
  double height = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) {
      width = std::max(width, stretch.planned.path.to.x());
      height = std::max(height, stretch.planned.path.to.y());
    }
  }
  const double size = std::max(
      {2.0 * radius, std::sqrt(width * height / kMostBuckets), width / kMostBuckets, height / kMostBuckets});
  return {width, height, size};
}

}  // namespace

NearStretches::NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot)
    : by_robot_(by_robot),
      largest_radius_(largest_radius(by_robot)),
      grid_(grid_of(by_robot, largest_radius_)),
      buckets_(grid_.count()) {}

std::optional<std::vector<NearRobot>> NearStretches::near(std::size_t robot, const StopCondition& stop) {
  std::vector<std::vector<NearPair>> by_other(by_robot_.size());
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    if (!find_near(robot, index, by_other, stop)) return std::nullopt;
  }
  std::vector<NearRobot> found;
  for (std::size_t other = 0; other < by_other.size(); ++other) {
    if (!by_other[other].empty()) found.push_back({other, std::move(by_other[other])});
  }
  return found;
}

bool NearStretches::find_near(std::size_t robot, std::size_t stretch,
                              std::vector<std::vector<NearPair>>& by_other, const StopCondition& stop) {
  const PlannedStretch& mine = by_robot_[robot][stretch];
  ++asked_;
  const auto look_into = [&](std::size_t bucket, double, double) {
    if (stops_after(1 + buckets_[bucket].size(), stop)) return;
    for (const std::uint32_t id : buckets_[bucket]) {
      Entry& entry = entries_[id];
      if (entry.asked == asked_) continue;
      entry.asked = asked_;
      const PlannedStretch& other = by_robot_[entry.robot][entry.stretch];
      const NearestShares nearest = nearest_shares(other.planned.path, mine.planned.path);
      if (nearest.distance >= other.radius + mine.radius) continue;
      by_other[entry.robot].push_back(
          {static_cast<std::uint32_t>(entry.stretch), static_cast<std::uint32_t>(stretch)});
    }
  };
  // Only the place matters, so the stretch is given a duration of one second.
  grid_.cover(MovingDisk({mine.planned.path, 0.0, 1.0}), mine.radius + largest_radius_, look_into);
  return !stopped_;
}

bool NearStretches::add(std::size_t robot, const StopCondition& stop) {
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    const Segment& path = by_robot_[robot][index].planned.path;
    const auto id = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({robot, index});
    const bool added = grid_.walk(path.from, path.to, [&](std::size_t bucket, double, double) {
      buckets_[bucket].push_back(id);
      return !stops_after(1, stop);
    });
    if (!added) return false;
  }
  return true;
}

bool NearStretches::stops_after(std::size_t looks, const StopCondition& stop) {
  looks_ += looks;
  if (looks_ < kLooksBetweenPolls) return stopped_;
  looks_ = 0;
  return stopped_ = stopped_ || stop.met();
}

namespace {

/// The time at which two robots that follow their plans are nearest during two stretches, and their distance.
struct NearestInTime {
  double t = 0.0;
  double distance = kForever;
};

NearestInTime nearest_in_time(const MovingDisk& first, const MovingDisk& second) {
  const double begin = std::max(first.t_start, second.t_start);
  const double end = std::min(first.t_end, second.t_end);
  if (begin > end || begin == kForever) return {};
  if (first.ramp != 0.0 || second.ramp != 0.0) {
    const Approach nearest = nearest_approach(first, second);
    return {nearest.t, nearest.distance};
  }
  const Position offset = first.at(begin) - second.at(begin);
  const Position velocity = first.velocity - second.velocity;
  const double square = velocity.squaredNorm();
  const double after = square > 0.0 ? std::clamp(-offset.dot(velocity) / square, 0.0, end - begin) : 0.0;
  return {begin + after, (offset + after * velocity).norm()};
}

/// A share of a distance: a region that is smaller by this share lies beside the plan that touches its
/// border, despite rounding.
constexpr double kJustLess = 1.0 - 1e-9;

/// Seconds: two stretches that are farther apart in time than this are ordered, whatever the rounding of
/// their ends.
constexpr double kSurely = 1e-3;
constexpr std::size_t kPairsBetweenPolls = 256;

/// The regions of two robots that still matter. A region that the first robot passes first means: while that
/// robot has not left its stretch, the second one does not enter its own. A region of a later stretch of the
/// first robot and an earlier stretch of the second one implies this at all times; then the first region is
/// left out.
class PairRegions {
 public:
  PairRegions(const PacedRobot& first, const PacedRobot& second, double tolerance)
      : first_(first), second_(second), tolerance_(tolerance) {}

  /// Adds the regions of pairs of stretches. Returns false if the stop condition is met.
  bool add(std::span<const NearPair> near, const StopCondition& stop) {
    return add_first_goes(near, stop) && add_second_goes(near, stop);
  }

  const std::vector<PassedRegion>& first_goes() const { return first_goes_; }
  const std::vector<PassedRegion>& second_goes() const { return second_goes_; }

  /// The times at which the plan brings the two nearer than they should be.
  const std::vector<Tightness>& too_near() const { return too_near_; }

 private:
  /// Adds the regions that the first robot passes first, by ascending stretches of the second robot.
  bool add_first_goes(std::span<const NearPair> near, const StopCondition& stop) {
    std::uint32_t stretch = 0;
    std::uint32_t reached = 0;  // the last stretch of the first robot in a region with an earlier one
    std::uint32_t reached_here = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (k % kPairsBetweenPolls == 0 && stop.met()) return false;
      const NearPair& pair = near[k];
      if (pair.stretch != stretch) reached = std::max(reached, reached_here);
      stretch = pair.stretch;
      if (pair.other_stretch < reached) continue;
      const PlannedStretch& a = first_.stretches[pair.other_stretch];
      const PlannedStretch& b = second_.stretches[pair.stretch];
      if (is_surely_before(b, a)) continue;
      const double kept_apart = distance(a, b, &too_near_);
      const auto nearest = crossing(a, b, kept_apart);
      if (!nearest || !first_is_first(a, b, *nearest)) continue;
      first_goes_.push_back(region(a, b, kept_apart));
      if (first_goes_.back().is_open()) reached_here = std::max(reached_here, pair.other_stretch);
    }
    return true;
  }

  /// Adds the regions that the second robot passes first, by descending stretches of the second robot.
  bool add_second_goes(std::span<const NearPair> near, const StopCondition& stop) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t stretch = kNone;
    std::uint32_t entered = kNone;  // the first stretch of the first robot in a region with a later one
    std::uint32_t entered_here = kNone;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (k % kPairsBetweenPolls == 0 && stop.met()) return false;
      const NearPair& pair = near[near.size() - 1 - k];
      if (pair.stretch != stretch) entered = std::min(entered, entered_here);
      stretch = pair.stretch;
      if (pair.other_stretch > entered) continue;
      const PlannedStretch& a = first_.stretches[pair.other_stretch];
      const PlannedStretch& b = second_.stretches[pair.stretch];
      if (is_surely_before(a, b)) continue;
      const double kept_apart = distance(a, b, nullptr);
      const auto nearest = crossing(a, b, kept_apart);
      if (!nearest || first_is_first(a, b, *nearest)) continue;
      second_goes_.push_back(region(b, a, kept_apart));
      if (second_goes_.back().is_open()) entered_here = std::min(entered_here, pair.other_stretch);
    }
    return true;
  }

  static bool is_surely_before(const PlannedStretch& a, const PlannedStretch& b) {
    return a.planned.t_end + kSurely < b.planned.t_start;
  }

  /// Returns the distance that the two have to keep, metres; less if the plan itself does not keep it, which
  /// is then noted in `too_near` (null: not noted).
  double distance(const PlannedStretch& a, const PlannedStretch& b, std::vector<Tightness>* too_near) const {
    const double wanted = a.radius + b.radius - tolerance_;
    const NearestInTime planned = nearest_in_time(MovingDisk(a.planned), MovingDisk(b.planned));
    if (planned.distance >= wanted) return wanted;
    if (too_near != nullptr) too_near->push_back({planned.t, 0.0});
    return planned.distance * kJustLess;
  }

  /// Returns where the two are nearest, if they are nearer than `distance` there.
  static std::optional<NearestShares> crossing(const PlannedStretch& a, const PlannedStretch& b,
                                               double distance) {
    if (!a.separates || !b.separates) return std::nullopt;
    const NearestShares nearest = nearest_shares(a.planned.path, b.planned.path);
    return nearest.distance < distance ? std::optional(nearest) : std::nullopt;
  }

  bool first_is_first(const PlannedStretch& a, const PlannedStretch& b, const NearestShares& nearest) const {
    if (is_surely_before(a, b)) return true;
    if (is_surely_before(b, a)) return false;
    const double u = a.begin + nearest.at.first * a.length;
    const double v = b.begin + nearest.at.second * b.length;
    return first_.pace.time_at(u) < second_.pace.time_at(v);
  }

  static PassedRegion region(const PlannedStretch& a, const PlannedStretch& b, double distance) {
    return {{a.planned.path, b.planned.path, distance}, {a.begin, a.length}, {b.begin, b.length}};
  }

  const PacedRobot& first_;
  const PacedRobot& second_;
  double tolerance_;
  std::vector<PassedRegion> first_goes_;
  std::vector<PassedRegion> second_goes_;
  std::vector<Tightness> too_near_;
};

/// Returns the entries in order of time; of several within `apart` seconds of each other, only the least one.
std::vector<Tightness> merged(std::vector<Tightness> all, double apart) {
  std::sort(all.begin(), all.end(), [](const Tightness& a, const Tightness& b) { return a.t < b.t; });
  std::vector<Tightness> kept;
  double last = 0.0;
  for (const Tightness& one : all) {
    const bool is_new = kept.empty() || one.t > last + apart;
    last = one.t;
    if (is_new) {
      kept.push_back(one);
    } else if (one.slack < kept.back().slack) {
      kept.back() = one;
    }
  }
  return kept;
}

}  // namespace

std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop) {
  PairRegions regions(first, second, tolerance);
  if (!regions.add(near, stop)) return std::nullopt;
  auto for_second = staircase_of(regions.first_goes(), first.pace, second.pace, slack, stop);
  auto for_first = staircase_of(regions.second_goes(), second.pace, first.pace, slack, stop);
  if (!for_second || !for_first) return std::nullopt;
  std::vector<Tightness> tight = regions.too_near();
  for (const Staircase* one : {&*for_second, &*for_first}) {
    tight.insert(tight.end(), one->tight.begin(), one->tight.end());
  }
  return PairDependencies{std::move(for_second->steps), std::move(for_first->steps),
                          merged(std::move(tight), slack)};
}

}  // namespace fleetplan::core
