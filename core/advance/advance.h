#pragma once

// The fleet at a later moment of its plan, in the map frame: the robots of the next request, and whether that
// can be planned wherever robots were measured.

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

/// The robots of the next request, on the clock of the moment, and what cannot be mended.
struct AdvancedFleet {
  std::vector<Robot> robots;
  Circumstances circumstances;
};

/// Returns the fleet of the moment, whose `stand_until` is set; see advanced(), make_acceptable() and
/// leave_out_unfit(). Ends early, with a part of that, when `work` is met.
AdvancedFleet advance(FleetInMotion& fleet, const Judgement& judgement, Work& work);

/// Goals that a robot has though it has got other ones.
struct PassedGoals {
  std::size_t first = 0;  // its number among those that it had
  std::size_t count = 0;
};

/// Returns the goals that the commitment of the robot of that moment, `next`, passes and that change its
/// load: the last of them, and those before it, which come before the other goals that it has got. None if it
/// has got none.
PassedGoals passed_goals(const Robot& robot, const Execution& execution, const Moment& moment,
                         const Robot& next);

/// Leaves out what belongs to commitments that have been ended early: goals that they do not pass any more,
/// and previous actions that POST /v1/plan would not accept.
void leave_out_unfit(std::vector<Robot>& next, const std::vector<Robot>& robots,
                     const std::vector<Execution>& executions, const Moment& moment, Work& work);

/// Returns the robot of the request of that moment: its start, goals, radius, committed and previous actions.
/// Its radius is the one after the goals that it has left behind, and after a last goal that it has served.
/// It has no previous actions if it has no plan, is elsewhere than planned, or gets other goals.
Robot advanced(const Robot& robot, const Execution& execution, const Moment& moment);

/// Says of the committed and previous waits of the robots which goals they serve, as the function of
/// core/model/itinerary.h does for one robot.
void mark_services(std::vector<Robot>& next, Work& work);

/// Returns by robot what one that drives at the moment cannot leave out, on the clock of the moment: its
/// motion until it can stand, which it can after its stop distance, and where its plan has it stand. Empty
/// for one that stands, by its plan or because it says so, turns, or is not on its path.
std::vector<std::vector<Action>> braking_of(const std::vector<Robot>& robots,
                                            const std::vector<Execution>& executions, const Moment& moment,
                                            Work& work);

/// Returns until when all robots stand, if some have reported how far they are released: until the last of
/// them has come to where it may drive to, and for the horizon of commitment at least. So nobody leaves what
/// is released for it before all others have passed what is released for them, and nobody is planned to pass
/// in front of a robot that nobody can stop any more. Returns none if nobody has reported that.
std::optional<double> standing_time(const std::vector<Robot>& robots,
                                    const std::vector<Execution>& executions, const Moment& moment,
                                    Work& work);

/// Returns the robots of the request of that moment. Committed actions end where they touch another robot
/// that is committed or stands at the end of its commitment, or an obstacle: see clear_commitments. `motions`
/// without courses, which are found here.
std::vector<Robot> advanced(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                            const Moment& moment, Motions& motions, Work& work);

/// Returns where the robot is in its actions at the moment: as reported, otherwise as measured, otherwise as
/// planned. A robot that has done all of them is at the end of the last one, and one without actions at the
/// beginning.
ActionPlace place_of(const Robot& robot, const Execution& execution, const Moment& moment);

/// Returns the rest of an obstacle's motion; none if it has left.
std::optional<MovingObstacle> advanced(const MovingObstacle& obstacle, double at);

}  // namespace fleetplan::core
