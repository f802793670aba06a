#include "core/verify/pairs/moving_boxes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetplan::core {
namespace {

// The least number of windows: with fewer, plans of few actions would have long windows with large boxes.
constexpr std::size_t kFewestWindows = 64;
// The greatest number of windows: more would cost more than they save, as each window visits every robot.
constexpr std::size_t kMostWindows = 4096;
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
  const std::size_t wanted = std::min(kWindowsPerLeg * legs_per_robot, kMostWindows);
  const std::size_t parts = (kFewestWindows + wanted - 1) / wanted;
  // Bounded: at most kMostWindows, in kFewestWindows parts.
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

}  // namespace fleetplan::core
