#pragma once

// Goals that are served at one of several poses, or somewhere near their pose.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/position.h"
#include "core/model/action.h"
#include "core/model/loads.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A pose at which a goal may be served.
struct Alternative {
  Position position{0.0, 0.0};
  std::optional<double> theta;  // radians, (-pi, pi]
  double bias = 0.0;            // seconds, >= 0, added to the cost of choosing it
  std::size_t number = 0;       // its number in the list of the request
};

/// A goal (Robot::goal_at) that is served at one of several poses. The goal itself has the pose that is
/// chosen. A goal with a tolerance has only its own pose, and perhaps a nearby place that the request tells,
/// until widen() adds more.
struct OpenGoal {
  std::size_t goal = 0;            // number of the goal
  std::vector<Alternative> poses;  // at least one
  std::size_t chosen = 0;          // index in `poses`
  bool is_settled = false;         // what the robot has done or is committed to decides
  bool is_told = false;            // actions that serve the goal do so only at the chosen pose
  double tolerance = 0.0;          // metres: how far from its own position it may be served
  Position own{0.0, 0.0};          // with a tolerance: that position
  bool is_widened = false;         // see widen()

  bool may_widen() const { return tolerance > 0.0 && !is_widened && !is_settled; }
  /// Whether there is nothing to choose.
  bool is_fixed() const { return is_settled || (tolerance > 0.0 && poses.size() == 1); }

  const Alternative& choice() const { return poses[chosen]; }
};

/// The farthest tolerance, metres.
inline constexpr double kMaxGoalTolerance = 1.0;

/// Adds poses to a goal with a tolerance, for when its own pose is of no use. They are on eight circles about
/// its own pose, in twelve directions, with the goal's heading. Nearer poses are preferred, whatever the way
/// there takes. But a robot goes on to the pose where it has been going. Only for goals that may_widen().
void widen(OpenGoal& open);

/// Takes a place that the request tells for a goal with a tolerance, instead of a place told before. It is
/// `chosen` then. The goal must not have been widened. Returns whether the place is near enough; if not,
/// nothing changes.
bool take_place(OpenGoal& open, const Position& place);

/// Returns the goal of this number among open goals, which are ascending; null if this goal is not open.
template <class OpenGoals>
auto* find_open(OpenGoals& open, std::size_t goal) {
  const auto found =
      std::lower_bound(open.begin(), open.end(), goal,
                       [](const OpenGoal& one, std::size_t number) { return one.goal < number; });
  return found != open.end() && found->goal == goal ? &*found : nullptr;
}

/// Chooses a pose, by its index, for the robot whose goal this is.
void choose(Robot& robot, OpenGoal& open, std::size_t pose);

/// Whether the robot stays at this goal, so that no other robot can stay there.
bool stays_at(const Robot& robot, std::size_t goal);

/// Settles the open goals, ascending, that a robot serves by `actions`, which are contiguous from t = 0 in
/// its start.
///
/// - A goal is settled at the pose where it is served first, unless its pose has been told.
/// - The goal whose service is under way at the end of the actions is settled, too.
/// - The goal at which the robot stays is settled only with `also_last`, at the pose where the actions end.
///
/// Goals that are settled stay as they are. Ends early if `stop` is met.
void settle_by_actions(Robot& robot, std::vector<OpenGoal>& open, std::span<const Action> actions,
                       bool also_last, const StopCondition& stop);

/// Chooses a pose for the first goal that is not settled. `actions` do not serve this goal, as the request
/// says: they may turn in one pose on their way to another. So a pose is chosen at which they do not serve
/// it, preferably the pose where they end. Ends early if `stop` is met.
void choose_unserved(Robot& robot, std::vector<OpenGoal>& open, std::span<const Action> actions,
                     const StopCondition& stop);

/// See LoadOnTheWay. An open goal whose pose is not told is served in the pose in which the robot rests
/// first.
class OpenLoadOnTheWay {
 public:
  OpenLoadOnTheWay(const Robot& robot, const std::vector<OpenGoal>& open);
  OpenLoadOnTheWay(const OpenLoadOnTheWay&) = delete;
  OpenLoadOnTheWay& operator=(const OpenLoadOnTheWay&) = delete;

  const Load& load() const { return on_the_way_.load(); }
  void execute(const Action& action);

 private:
  const Robot& settled_at_start();
  void settle(std::size_t goal, const Pose& pose);

  Robot robot_;
  std::vector<OpenGoal> open_;
  LoadOnTheWay on_the_way_;
};

}  // namespace fleetplan::core
