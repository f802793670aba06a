#pragma once

// Poses of goals that may be served at one of several, chosen by given times.

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

/// Seconds: the cost of a pose that would be useless, because a robot without a way to it, or a parked robot,
/// is there. Such a pose is still better than none.
inline constexpr double kUseless = 1e9;

/// When a robot that takes a pose would rest there, and when it would rest at the last goal before its next
/// open goal; seconds.
struct PoseTimes {
  double arrives = kForever;
  double ends = kForever;
};

/// Returns the times of each place, by its poses. None if it is stopped.
using TimesOf =
    std::function<std::optional<std::vector<std::vector<PoseTimes>>>(const std::vector<OpenPlace>& places)>;

/// Chooses a pose for each open goal. At goals where robots do not stay, they come in turn. The robot that
/// ends first at the best of its poses comes first. Each robot waits while a robot before it is served there.
/// For last goals, all poses are assigned together, so that the disks overlap neither each other nor other
/// robots that stay. Returns the places that get no pose. None if it is stopped.
std::optional<std::vector<OpenPlace>> choose_poses(std::vector<Robot>& robots, OpenGoals& open,
                                                   const TimesOf& times_of, const StopCondition& stop);

}  // namespace fleetplan::core
