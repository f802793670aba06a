#include "core/verify/pairs/fleet_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "core/geometry/tolerance.h"
#include "core/verify/execution/time_windows.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kStepsBetweenPolls = 256;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The bounding box of the disk of a robot within a time window.
struct Box {
  std::size_t robot = 0;
  double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;

  void include(const Position& position) {
    left = std::min(left, position.x());
    right = std::max(right, position.x());
    bottom = std::min(bottom, position.y());
    top = std::max(top, position.y());
  }
};

/// Sweep and prune in every time window: sweeps the boxes of all robots from left to right and compares the
/// pairs whose boxes are nearer than the least gap so far, or near enough to overlap.
class ClearanceSweep {
 public:
  ClearanceSweep(const std::vector<std::vector<Leg>>& legs_by_robot, const std::vector<double>& radii,
                 const std::vector<double>& tolerances, std::size_t max_overlaps, const StopCondition& stop)
      : legs_(legs_by_robot),
        radii_(radii),
        tolerances_(tolerances),
        max_overlaps_(max_overlaps),
        stop_(stop),
        current_leg_(radii.size(), 0),
        slack_(rounding_of_boxes()) {}

  std::optional<FleetClearance> run() {
    if (radii_.size() < 2) return FleetClearance{};
    least_tolerance_ = *std::min_element(tolerances_.begin(), tolerances_.end());
    const std::vector<double> boundaries = time_windows(legs_);
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      if (stop_.met() || stopped_) return std::nullopt;
      sweep({boundaries[k], k + 1 < boundaries.size() ? boundaries[k + 1] : kInfinity});
    }
    if (stopped_) return std::nullopt;
    return FleetClearance{least_, std::move(overlaps_)};
  }

 private:
  /// Far more than the rounding of boxes and gaps, so that skipped pairs never influence the result.
  double rounding_of_boxes() const {
    double largest = 0.0;
    for (const std::vector<Leg>& legs : legs_) {
      for (const Leg& leg : legs) {
        largest = std::max({largest, leg.from.lpNorm<Eigen::Infinity>(), leg.to.lpNorm<Eigen::Infinity>()});
      }
    }
    for (const double radius : radii_) largest = std::max(largest, radius);
    return 1e-9 + 1e-12 * largest;
  }

  /// Pairs whose gap exceeds this neither overlap nor make the least gap smaller.
  double interesting_gap() const { return std::max(least_, -least_tolerance_) + slack_; }

  /// Looks at the stop condition once in many steps.
  void poll() {
    if (++steps_ % kStepsBetweenPolls == 0) stopped_ = stopped_ || stop_.met();
  }

  void sweep(const TimeSpan& window) {
    const std::vector<Box> boxes = boxes_in(window);
    for (std::size_t i = 0; i < boxes.size() && !stopped_; ++i) {
      poll();
      const Box& a = boxes[i];
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        const Box& b = boxes[j];
        const double limit = interesting_gap();
        if (b.left - a.right > limit) break;
        if (std::max(b.bottom - a.top, a.bottom - b.top) > limit) continue;
        compare(std::min(a.robot, b.robot), std::max(a.robot, b.robot), window);
      }
    }
  }

  std::vector<Box> boxes_in(const TimeSpan& window) {
    std::vector<Box> boxes(radii_.size());
    for (std::size_t robot = 0; robot < radii_.size(); ++robot) {
      const std::vector<Leg>& legs = legs_[robot];
      while (legs[current_leg_[robot]].t_end <= window.begin) ++current_leg_[robot];
      Box& box = boxes[robot];
      box.robot = robot;
      for (std::size_t k = current_leg_[robot]; k < legs.size() && legs[k].t_begin < window.end; ++k) {
        box.include(position_at(legs[k], window.begin));
        box.include(position_at(legs[k], window.end));
      }
      box.left -= radii_[robot];
      box.right += radii_[robot];
      box.bottom -= radii_[robot];
      box.top += radii_[robot];
    }
    std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) {
      return a.left != b.left ? a.left < b.left : a.robot < b.robot;
    });
    return boxes;
  }

  /// Compares two robots leg by leg through the window.
  void compare(std::size_t first, std::size_t second, const TimeSpan& window) {
    const double contact = radii_[first] + radii_[second];
    const double allowed = contact - std::max(tolerances_[first], tolerances_[second]);
    const Leg* a = &legs_[first][current_leg_[first]];
    const Leg* b = &legs_[second][current_leg_[second]];
    double least_squared = kInfinity;
    for (double now = window.begin; now < window.end && !stopped_;) {
      poll();
      while (a->t_end <= now) ++a;
      while (b->t_end <= now) ++b;
      const double until = std::min({a->t_end, b->t_end, window.end});
      const RelativeMotion motion{now, until, position_at(*b, now) - position_at(*a, now),
                                  position_at(*b, until) - position_at(*a, until)};
      const double squared = least_squared_distance(motion);
      least_squared = std::min(least_squared, squared);
      if (allowed > 0.0 && squared < allowed * allowed) record_overlap(first, second, motion, allowed);
      now = until;
    }
    least_ = std::min(least_, std::sqrt(least_squared) - contact);
  }

  void record_overlap(std::size_t first, std::size_t second, const RelativeMotion& motion, double allowed) {
    const std::optional<TimeSpan> span = span_closer_than(motion, allowed);
    if (!span) return;
    const ClosestMoment closest = closest_moment(motion);
    const std::uint64_t pair = static_cast<std::uint64_t>(first) * radii_.size() + second;
    const auto latest = latest_overlap_.find(pair);
    if (latest != latest_overlap_.end() && overlaps_[latest->second].t_end == span->begin) {
      Overlap& overlap = overlaps_[latest->second];
      overlap.t_end = span->end;
      // Robots with equal velocities come nearer only by rounding: that is not a later, deeper moment.
      if (closest.distance < overlap.distance - kSamePosition) overlap.t_deepest = closest.t;
      overlap.distance = std::min(overlap.distance, closest.distance);
    } else if (overlaps_.size() < max_overlaps_) {
      latest_overlap_[pair] = overlaps_.size();
      overlaps_.push_back({first, second, span->begin, span->end, closest.t, closest.distance});
    }
  }

  const std::vector<std::vector<Leg>>& legs_;
  const std::vector<double>& radii_;
  const std::vector<double>& tolerances_;  // by robot
  std::size_t max_overlaps_;
  const StopCondition& stop_;
  std::size_t steps_ = 0;
  bool stopped_ = false;                  // then a window may be incomplete
  std::vector<std::size_t> current_leg_;  // by robot, the first that ends after the beginning of the window
  double slack_;
  double least_tolerance_ = 0.0;
  double least_ = kInfinity;
  std::vector<Overlap> overlaps_;
  std::unordered_map<std::uint64_t, std::size_t> latest_overlap_;  // by pair, the index of its last overlap
};

}  // namespace

std::optional<FleetClearance> fleet_clearance(const std::vector<std::vector<Leg>>& legs_by_robot,
                                              const std::vector<double>& radii,
                                              const std::vector<double>& tolerances, std::size_t max_overlaps,
                                              const StopCondition& stop) {
  return ClearanceSweep(legs_by_robot, radii, tolerances, max_overlaps, stop).run();
}

}  // namespace fleetplan::core
