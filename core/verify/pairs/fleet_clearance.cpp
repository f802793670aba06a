#include "core/verify/pairs/fleet_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

namespace {

// The least number of windows: with fewer, plans of few actions would have long windows with large boxes.
constexpr std::size_t kFewestWindows = 64;
// The greatest number of windows. More would cost more than they save, because each window visits every
// robot.
constexpr std::size_t kMaxWindows = 4096;
constexpr std::size_t kWindowsPerLeg = 2;

void add_leg_end_times(const std::vector<std::vector<Leg>>& legs_by_body, std::vector<double>& times) {
  // Bounded: the legs that there are, each once.
  for (const std::vector<Leg>& legs : legs_by_body) {
    for (const Leg& leg : legs) {
      if (std::isfinite(leg.t_end)) times.push_back(leg.t_end);
    }
  }
}

}  // namespace

std::vector<double> time_windows(const std::vector<std::vector<Leg>>& legs_by_robot,
                                 const std::vector<std::vector<Leg>>& others) {
  std::vector<double> times;
  add_leg_end_times(legs_by_robot, times);
  add_leg_end_times(others, times);
  std::sort(times.begin(), times.end());
  std::vector<double> boundaries{0.0};
  if (times.empty() || times.back() <= 0.0) return boundaries;

  const std::size_t legs_per_robot = 1 + times.size() / (legs_by_robot.size() + others.size());
  const std::size_t wanted = std::min(kWindowsPerLeg * legs_per_robot, kMaxWindows);
  const std::size_t parts = (kFewestWindows + wanted - 1) / wanted;
  // Bounded: at most kMaxWindows, in kFewestWindows parts.
  for (std::size_t k = 1; k <= wanted; ++k) {
    // The k-th quantile, so that one very slow robot does not put all others into one window.
    const double end = times[(times.size() - 1) * k / wanted];
    const double begin = boundaries.back();
    for (std::size_t part = 1; part <= parts; ++part) {
      const double boundary =
          part == parts ? end
                        : begin + (end - begin) * static_cast<double>(part) / static_cast<double>(parts);
      if (boundary > boundaries.back()) boundaries.push_back(boundary);
    }
  }
  return boundaries;
}

namespace {

constexpr double kSlack = 1e-6;  // metres

}  // namespace

void MovingBox::include(const Position& position) {
  left = std::min(left, position.x());
  right = std::max(right, position.x());
  bottom = std::min(bottom, position.y());
  top = std::max(top, position.y());
}

void MovingBox::enlarge(double distance) {
  left -= distance;
  right += distance;
  bottom -= distance;
  top += distance;
}

MovingBoxes::MovingBoxes(const std::vector<std::vector<Leg>>& legs, std::vector<double> reach)
    : legs_(legs), reach_(std::move(reach)), current_(legs.size(), 0) {}

std::vector<MovingBox> MovingBoxes::in(const TimeSpan& window) {
  std::vector<MovingBox> boxes;
  // Bounded: the bodies, and the legs of this window.
  for (std::size_t body = 0; body < legs_.size(); ++body) {
    const std::vector<Leg>& legs = legs_[body];
    std::size_t& current = current_[body];
    while (current < legs.size() && legs[current].t_end < window.begin) ++current;
    MovingBox box;
    box.body = body;
    for (std::size_t k = current; k < legs.size() && legs[k].t_begin <= window.end; ++k) {
      box.include(position_at(legs[k], window.begin));
      box.include(position_at(legs[k], window.end));
    }
    if (box.left > box.right) continue;
    box.enlarge(reach_[body] + kSlack);
    boxes.push_back(box);
  }
  std::sort(boxes.begin(), boxes.end(), [](const MovingBox& a, const MovingBox& b) {
    return a.left != b.left ? a.left < b.left : a.body < b.body;
  });
  return boxes;
}

void OverlapList::add(std::size_t first, std::size_t second, const RelativeMotion& motion, double allowed) {
  const std::optional<TimeSpan> span = span_closer_than(motion, allowed);
  if (!span) return;
  const ClosestMoment closest = closest_moment(motion);
  const std::uint64_t pair = static_cast<std::uint64_t>(first) << 32 | second;
  const auto latest = latest_.find(pair);
  if (latest != latest_.end() && overlaps_[latest->second].t_end >= span->begin) {
    Overlap& overlap = overlaps_[latest->second];
    overlap.t_end = std::max(overlap.t_end, span->end);
    // Disks with equal velocities come nearer only by rounding, which makes no later moment deeper.
    if (closest.distance < overlap.distance - kSamePosition) overlap.t_deepest = closest.t;
    overlap.distance = std::min(overlap.distance, closest.distance);
  } else if (overlaps_.size() < max_) {
    latest_[pair] = overlaps_.size();
    overlaps_.push_back({.first = first,
                         .second = second,
                         .t_begin = span->begin,
                         .t_end = span->end,
                         .t_deepest = closest.t,
                         .distance = closest.distance});
  }
}

std::vector<Overlap> OverlapList::take() { return std::move(overlaps_); }

namespace {

constexpr std::size_t kStepsBetweenPolls = 256;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Sweep and prune in every time window: sweeps the boxes of all robots from left to right. Compares the
/// pairs whose boxes are nearer than the least gap so far, or near enough to overlap.
class ClearanceSweep {
 public:
  ClearanceSweep(const std::vector<std::vector<Leg>>& legs_by_robot, const DiskRadii& radii,
                 const std::vector<double>& tolerances, std::size_t max_overlaps, const StopCondition& stop,
                 const LeftOutAtRest& left_out)
      : legs_(legs_by_robot),
        bodies_(radii.body),
        radii_(radii.kept_apart),
        tolerances_(tolerances),
        boxes_(legs_by_robot, radii.kept_apart),
        overlaps_(max_overlaps),
        stop_(stop),
        stride_(stop, kStepsBetweenPolls),
        left_out_(left_out),
        slack_(rounding_of_boxes()) {
    for (const std::vector<Leg>& legs : legs_by_robot) rests_.push_back(rests_for_ever(legs));
  }

  std::optional<FleetClearance> run() {
    if (radii_.size() < 2) return FleetClearance{};
    least_tolerance_ = *std::min_element(tolerances_.begin(), tolerances_.end());
    const std::vector<double> boundaries = time_windows(legs_);
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      if (stop_.met() || stride_.met()) return std::nullopt;
      sweep({boundaries[k], k + 1 < boundaries.size() ? boundaries[k + 1] : kInfinity});
    }
    if (stride_.met()) return std::nullopt;
    return FleetClearance{least_, overlaps_.take()};
  }

 private:
  static bool rests_for_ever(const std::vector<Leg>& legs) {
    return legs.size() == 1 && legs.front().from == legs.front().to && legs.front().t_begin <= 0.0 &&
           std::isinf(legs.front().t_end);
  }

  /// Returns a length far above the rounding of boxes and gaps, so that skipped pairs never influence the
  /// result.
  double rounding_of_boxes() const {
    double largest = 0.0;
    // Bounded: the legs that there are, each once.
    for (const std::vector<Leg>& legs : legs_) {
      for (const Leg& leg : legs) {
        largest = std::max({largest, leg.from.lpNorm<Eigen::Infinity>(), leg.to.lpNorm<Eigen::Infinity>()});
      }
    }
    for (const double radius : radii_) largest = std::max(largest, radius);
    return 1e-9 + 1e-12 * largest;
  }

  /// Returns the gap above which a pair neither overlaps nor reduces the least gap of the bodies, which is no
  /// smaller than its own.
  double interesting_gap() const { return std::max(least_, -least_tolerance_) + slack_; }

  void sweep(const TimeSpan& window) {
    const std::vector<MovingBox> boxes = boxes_.in(window);
    for (std::size_t i = 0; i < boxes.size() && !stride_.met(); ++i) {
      stride_.met_at_step();
      const MovingBox& a = boxes[i];
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        const MovingBox& b = boxes[j];
        const double limit = interesting_gap();
        if (b.left - a.right > limit) break;
        if (std::max(b.bottom - a.top, a.bottom - b.top) > limit) continue;
        if (rests_[a.body] && rests_[b.body]) {
          if (window.begin <= 0.0) compare_at_rest(std::min(a.body, b.body), std::max(a.body, b.body));
          continue;
        }
        compare(std::min(a.body, b.body), std::max(a.body, b.body), window);
      }
    }
  }

  /// Returns the least allowed distance of two robots, metres.
  double allowed_distance(std::size_t first, std::size_t second) const {
    return radii_[first] + radii_[second] - std::max(tolerances_[first], tolerances_[second]);
  }

  /// Compares two robots that rest for ever, once for all windows.
  void compare_at_rest(std::size_t first, std::size_t second) {
    stride_.met_at_step();
    const Position between = legs_[second].front().from - legs_[first].front().from;
    const double allowed = allowed_distance(first, second);
    const double squared = between.squaredNorm();
    const double distance = std::sqrt(squared);
    least_ = std::min(least_, distance - (bodies_[first] + bodies_[second]));
    if (allowed <= 0.0 || squared >= allowed * allowed) return;
    if (left_out_ && left_out_({first, second, 0.0, kInfinity, 0.0, distance})) return;
    overlaps_.add(first, second, {0.0, kInfinity, between, between}, allowed);
  }

  /// Compares two robots leg by leg through the window.
  void compare(std::size_t first, std::size_t second, const TimeSpan& window) {
    const double allowed = allowed_distance(first, second);
    double least_squared = kInfinity;
    visit_common_pieces(boxes_.legs(first), boxes_.legs(second), window, false,
                        [&](const RelativeMotion& motion) {
                          stride_.met_at_step();
                          const double squared = least_squared_distance(motion);
                          least_squared = std::min(least_squared, squared);
                          if (allowed > 0.0 && squared < allowed * allowed)
                            overlaps_.add(first, second, motion, allowed);
                          return !stride_.met();
                        });
    least_ = std::min(least_, std::sqrt(least_squared) - (bodies_[first] + bodies_[second]));
  }

  const std::vector<std::vector<Leg>>& legs_;
  const std::vector<double>& bodies_;
  const std::vector<double>& radii_;       // the radii that are kept apart, at least the bodies' radii
  const std::vector<double>& tolerances_;  // by robot
  MovingBoxes boxes_;
  OverlapList overlaps_;
  const StopCondition& stop_;
  StopStride stride_;  // if it is met, a window may be incomplete
  const LeftOutAtRest& left_out_;
  std::vector<bool> rests_;  // by robot: it never moves
  double slack_;
  double least_tolerance_ = 0.0;
  double least_ = kInfinity;
};

}  // namespace

std::optional<FleetClearance> fleet_clearance(const std::vector<std::vector<Leg>>& legs_by_robot,
                                              const DiskRadii& radii, const std::vector<double>& tolerances,
                                              std::size_t max_overlaps, const StopCondition& stop,
                                              const LeftOutAtRest& left_out) {
  return ClearanceSweep(legs_by_robot, radii, tolerances, max_overlaps, stop, left_out).run();
}

}  // namespace fleetplan::core
