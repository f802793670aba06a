#pragma once

// Time windows, and the bounding boxes of moving disks in one window after the other.

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// Returns the boundaries of time windows in which each robot has about half a leg: ascending, the first is
/// 0, the last the time at which all robots have come to rest. Only 0 if no robot ever moves. `others` move
/// among the robots, and have about half a leg in each window as well.
std::vector<double> time_windows(const std::vector<std::vector<Leg>>& legs_by_robot,
                                 const std::vector<std::vector<Leg>>& others = {});

/// The bounding box of a disk within a time window.
struct MovingBox {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::size_t body = 0;
  double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;

  void include(const Position& position);
  void enlarge(double distance);
};

class MovingBoxes {
 public:
  /// The boxes of bodies with these `legs`. `reach` by body: how far its boxes are enlarged, metres. A slack
  /// that is far more than the rounding of boxes, and far less than the radius of a robot, is added.
  MovingBoxes(const std::vector<std::vector<Leg>>& legs, std::vector<double> reach);

  /// Returns the boxes of the bodies that are present within a closed window, by their left edges. The
  /// windows of later calls begin no earlier.
  std::vector<MovingBox> in(const TimeSpan& window);

  /// Returns the legs of a body that do not end before the last window.
  std::span<const Leg> legs(std::size_t body) const { return std::span(legs_[body]).subspan(current_[body]); }

 private:
  const std::vector<std::vector<Leg>>& legs_;
  std::vector<double> reach_;
  std::vector<std::size_t> current_;  // by body, the first leg that does not end before the window
};

}  // namespace fleetplan::core
