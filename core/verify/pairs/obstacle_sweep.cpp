#include "core/verify/pairs/obstacle_sweep.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/verify/execution/time_windows.h"
#include "core/verify/pairs/common_pieces.h"
#include "core/verify/pairs/moving_boxes.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kPiecesBetweenPolls = 256;

/// Metres: far more than the rounding of boxes, far less than the radius of a robot.
constexpr double kBoxSlack = 1e-6;

std::vector<double> with_slack(std::vector<double> radii) {
  for (double& radius : radii) radius += kBoxSlack;
  return radii;
}

class ObstacleSweep {
 public:
  ObstacleSweep(const ExecutedFleet& fleet, const std::vector<std::vector<Leg>>& obstacles,
                const std::vector<double>& obstacle_radii, std::size_t max_overlaps,
                const StopCondition& stop)
      : fleet_(fleet), obstacles_(obstacles), radii_(obstacle_radii), max_(max_overlaps), stop_(stop) {}

  std::optional<std::vector<Overlap>> run() {
    if (obstacles_.empty() || fleet_.size() == 0) return overlaps_;
    const std::vector<double> boundaries = time_windows(fleet_.legs, obstacles_);
    MovingBoxes robots(fleet_.legs, with_slack(fleet_.radii));
    MovingBoxes obstacles(obstacles_, with_slack(radii_));
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      if (stop_.met() || stopped_) return std::nullopt;
      const TimeSpan window{boundaries[k], k + 1 < boundaries.size()
                                               ? boundaries[k + 1]
                                               : std::numeric_limits<double>::infinity()};
      visit_overlapping(robots.in(window), obstacles.in(window),
                        [&](const MovingBox& robot, const MovingBox& obstacle) {
                          if (!stopped_) compare(robot.body, obstacle.body, window);
                        });
    }
    if (stopped_) return std::nullopt;
    return std::move(overlaps_);
  }

 private:
  bool poll() {
    if (++steps_ % kPiecesBetweenPolls == 0) stopped_ = stopped_ || stop_.met();
    return !stopped_;
  }

  void compare(std::size_t robot, std::size_t obstacle, const TimeSpan& window) {
    const double allowed = fleet_.radii[robot] + radii_[obstacle] - fleet_.tolerances[robot];
    poll();
    visit_common_pieces(fleet_.legs[robot], obstacles_[obstacle], window, [&](const RelativeMotion& motion) {
      if (allowed > 0.0 && least_squared_distance(motion) < allowed * allowed) {
        record(robot, obstacle, motion, allowed);
      }
      return poll();
    });
  }

  void record(std::size_t robot, std::size_t obstacle, const RelativeMotion& motion, double allowed) {
    const std::optional<TimeSpan> span = span_closer_than(motion, allowed);
    if (!span) return;
    const ClosestMoment closest = closest_moment(motion);
    const std::uint64_t pair = static_cast<std::uint64_t>(obstacle) * fleet_.size() + robot;
    const auto latest = latest_.find(pair);
    if (latest != latest_.end() && overlaps_[latest->second].t_end >= span->begin) {
      Overlap& overlap = overlaps_[latest->second];
      overlap.t_end = std::max(overlap.t_end, span->end);
      if (closest.distance < overlap.distance - kSamePosition) overlap.t_deepest = closest.t;
      overlap.distance = std::min(overlap.distance, closest.distance);
    } else if (overlaps_.size() < max_) {
      latest_[pair] = overlaps_.size();
      overlaps_.push_back({robot, obstacle, span->begin, span->end, closest.t, closest.distance});
    }
  }

  const ExecutedFleet& fleet_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& radii_;
  std::size_t max_;
  const StopCondition& stop_;
  std::size_t steps_ = 0;
  bool stopped_ = false;
  std::vector<Overlap> overlaps_;
  std::unordered_map<std::uint64_t, std::size_t> latest_;  // by pair, the index of its last overlap
};

}  // namespace

std::optional<std::vector<Overlap>> overlaps_with_obstacles(const ExecutedFleet& fleet,
                                                            const std::vector<std::vector<Leg>>& obstacles,
                                                            const std::vector<double>& obstacle_radii,
                                                            std::size_t max_overlaps,
                                                            const StopCondition& stop) {
  return ObstacleSweep(fleet, obstacles, obstacle_radii, max_overlaps, stop).run();
}

}  // namespace fleetplan::core
