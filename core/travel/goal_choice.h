#pragma once

// Which poses robots take whose goals may be served at one of several ones.

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

/// The robots of a problem in which goals are open, those that are put off included.
struct OpenFleet {
  std::vector<Robot> robots;  // their goals have the poses that are chosen
  OpenGoals goals;            // by robot
};

/// Leaves out the poses at which the disk of the robot overlaps an obstacle or a blocked zone, or at last
/// goals overlaps it by more than `overlap` (metres, of the bare disk). A goal that would have none keeps
/// them all, and is returned. Poses at which a goal would be put off, because of a zone that nobody enters,
/// become the last ones to be chosen. Settled goals stay as they are, and all do if `stop` is met first.
std::vector<OpenPlace> leave_out_blocked_poses(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, double overlap,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop);

/// Chooses poses for the goals that are not settled as if there were nothing but straight lines. Robots that
/// stay at their last goals get poses where they do not overlap, those of all robots the nearest ones in sum.
/// Returns the goals for which there is no such pose.
std::vector<OpenPlace> choose_by_distance(std::vector<Robot>& robots, OpenGoals& open,
                                          const StopCondition& stop);

/// An open goal for which there is no pose.
struct WithoutPose {
  OpenPlace place;
  bool any_fits = false;  // then robots that stay take all that fit
};

/// Chooses poses for the goals of robots as far as that takes no search: those at which committed and
/// previous actions serve them, which settles them, and others by leave_out_blocked_poses() and
/// choose_by_distance(). Goals with a tolerance are widened where their own pose is of no use; if that does
/// not help, they keep it. Goals of robots that are invalid are no longer open. Of the options, those count
/// by which last goals may overlap. Returns the goals without a pose; not all of them if `stop` is met first.
std::vector<WithoutPose> choose_without_search(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, const PlanOptions& options,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop);

/// Chooses poses again by when the robots would arrive, each alone on the map (see arrivals()): for last
/// goals those of the least sum of weighted arrivals and biases; for others one robot after the other, which
/// waits for those before it. `robots` and `open` have the choice of choose_by_distance(), and `problem` is
/// made of these robots. Returns the problem with these choices; none if all choices stay, or if `stop` is
/// met first: then nothing has changed. `finished` is set to whether it was not.
std::optional<Problem> choose_by_arrival(const Problem& problem, const PlanOptions& options,
                                         std::vector<Robot>& robots, OpenGoals& open, bool& finished,
                                         const StopCondition& stop, Executor& executor);

/// Widens these goals as far as they may be, the first hundred of a fleet, and leaves out the poses that do
/// not fit (see leave_out_blocked_poses). Returns whether there is any.
bool widen_goals(const std::shared_ptr<const StaticMap>& map, const std::vector<Zone>& zones, double overlap,
                 std::vector<Robot>& robots, OpenGoals& open, const std::vector<OpenPlace>& places,
                 const StopCondition& stop);

/// Makes the poses that a robot has the last ones to be chosen again, where it has others. Returns whether it
/// has any.
bool give_up_poses(std::vector<OpenGoal>& open);

}  // namespace fleetplan::core
