#pragma once

// Poses of goals that may be served at one of several, chosen with given times.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/segment.h"
#include "core/model/open_goal.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// By robot, ascending by goal.
using OpenGoals = std::vector<std::vector<OpenGoal>>;

/// A robot and one of its open goals, as an index into its list.
struct OpenPlace {
  std::size_t robot = 0;
  std::size_t open = 0;
};

/// Seconds: the cost of a pose that a robot without a way to it, or one that is parked there, makes useless,
/// but which is better than none.
inline constexpr double kUseless = 1e9;

/// When a robot that takes a pose would rest there, and when it would rest at the last goal before its next
/// open one; seconds.
struct PoseTimes {
  double arrives = kForever;
  double ends = kForever;
};

/// Returns the times of each place, by its poses; none if it is stopped.
using TimesOf =
    std::function<std::optional<std::vector<std::vector<PoseTimes>>>(const std::vector<OpenPlace>& places)>;

/// Chooses a pose for each open goal. Robots come to the goals at which they do not stay in turn: the one
/// that ends first by the best of its poses comes first, and each waits where one before it is served. For
/// last goals, poses are assigned at once, so that their disks do not overlap, nor those of other robots that
/// stay. Returns the places that get no pose; none if it is stopped.
std::optional<std::vector<OpenPlace>> choose_poses(std::vector<Robot>& robots, OpenGoals& open,
                                                   const TimesOf& times_of, const StopCondition& stop);

}  // namespace fleetplan::core
