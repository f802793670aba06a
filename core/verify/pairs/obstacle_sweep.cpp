#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/moving_boxes.h"
#include "core/verify/pairs/sweeps.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kPiecesBetweenPolls = 256;
/// Windows in which obstacles have about the same number of legs, in addition to those of the robots.
constexpr std::size_t kObstacleWindows = 64;
/// The most ends of legs from which these windows are found.
constexpr std::size_t kMostSamples = 4096;

/// Compares, in each time window, every leg of an obstacle with the robots whose boxes it comes near. There
/// may be far more legs of obstacles than robots, so they are not sorted.
class ObstacleSweep {
 public:
  ObstacleSweep(const ExecutedFleet& fleet, const std::vector<std::vector<Leg>>& obstacles,
                const std::vector<double>& obstacle_radii, const Exemptions& exemptions,
                std::size_t max_overlaps, const StopCondition& stop)
      : fleet_(fleet),
        obstacles_(obstacles),
        radii_(obstacle_radii),
        exemptions_(exemptions),
        robots_(fleet.legs, fleet.radii),
        next_(obstacles.size(), 0),
        overlaps_(max_overlaps),
        stop_(stop) {}

  std::optional<std::vector<Overlap>> run() {
    if (obstacles_.empty() || fleet_.size() == 0) return std::vector<Overlap>{};
    const std::vector<double> boundaries = windows();
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      if (stop_.met() || stopped_) return std::nullopt;
      compare_in({boundaries[k],
                  k + 1 < boundaries.size() ? boundaries[k + 1] : std::numeric_limits<double>::infinity()});
    }
    if (stopped_) return std::nullopt;
    return overlaps_.take();
  }

 private:
  std::vector<double> windows() const {
    std::size_t legs = 0;
    for (const std::vector<Leg>& all : obstacles_) legs += all.size();
    const std::size_t stride = 1 + legs / kMostSamples;
    std::vector<double> ends;
    std::size_t k = 0;
    // Bounded: the legs that there are, each once.
    for (const std::vector<Leg>& all : obstacles_) {
      for (const Leg& leg : all) {
        if (k++ % stride == 0 && std::isfinite(leg.t_end)) ends.push_back(leg.t_end);
      }
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> boundaries = time_windows(fleet_.legs);
    for (std::size_t i = 1; i <= kObstacleWindows && !ends.empty(); ++i) {
      boundaries.push_back(std::max(0.0, ends[(ends.size() - 1) * i / kObstacleWindows]));
    }
    std::sort(boundaries.begin(), boundaries.end());
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    return boundaries;
  }

  void compare_in(const TimeSpan& window) {
    std::vector<MovingBox> boxes = robots_.in(window);
    std::erase_if(boxes,
                  [&](const MovingBox& box) { return exemptions_.allow_all_obstacles(box.body, window); });
    if (boxes.empty()) return;
    double widest = 0.0;
    for (const MovingBox& box : boxes) widest = std::max(widest, box.right - box.left);
    for (std::size_t obstacle = 0; obstacle < obstacles_.size() && !stopped_; ++obstacle) {
      const std::vector<Leg>& legs = obstacles_[obstacle];
      std::size_t& next = next_[obstacle];
      while (next < legs.size() && legs[next].t_end < window.begin) ++next;
      for (std::size_t k = next; k < legs.size() && legs[k].t_begin <= window.end && poll(); ++k) {
        compare(boxes, widest, obstacle, legs[k], window);
      }
    }
  }

  /// Looks at the stop condition once in many steps. Returns false if it was met.
  bool poll() {
    if (++steps_ % kPiecesBetweenPolls == 0) stopped_ = stopped_ || stop_.met();
    return !stopped_;
  }

  void compare(const std::vector<MovingBox>& boxes, double widest, std::size_t obstacle, const Leg& leg,
               const TimeSpan& window) {
    MovingBox box;
    box.include(position_at(leg, window.begin));
    box.include(position_at(leg, window.end));
    box.enlarge(radii_[obstacle]);
    auto near = std::lower_bound(boxes.begin(), boxes.end(), box.left - widest,
                                 [](const MovingBox& robot, double left) { return robot.left < left; });
    for (; near != boxes.end() && near->left <= box.right; ++near) {
      if (near->right < box.left || near->top < box.bottom || box.top < near->bottom) continue;
      compare(near->body, obstacle, leg, window);
    }
  }

  void compare(std::size_t robot, std::size_t obstacle, const Leg& leg, const TimeSpan& window) {
    const double allowed = fleet_.radii[robot] + radii_[obstacle] - fleet_.tolerances[robot];
    if (allowed <= 0.0) return;
    const bool is_instant = obstacles_[obstacle].size() == 1;
    visit_common_pieces(
        robots_.legs(robot), {&leg, 1}, window, is_instant, [&](const RelativeMotion& motion) {
          const bool is_exempt = exemptions_.allow_all_obstacles(robot, {motion.t_begin, motion.t_end});
          if (!is_exempt && least_squared_distance(motion) < allowed * allowed) {
            overlaps_.add(robot, obstacle, motion, allowed);
          }
          return poll();
        });
  }

  const ExecutedFleet& fleet_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& radii_;
  const Exemptions& exemptions_;
  MovingBoxes robots_;
  std::vector<std::size_t> next_;  // by obstacle, the first leg that does not end before the window
  OverlapList overlaps_;
  const StopCondition& stop_;
  std::size_t steps_ = 0;
  bool stopped_ = false;
};

}  // namespace

std::optional<std::vector<Overlap>> overlaps_with_obstacles(const ExecutedFleet& fleet,
                                                            const std::vector<std::vector<Leg>>& obstacles,
                                                            const std::vector<double>& obstacle_radii,
                                                            const Exemptions& exemptions,
                                                            std::size_t max_overlaps,
                                                            const StopCondition& stop) {
  return ObstacleSweep(fleet, obstacles, obstacle_radii, exemptions, max_overlaps, stop).run();
}

}  // namespace fleetplan::core
