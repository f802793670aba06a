#include "core/verify/pairs/obstacle_sweep.h"

#include <limits>
#include <utility>

#include "core/verify/execution/time_windows.h"
#include "core/verify/pairs/common_pieces.h"
#include "core/verify/pairs/moving_boxes.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kPiecesBetweenPolls = 256;

class ObstacleSweep {
 public:
  ObstacleSweep(const ExecutedFleet& fleet, const std::vector<std::vector<Leg>>& obstacles,
                const std::vector<double>& obstacle_radii, std::size_t max_overlaps,
                const StopCondition& stop)
      : fleet_(fleet), obstacles_(obstacles), radii_(obstacle_radii), overlaps_(max_overlaps), stop_(stop) {}

  std::optional<std::vector<Overlap>> run() {
    if (obstacles_.empty() || fleet_.size() == 0) return std::vector<Overlap>{};
    const std::vector<double> boundaries = time_windows(fleet_.legs, obstacles_);
    MovingBoxes robots(fleet_.legs, fleet_.radii);
    MovingBoxes obstacles(obstacles_, radii_);
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
    return overlaps_.take();
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
        overlaps_.add(robot, obstacle, motion, allowed);
      }
      return poll();
    });
  }

  const ExecutedFleet& fleet_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& radii_;
  OverlapList overlaps_;
  const StopCondition& stop_;
  std::size_t steps_ = 0;
  bool stopped_ = false;
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
