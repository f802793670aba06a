#include "core/prioritized/without_way.h"

#include <array>
#include <cstdio>
#include <string>

namespace fleetplan::core {
namespace {

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

std::string missed_by_lattice(double radius, const Way& way) {
  std::string text = "The lattice has no way from the start to the goal for this robot";
  if (way.widest) {
    text += ", which needs " + metres(2.0 * radius) + "; the widest way between the obstacles has " +
            metres(*way.widest);
  }
  return text + ". A finer resolution, a smaller radius or connectivity 16 or 32 may give it one.";
}

}  // namespace

Unplanned unplanned_without_way(std::size_t robot, double radius, const Way& way) {
  using Reason = Unplanned::Reason;
  if (!way.closed_by.empty()) {
    return {robot, Reason::blocked_by_robots,
            "Robots that stay where they are leave no way from the start to the goal.", way.closed_by};
  }
  const bool closed = way.kind == Way::Kind::closed;
  return {robot,
          Reason::goal_unreachable,
          closed ? "No way leads from the start to the goal that is wide enough for the robot."
                 : missed_by_lattice(radius, way),
          {}};
}

}  // namespace fleetplan::core
