#pragma once

// The fleet at a later moment of its plan, in the map frame. It has the robots of the next request, and
// whether this request can be planned wherever robots were measured.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/advance/acceptable.h"
#include "core/advance/committed_motion.h"
#include "core/advance/moment.h"
#include "core/execution/dependencies.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The robots of the next request, on the clock of the moment, and the problems that cannot be mended.
struct AdvancedFleet {
  std::vector<Robot> robots;
  Circumstances circumstances;
};

/// Returns the fleet at the moment. Sets the fleet's `stand_until`; see advanced(), make_acceptable() and
/// leave_out_unfit(). Ends early, with a part of the result, when `work` is met.
AdvancedFleet advance(FleetInMotion& fleet, const Judgement& judgement, Work& work);

/// Goals that a robot keeps although it has got new goals.
struct PassedGoals {
  std::size_t first = 0;  // its number among the old goals
  std::size_t count = 0;
};

/// Returns the old goals that a robot with new goals keeps. Let g be the last goal that its commitment passes
/// and whose service changes its load: the robot keeps the goals up to g. `next` is the robot at the moment;
/// the kept goals come before its new goals. None if it has no new goals.
PassedGoals passed_goals(const Robot& robot, const Execution& execution, const Moment& moment,
                         const Robot& next);

/// Leaves out what belonged to commitments that were ended early: goals that they no longer pass, and
/// previous actions that POST /v1/plan would not accept.
void leave_out_unfit(std::vector<Robot>& next, const std::vector<Robot>& robots,
                     const std::vector<Execution>& executions, const Moment& moment, Work& work);

/// Returns the robot of the request of that moment: its start, goals, radius, committed and previous actions.
/// Its radius takes into account the goals that it has left, and a last goal that it has served.
///
/// It has no previous actions if it has no plan, is elsewhere than planned, or gets new goals.
Robot advanced(const Robot& robot, const Execution& execution, const Moment& moment);

/// Marks the committed and previous waits of the robots with the goals that they serve, like mark_services()
/// of core/model for one robot.
void mark_services(std::vector<Robot>& next, Work& work);

/// For each robot: the actions that it can no longer avoid before it can stop, on the clock of the moment.
/// The robot can stop after its stop distance, and where its plan has it stand. Empty for a robot that
///
/// - stands, by its plan or because it says so,
/// - turns,
/// - or is not on its path.
std::vector<std::vector<Action>> braking_of(const std::vector<Robot>& robots,
                                            const std::vector<Execution>& executions, const Moment& moment,
                                            Work& work);

/// Returns until when all robots stand, if some have reported how far they are released. They stand until the
/// last of them has reached the end of what is released, and at least for the horizon of commitment. None if
/// no robot has reported this.
///
/// So no robot leaves the end of what is released for it before all others have passed what is released for
/// them. And no robot is planned to pass in front of a robot that cannot be stopped any more.
std::optional<double> standing_time(const std::vector<Robot>& robots,
                                    const std::vector<Execution>& executions, const Moment& moment,
                                    Work& work);

/// Returns the robots of the request of that moment. Committed actions end where they touch an obstacle, or
/// another robot that is committed or stands at the end of its commitment; see clear_commitments. `motions`
/// has no courses; they are found here.
std::vector<Robot> advanced(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                            const Moment& moment, Motions& motions, Work& work);

/// Returns where the robot is in its actions at the moment: as reported, otherwise as measured, otherwise as
/// planned. A robot that has done all of them is at the end of the last one. A robot without actions is at
/// the beginning.
ActionPlace place_of(const Robot& robot, const Execution& execution, const Moment& moment);

/// Returns the rest of an obstacle's motion; none if it has left.
std::optional<MovingObstacle> advanced(const MovingObstacle& obstacle, double at);

}  // namespace fleetplan::core
