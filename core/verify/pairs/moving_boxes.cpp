#include "core/verify/pairs/moving_boxes.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
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
