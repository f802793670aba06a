#pragma once

// The fleet at a later moment of its plan, in the map frame: what a robot executes, seen from that moment
// (timeline.cpp), what is released of it already (released.cpp), how robots brake that need time to stop
// (inertia.cpp), which commitments collide and where they have to end (committed_motion.cpp), the robots of
// the next request (advance.cpp).

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// An action is copied several times, which is as much work as reading so many bytes.
inline constexpr std::size_t kWorkOfAnAction = 256;

/// What holds for all robots. Seconds, metres.
struct Moment {
  double at = 0.0;
  std::optional<double> commit;  // the horizon of commitment; none: the action under way
  double pose_tolerance = 0.1;
  double wait_before_move = 0.0;  // of the request's options
  double inflation = 0.0;         // of the request's options
  bool has_horizon = false;       // of the request's options; then the ages of goals count
  /// If robots have reported how far they are released: then each is committed to that and stands until this
  /// time at least, see standing_time.
  std::optional<double> stand_until = {};
};

/// How far a robot says that it is.
struct ReportedState {
  core::ActionPlace place;                         // in one of its actions
  std::optional<double> service_left = {};         // seconds, if the action is a service
  std::optional<core::ActionPlace> released = {};  // it may drive to there; nobody can take that back
};

/// What a robot does, and what happened to it.
struct Execution {
  std::vector<core::Action> actions;  // that it executes, from t = 0 in its start
  bool planned = false;               // they are a plan; otherwise a commitment, at whose end it stays
  std::optional<std::size_t> first_unserved = {};  // the first goal that the plan leaves, by its visits
  std::optional<core::Pose> measured = {};
  std::optional<ReportedState> reported = {};  // measured there, if it has a measured pose, too
  std::optional<double> speed = {};            // measured, metres per second, negative backwards
  std::optional<double> hold = {};             // until then on the clock of the moment
  std::optional<std::vector<core::Goal>> goals = {};
  double stop_distance = 0.0;      // metres that it drives until it can stand, if it drives at the moment
  bool stays_when_served = false;  // then it has no goal any more, and does not move
};

/// Goals that a robot has though it has got other ones.
struct PassedGoals {
  std::size_t first = 0;  // its number among those that it had
  std::size_t count = 0;
};

/// Returns the goals that the commitment of the robot of that moment, `next`, passes and that change its
/// load: the last of them, and those before it, which come before the other goals that it has got. None if it
/// has got none.
PassedGoals passed_goals(const core::Robot& robot, const Execution& execution, const Moment& moment,
                         const core::Robot& next);

/// Leaves out what belongs to commitments that have been ended early: goals that they do not pass any more,
/// and previous actions that POST /v1/plan would not accept.
void leave_out_unfit(std::vector<core::Robot>& next, const std::vector<core::Robot>& robots,
                     const std::vector<Execution>& executions, const Moment& moment, core::Work& work);

/// Returns the robot of the request of that moment: its start, goals, radius, committed and previous actions.
/// Its radius is the one after the goals that it has left behind, and after a last goal that it has served.
/// It has no previous actions if it has no plan, is elsewhere than planned, or gets other goals.
core::Robot advanced(const core::Robot& robot, const Execution& execution, const Moment& moment);

/// Says of the committed and previous waits of the robots which goals they serve, see core::mark_services.
void mark_services(std::vector<core::Robot>& next, core::Work& work);

/// Returns by robot what one that drives at the moment cannot leave out, on the clock of the moment: its
/// motion until it can stand, which it can after its stop distance, and where its plan has it stand. Empty
/// for one that stands, by its plan or because it says so, turns, or is not on its path.
std::vector<std::vector<core::Action>> braking_of(const std::vector<core::Robot>& robots,
                                                  const std::vector<Execution>& executions,
                                                  const Moment& moment, core::Work& work);

/// Returns until when all robots stand, if some have reported how far they are released: until the last of
/// them has come to where it may drive to, and for the horizon of commitment at least. So nobody leaves what
/// is released for it before all others have passed what is released for them, and nobody is planned to pass
/// in front of a robot that nobody can stop any more. Returns none if nobody has reported that.
std::optional<double> standing_time(const std::vector<core::Robot>& robots,
                                    const std::vector<Execution>& executions, const Moment& moment,
                                    core::Work& work);

/// Returns by robot what it keeps around its disk while it is committed: its vicinity and the inflation,
/// metres. Inflation is there for robots that are not where their plans have them, so it is used up by as
/// much as they are elsewhere at the moment, up to a half. What is released cannot be shortened for the sake
/// of a margin: then there is none.
std::vector<double> margins_of(const std::vector<core::Robot>& robots,
                               const std::vector<Execution>& executions, const Moment& moment,
                               const std::vector<core::Robot>& next, core::Work& work);

/// Two robots whose disks overlap.
struct Collision {
  std::size_t first = 0;
  std::size_t second = 0;
  double t = 0.0;  // seconds: 0 if they overlap already, otherwise when they begin to
};

/// Pairs of robots that collide, of which the first are listed.
struct Collisions {
  std::vector<Collision> listed = {};
  std::size_t total = 0;
};

/// Returns the pairs of robots that collide if all execute nothing but their commitments, and then stand:
/// pairs that overlap already, and pairs of which one robot cannot stop in time. `braking`: by robot, see
/// braking_of; a robot executes that, too, if its commitment ends before. Ends early when `work` is met.
Collisions collisions_of_commitments(const std::vector<core::Robot>& robots,
                                     const std::vector<std::vector<core::Action>>& braking, core::Work& work);

/// What commitments are judged by, on the clock of the moment.
struct Motions {
  std::vector<std::vector<core::Action>> braking;       // by robot, see braking_of
  std::vector<std::vector<core::Action>> courses = {};  // by robot: all that it does if it goes on as planned
  std::vector<core::MovingObstacle> obstacles = {};
};

/// Ends committed actions early, so that every robot may stay for ever where its commitment ends: none meets
/// another one, nor passes where another one has ended. Whatever becomes of the plans behind the commitments,
/// nobody then drives into a robot that stands. Robots are only stopped while they drive; a wait stays
/// committed. `margins`: metres, by robot, that they keep around their disks; robots that are nearer to each
/// other at the moment keep half of what they have, or a quarter of the margins if they have that.
/// None of these commitments ends before the braking of its robot, unless it collides with another
/// commitment. Where two robots meet that cannot stop in time, although they would not if they went on as
/// planned, they are committed to that as far as it takes, which is their braking from then on. First,
/// a commitment that leads into an obstacle ends where the robot can stop at last without touching any until
/// it stands, or else as soon as it can. Ends early when `work` is met.
void clear_commitments(std::vector<core::Robot>& robots, const std::vector<double>& margins, Motions& motions,
                       core::Work& work);

/// Returns the robots of the request of that moment. Committed actions end where they touch another robot
/// that is committed or stands at the end of its commitment, or an obstacle: see clear_commitments. `motions`
/// without courses, which are found here.
std::vector<core::Robot> advanced(const std::vector<core::Robot>& robots,
                                  const std::vector<Execution>& executions, const Moment& moment,
                                  Motions& motions, core::Work& work);

/// Returns where the robot is in its actions at the moment: as reported, otherwise as measured, otherwise as
/// planned. A robot that has done all of them is at the end of the last one, and one without actions at the
/// beginning.
core::ActionPlace place_of(const core::Robot& robot, const Execution& execution, const Moment& moment);

/// Returns the rest of an obstacle's motion; none if it has left.
std::optional<core::MovingObstacle> advanced(const core::MovingObstacle& obstacle, double at);

/// How far a robot is in its actions.
struct TimedProgress {
  std::size_t action = 0;  // under way; the number of all actions if they are done
  double t = 0.0;          // the planned time of this progress, seconds
};

/// The rest of a robot's actions on a clock that is 0 at the moment: contiguous from `start` and t = 0.
struct Remainder {
  core::Pose start;
  std::vector<core::Action> actions;
};

/// Returns the progress at this time by the plan.
TimedProgress planned_progress(const std::vector<core::Action>& actions, double at);

/// Returns the pose at this time by the plan.
core::Pose planned_pose(const core::Robot& robot, const std::vector<core::Action>& actions, double at);

/// Returns the progress by a measured pose: the latest action, not later than the one planned at this time,
/// whose path is no further from the pose than the tolerance (metres, and radians of the heading). A robot
/// may be late, or early in the action under way. Returns none if there is no such action.
std::optional<TimedProgress> measured_progress(const core::Robot& robot,
                                               const std::vector<core::Action>& actions,
                                               const core::Pose& pose, double at, double tolerance);

/// Returns the progress that is reported. A service of which something is left counts as one that begins: its
/// goal keeps what is left.
TimedProgress reported_progress(const std::vector<core::Action>& actions, const ReportedState& reported);

/// Returns the pose that the plan has at the reported progress.
core::Pose pose_of(const std::vector<core::Action>& actions, const ReportedState& reported);

/// Whether two poses are no further from each other than this: metres, and radians of heading.
bool is_near(const core::Pose& pose, const core::Pose& other, double tolerance);

/// Returns the actions from this time on.
Remainder remainder(const core::Robot& robot, const std::vector<core::Action>& actions, double at);

/// Returns the remainder of a robot that was measured. It continues a translation straight from the pose to
/// its end, and a rotation from its heading, at the planned speed. The other actions follow as much later as
/// this ends later; if it ends earlier, the robot waits. A robot that stands is where its plan has it.
/// `speed`: measured, metres per second; one with a profile goes on from there, by default from the planned
/// speed.
Remainder remainder_of_measured(const core::Robot& robot, const std::vector<core::Action>& actions,
                                const core::Pose& pose, const TimedProgress& progress, double at,
                                std::optional<double> speed = {});

/// Returns the remainder of a robot that has reported its progress. It goes on in the same way from the
/// measured pose, or from where its plan has it then. A wait goes on for what is left of it. In a wait for a
/// goal, what is left of the service, as planned or reported, begins at the goal's `not_before` at the
/// earliest.
Remainder remainder_of_reported(const core::Robot& robot, const Execution& execution,
                                const TimedProgress& progress, double at);

/// Returns the first actions in one line, until the robot has driven so many metres or stops: those that go
/// on from the first one without a stop. Empty if the first one is no translation.
std::vector<core::Action> driven_until(const std::vector<core::Action>& actions, double metres);

/// Whether a translation goes on with another one, without a stop.
bool goes_on(const core::Action& action, const core::Action& next);

/// What a robot may do already, and what it may not do yet, on a clock that is 0 at the moment.
struct ReleasedRest {
  Remainder rest;                   // to the place that is released
  std::vector<core::Action> after;  // from there on, at its planned times
};

/// Returns the rest of a robot that has reported how far it is released. It goes there as soon as it can,
/// without the waits that only give way to others.
ReleasedRest released_rest(const core::Robot& robot, const Execution& execution, const Moment& moment);

/// Appends actions that follow at their planned times; later, with all that follow, if those before end
/// later; after a wait if they end earlier. Those of an invalid plan may overlap in time.
void append(std::vector<core::Action>& actions, const std::vector<core::Action>& following);

/// Returns what has been executed at `t`, on the clock of the actions; an action under way is cut there.
std::vector<core::Action> executed_until(const std::vector<core::Action>& actions, double t);

/// Returns the actions of a robot that stands from `t` on: one under way is cut there. A robot that needs
/// time to stop brakes before `t`; one that cannot any more brakes from the first action on, and stands
/// later. A rotation with a profile that is under way at t = 0 is whole, and a later one is left out.
std::vector<core::Action> stopped_by(const std::vector<core::Action>& actions, double t);

/// Returns the actions of a robot that begins to brake at `t`. Actions that it has not begun then are left
/// out.
std::vector<core::Action> braked(const std::vector<core::Action>& actions, double t);

/// Goes on after the first actions, which stopped_by() has left of all of them, to the end of these; later if
/// the robot has to start again.
std::vector<core::Action> resumed_after(const std::vector<core::Action>& stopped,
                                        const std::vector<core::Action>& actions);

/// Returns all actions, of which one under way at `t` becomes two: the robot stands at `t`, see stopped_by().
std::vector<core::Action> split_at(const std::vector<core::Action>& actions, double t);

/// Return the parts of an action before and after a time within it. A part with a profile begins, or ends, at
/// the speed that the robot has then.
core::Action part_until(core::Action action, double t);
core::Action part_from(core::Action action, double t);

/// Returns what is left of an action at a time within it: metres, radians, or seconds of a wait.
double left_of(const core::Action& action, double t);

/// Returns the actions, the last of which come to rest: as fast as they can, if they end at a speed.
std::vector<core::Action> at_rest_in_the_end(std::vector<core::Action> actions);

/// Returns one past the last of the actions from an index on that follow each other at speed.
std::size_t end_of_chain(const std::vector<core::Action>& actions, std::size_t first);

/// Drives actions that follow each other at speed, from `t` and a speed on, as fast as their cruise speeds
/// allow, to rest. A speed from which the robot could not stop in time is taken for the greatest from which
/// it can.
std::vector<core::Action> driven_from(std::vector<core::Action> chain, double t, double speed);

/// Puts a wait, from a time at which the robot stands to another one, before the rest of the actions, which
/// it delays, except for the wait under way. A service under way goes on, and stays a service.
void hold(Remainder& rest, double from, double until);

/// Returns the pose in an action at a time within it.
core::Pose pose_at(const core::Action& action, double t);

}  // namespace fleetplan::api
