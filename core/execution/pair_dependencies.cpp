#include "core/execution/pair_dependencies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/disk_motion.h"

namespace fleetplan::core {

namespace {

/// When two robots that follow their plans are nearest during two stretches.
struct NearestInTime {
  double t = 0.0;
  double distance = kForever;
};

NearestInTime nearest_in_time(const MovingDisk& first, const MovingDisk& second) {
  const double begin = std::max(first.t_start, second.t_start);
  const double end = std::min(first.t_end, second.t_end);
  if (begin > end || begin == kForever) return {};
  const Position offset = first.at(begin) - second.at(begin);
  const Position velocity = first.velocity - second.velocity;
  const double square = velocity.squaredNorm();
  const double after = square > 0.0 ? std::clamp(-offset.dot(velocity) / square, 0.0, end - begin) : 0.0;
  return {begin + after, (offset + after * velocity).norm()};
}

/// Metres, as a share: a region whose border the plan touches lies beside the plan despite rounding.
constexpr double kJustLess = 1.0 - 1e-9;

class PairRegions {
 public:
  PairRegions(const PacedRobot& first, const PacedRobot& second, double tolerance)
      : first_(first), second_(second), tolerance_(tolerance) {}

  void add(const NearPair& near) {
    const PlannedStretch& a = first_.stretches[near.other_stretch];
    const PlannedStretch& b = second_.stretches[near.stretch];
    double distance = a.radius + b.radius - tolerance_;
    const NearestInTime planned = nearest_in_time(MovingDisk(a.planned), MovingDisk(b.planned));
    if (planned.distance < distance) {
      too_near_.push_back({planned.t, 0.0});
      distance = planned.distance * kJustLess;
    }
    if (!a.separates || !b.separates) return;
    const NearestShares nearest = nearest_shares(a.planned.path, b.planned.path);
    if (nearest.distance >= distance) return;
    const double u = a.begin + nearest.at.first * a.length;
    const double v = b.begin + nearest.at.second * b.length;
    if (first_.pace.time_at(u) < second_.pace.time_at(v)) {
      first_goes_.push_back(
          {{a.planned.path, b.planned.path, distance}, a.begin, a.length, b.begin, b.length});
    } else {
      second_goes_.push_back(
          {{b.planned.path, a.planned.path, distance}, b.begin, b.length, a.begin, a.length});
    }
  }

  const std::vector<PassedRegion>& first_goes() const { return first_goes_; }
  const std::vector<PassedRegion>& second_goes() const { return second_goes_; }

  /// When the plan brings the two nearer than they should be.
  const std::vector<Tightness>& too_near() const { return too_near_; }

 private:
  const PacedRobot& first_;
  const PacedRobot& second_;
  double tolerance_;
  std::vector<PassedRegion> first_goes_;
  std::vector<PassedRegion> second_goes_;
  std::vector<Tightness> too_near_;
};

/// In order of time; of several within `apart` seconds of each other, the least.
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
  for (const NearPair& one : near) {
    if (stop.met()) return std::nullopt;
    regions.add(one);
  }
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
