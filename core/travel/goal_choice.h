#pragma once

// Chooses poses for goals that may be served at one of several poses.

#include <memory>
#include <optional>
#include <vector>

#include "core/map/static_map.h"
#include "core/model/open_goal.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/pose_choice.h"

namespace fleetplan::core {

/// The robots of a problem in which goals are open. Goals that are put off are included.
struct OpenFleet {
  std::vector<Robot> robots;  // their goals have the poses that are chosen
  OpenGoals goals;            // by robot
};

/// Leaves out the poses at which the disk of the robot overlaps an obstacle or a blocked zone. At last goals,
/// an overlap of up to `overlap` (metres, of the bare disk) is allowed. If no pose would be left, the goal
/// keeps all poses and is returned.
///
/// Because of a zone that no robot may enter, a goal may be put off at some of its poses. These poses are
/// chosen last. Settled goals stay as they are. All goals do if `stop` is met first.
std::vector<OpenPlace> leave_out_blocked_poses(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, double overlap,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop);

/// Chooses poses for the goals that are not settled, as if all ways were straight lines. Robots that stay at
/// their last goals get poses where they do not overlap, with the least sum of distances. Returns the goals
/// for which there is no such pose.
std::vector<OpenPlace> choose_by_distance(std::vector<Robot>& robots, OpenGoals& open,
                                          const StopCondition& stop);

/// An open goal for which there is no pose.
struct WithoutPose {
  OpenPlace place;
  bool any_fits = false;  // then robots that stay take all that fit
};

/// Chooses poses for the goals of robots, as far as this takes no search:
///
/// - Poses at which committed and previous actions serve goals. This settles the goals.
/// - For other goals, poses by leave_out_blocked_poses() and choose_by_distance().
/// - Goals with a tolerance are widened if their own pose is of no use. If that does not help, they keep it.
///
/// Goals of robots that are invalid are no longer open. Of the options, only the allowed overlap at last
/// goals counts. Returns the goals without a pose; not all of them if `stop` is met first.
std::vector<WithoutPose> choose_without_search(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, const PlanOptions& options,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop);

/// Chooses poses again by when the robots would arrive, each alone on the map (see arrivals()). Last goals
/// get the poses with the least sum of weighted arrivals and biases. At other goals, one robot after the
/// other gets its poses, and waits for the robots before it.
///
/// `robots` and `open` have the choice of choose_by_distance(), and `problem` is made of these robots.
/// Returns the problem with the new choices. None if no choice changes, or if `stop` is met first; then
/// nothing has changed. `finished` is set to whether `stop` was not met.
std::optional<Problem> choose_by_arrival(const Problem& problem, const PlanOptions& options,
                                         std::vector<Robot>& robots, OpenGoals& open, bool& finished,
                                         const StopCondition& stop, Executor& executor);

/// Widens these goals as far as they may be widened, the first hundred of a fleet. Leaves out the poses that
/// do not fit (see leave_out_blocked_poses). Returns whether any goal was widened.
bool widen_goals(const std::shared_ptr<const StaticMap>& map, const std::vector<Zone>& zones, double overlap,
                 std::vector<Robot>& robots, OpenGoals& open, const std::vector<OpenPlace>& places,
                 const StopCondition& stop);

/// Puts the poses that a robot has now last in the next choices, if it has other poses. Returns whether it
/// has any.
bool give_up_poses(std::vector<OpenGoal>& open);

}  // namespace fleetplan::core
