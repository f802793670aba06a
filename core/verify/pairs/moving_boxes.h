#pragma once

// The bounding boxes of moving disks in one time window after the other.

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

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
  /// `legs` by body, and how far each of their boxes is enlarged, metres. A slack that is far more than the
  /// rounding of boxes, and far less than the radius of a robot, is added.
  MovingBoxes(const std::vector<std::vector<Leg>>& legs, std::vector<double> reach);

  /// The boxes of the bodies that are present within a closed window, by their left edges. The windows of
  /// later calls begin no earlier.
  std::vector<MovingBox> in(const TimeSpan& window);

  /// The legs of a body that do not end before the last window.
  std::span<const Leg> legs(std::size_t body) const { return std::span(legs_[body]).subspan(current_[body]); }

 private:
  const std::vector<std::vector<Leg>>& legs_;
  std::vector<double> reach_;
  std::vector<std::size_t> current_;  // by body, the first leg that does not end before the window
};

/// Calls `visit(a, b)` for each box of one list and each of the other that overlap. Both are ordered by their
/// left edges.
template <typename Visit>
void visit_overlapping(const std::vector<MovingBox>& some, const std::vector<MovingBox>& others,
                       Visit visit) {
  const auto meet = [](const MovingBox& a, const MovingBox& b) {
    return a.bottom <= b.top && b.bottom <= a.top;
  };
  std::size_t i = 0;
  std::size_t j = 0;
  // The box that begins first is compared with those of the other list that begin within it.
  while (i < some.size() && j < others.size()) {
    if (some[i].left <= others[j].left) {
      for (std::size_t k = j; k < others.size() && others[k].left <= some[i].right; ++k) {
        if (meet(some[i], others[k])) visit(some[i], others[k]);
      }
      ++i;
    } else {
      for (std::size_t k = i; k < some.size() && some[k].left <= others[j].right; ++k) {
        if (meet(some[k], others[j])) visit(some[k], others[j]);
      }
      ++j;
    }
  }
}

}  // namespace fleetplan::core
