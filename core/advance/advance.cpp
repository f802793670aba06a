#include "core/advance/advance.h"

#include <fleetplan/limits.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/advance/inertia.h"
#include "core/advance/released.h"
#include "core/advance/timeline.h"
#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

/// The tolerance of a service, seconds: rounding of times, far below what matters.
constexpr double kSameService = 1e-9;

/// The goals that are left when a robot has executed these actions, and how many it has visited.
struct GoalsLeft {
  std::vector<Goal> goals;
  std::size_t visited = 0;
  Load load;         // of the robot
  double age = 0.0;  // seconds for which the next goal has been waiting
};

/// Whether the last goal has been served by the rest at the end of a plan.
bool has_served_last(const Robot& robot, const ActionSequence& actions, double progress) {
  return last_service_end(robot, actions) <= progress + kSameService;
}

/// The first of these goals that changes the radius.
std::optional<std::size_t> first_new_radius(const Robot& robot, std::size_t begin, std::size_t end) {
  for (std::size_t k = begin; k < end; ++k) {
    if (robot.goal_at(k).radius_after) return k;
  }
  return std::nullopt;
}

/// Gives the load after a goal that is served, once.
void take_load(Goal& goal, Load& load) {
  load = load_after(load, goal);
  goal.radius_after.reset();
  goal.linear_speed_after.reset();
  goal.linear_acceleration_after.reset();
  goal.linear_deceleration_after.reset();
}

/// What is left of the service at this goal, if the robot has reported it.
std::optional<double> service_left_of(const Execution& execution, std::size_t goal) {
  if (!execution.reported || execution.actions[execution.reported->place.action].goal != goal)
    return std::nullopt;
  return execution.reported->service_left;
}

/// `progress`: the planned time of the actions that the robot has executed. After the last action, it stands.
GoalsLeft goals_left(const Robot& robot, const Execution& execution, double progress, double at) {
  const ActionSequence& actions = execution.actions;
  Robot past = robot;
  past.committed = executed_until(actions, progress);
  if (past.committed.empty() && execution.planned) {  // what its plan serves at the start
    past.committed.push_back({Action::Type::wait, 0.0, 0.0, robot.start, robot.start});
  }
  const std::size_t visited_by_plan = itinerary_of(past).first_goal;
  if (past.committed_until() < progress) {
    const Pose pose = past.committed_end();
    past.committed.push_back({Action::Type::wait, past.committed_until(), progress, pose, pose});
  }
  const Itinerary itinerary = itinerary_of(past);
  GoalsLeft left;
  // Nobody has made room for a robot without a plan: it has been served, but its load is still to come.
  const auto load =
      execution.planned ? std::nullopt : first_new_radius(robot, visited_by_plan, itinerary.first_goal);
  left.visited =
      std::min(load.value_or(itinerary.first_goal), execution.first_unserved.value_or(robot.goal_count()));
  for (std::size_t k = left.visited; k < robot.goal_count(); ++k) {
    Goal goal = robot.goal_at(k);
    goal.not_before = std::max(0.0, goal.not_before - at);
    if (goal.due) goal.due = std::max(-kLongestTime, *goal.due - at);
    left.goals.push_back(goal);
  }
  left.load = loads_of(robot)[left.visited];
  if (left.goals.empty()) return left;
  double due = itinerary.visited.empty() ? -robot.goal_age : itinerary.visited.back().t_leave;
  const double not_before = robot.goal_at(left.visited).not_before;
  if (not_before > 0.0) due = std::max(due, not_before);
  left.age = std::clamp(at - due, 0.0, kLongestTime);
  Goal& last = left.goals.back();
  const bool matters = last.changes_load() || execution.stays_when_served;
  const bool serves_all = execution.planned && !execution.first_unserved;
  const bool is_served = matters && serves_all && has_served_last(robot, actions, progress);
  if (is_served) take_load(last, left.load);
  if (is_served && execution.stays_when_served) {
    left.visited = robot.goal_count();
    left.goals.clear();
    return left;
  }
  Goal& next = left.goals.front();
  const auto reported = service_left_of(execution, left.visited);
  const double served = left.visited < itinerary.first_goal ? next.service : itinerary.service_done;
  next.service = load ? 0.0 : reported.value_or(std::max(0.0, next.service - served));
  if (next.service <= kSameService) next.service = 0.0;
  return left;
}

void set_goals(Robot& robot, std::vector<Goal> goals) {
  robot.goal.reset();
  if (!goals.empty()) {
    robot.goal = goals.back();
    goals.pop_back();
  }
  robot.via = std::move(goals);
}

/// The wait for a goal is named after its new number, or has no name if the goal is behind.
void renumber(ActionSequence& actions, std::size_t visited) {
  for (Action& action : actions) {
    if (!action.goal) continue;
    if (*action.goal < visited) {
      action.goal.reset();
    } else {
      *action.goal -= visited;
    }
  }
}

/// Counts the goals that a robot's committed actions serve, up to the last goal that changes its load.
std::size_t count_of_passed(const Robot& next, const std::vector<Goal>& goals) {
  if (next.committed.empty()) return 0;
  Robot passing = next;
  passing.via = goals;
  passing.goal.emplace().anywhere = true;  // the last goal always remains: so all of these may be served
  std::size_t count = served_goals(passing, next.committed).visits.size();
  while (count > 0 && !goals[count - 1].changes_load()) --count;
  return count;
}

/// Gives a robot new goals instead of the goals that are left. Goals that its commitment passes and that
/// change its load come before them. A robot that gets no new goals parks where its commitment ends.
void set_other_goals(Robot& next, std::vector<Goal> left, const std::vector<Goal>& other) {
  left.resize(count_of_passed(next, left));
  for (Action& action : next.committed) {
    if (action.goal && *action.goal >= left.size()) action.goal.reset();
  }
  if (!left.empty() && other.empty()) {
    left.push_back({next.committed_end().position, next.committed_end().theta});
  }
  left.insert(left.end(), other.begin(), other.end());
  set_goals(next, std::move(left));
}

/// A service under way and the wait that is left of it end together, whatever the rounding.
void align_service(Robot& robot, const Remainder& rest) {
  if (robot.goal_count() == 0 || rest.actions.empty() || rest.actions.front().goal != 0U) return;
  Goal& next = robot.via.empty() ? *robot.goal : robot.via.front();
  const double end = rest.actions.front().t_end;
  if (next.not_before == 0.0 && std::abs(end - next.service) <= kSameService) next.service = end;
}

/// Until when the actions are committed.
double horizon(const ActionSequence& actions, const Moment& moment) {
  std::size_t move = 0;
  while (move < actions.size() && actions[move].type == Action::Type::wait) ++move;
  double until = moment.commit.value_or(move == 0 && !actions.empty() ? actions.front().t_end : 0.0);
  // The rest of a wait before a move that has begun is committed, so that it counts as begun.
  const bool has_begun_the_wait = move > 0 && move < actions.size() && moment.at > 0.0 &&
                                  actions[move].type == Action::Type::translate &&
                                  actions[move].t_start < moment.wait_before_move;
  if (has_begun_the_wait) until = std::max(until, actions[move].t_start);
  return until;
}

/// How far a robot is.
struct Located {
  TimedProgress progress;
  bool is_elsewhere = false;  // measured further from there than the tolerance
};

Located locate(const Robot& robot, const Execution& execution, const Moment& moment) {
  const ActionSequence& actions = execution.actions;
  const auto& measured = execution.measured;
  if (execution.reported) {
    const TimedProgress progress = reported_progress(actions, *execution.reported);
    const Pose there = pose_of(actions, *execution.reported);
    return {progress, measured && !is_near(there, *measured, moment.pose_tolerance)};
  }
  const TimedProgress planned = planned_progress(actions, moment.at);
  if (!measured) return {planned};
  const auto progress = measured_progress(robot, actions, *measured, moment.at, moment.pose_tolerance);
  return {progress.value_or(planned), !progress};
}

/// Lets an early robot drive on if its plan has no stop between the translation under way and the next one.
/// After this line, it waits for its planned time.
void wait_after_line(ActionSequence& rest) {
  std::size_t last = 2;
  while (last + 1 < rest.size() && goes_on(rest[last], rest[last + 1])) ++last;
  const double early = rest[1].t_end - rest[1].t_start;
  for (std::size_t k = 2; k <= last; ++k) {
    rest[k].t_start -= early;
    rest[k].t_end -= early;
  }
  const Pose& end = rest[last].to;
  const Action wait{Action::Type::wait, rest[last].t_end, rest[last].t_end + early, end, end};
  rest.insert(rest.begin() + static_cast<std::ptrdiff_t>(last) + 1, wait);
  rest.erase(rest.begin() + 1);
}

/// What it does from there on.
Remainder remainder_of(const Robot& robot, const Execution& execution, const Located& located,
                       const Moment& moment) {
  const ActionSequence& actions = execution.actions;
  const auto& measured = execution.measured;
  const TimedProgress& progress = located.progress;
  if (located.is_elsewhere) return {*measured, {}};
  if (!execution.reported && !measured) return remainder(robot, actions, moment.at);
  Remainder rest = execution.reported ? remainder_of_reported(robot, execution, progress, moment.at)
                                      : remainder_of_measured(robot, actions, *measured, progress, moment.at,
                                                              execution.speed);
  const bool is_in_line = execution.stop_distance > 0.0 && progress.action + 1 < actions.size() &&
                          goes_on(actions[progress.action], actions[progress.action + 1]);
  const bool stops = rest.actions.size() > 2 && rest.actions[0].type == Action::Type::translate &&
                     rest.actions[1].type == Action::Type::wait;
  if (is_in_line && stops) wait_after_line(rest.actions);
  return rest;
}

/// Until when it has served goals, on the clock of its actions. A robot that is still on the way to the end
/// of an action has served nothing there. This holds however near it is, and whatever it reports.
double served_until(const Robot& robot, const Execution& execution, const Located& located,
                    const Moment& moment) {
  const auto [index, t] = located.progress;
  if (located.is_elsewhere || index >= execution.actions.size()) return t;
  const Action& action = execution.actions[index];
  if (action.type == Action::Type::wait || t <= action.t_start) return t;
  if (!execution.measured && !execution.reported) return action.t_start;
  const Remainder rest = remainder_of(robot, execution, located, moment);
  const bool goes_on = !rest.actions.empty() && rest.actions.front().type == action.type &&
                       rest.actions.front().to.position == action.to.position;
  return goes_on ? action.t_start : t;
}

GoalsLeft goals_left(const Robot& robot, const Execution& execution, const Located& located,
                     const Moment& moment) {
  return goals_left(robot, execution, served_until(robot, execution, located, moment), moment.at);
}

/// Whether a robot at this progress is on the way, and not only about to set out. Its own report counts.
bool drives(const Robot& robot, const Execution& execution, const TimedProgress& progress) {
  const ActionSequence& actions = execution.actions;
  const auto [index, t] = progress;
  const auto& speed = execution.speed;
  if (speed && std::abs(*speed) < kLeastLinearSpeed) return false;
  if (index >= actions.size() || actions[index].type != Action::Type::translate) return false;
  if (t >= actions[index].t_end)
    return index + 1 < actions.size() && goes_on(actions[index], actions[index + 1]);
  if (t > actions[index].t_start || speed) return true;
  // At its begin: it goes on, or it was under way when its actions began.
  return index > 0 ? goes_on(actions[index - 1], actions[index]) : !robot.committed.empty();
}

bool needs_time_to_stop(const Robot& robot) {
  return robot.linear_inertia().is_limited || robot.angular_inertia().is_limited;
}

/// Whether the actions from an index on have profiles as in a plan for the robot.
bool have_profiles(const ActionSequence& actions, std::size_t first, const Robot& robot) {
  const auto has_its_own = [&](const Action& action) {
    return action.profile || !robot.limits_changes_of_speed(action.type);
  };
  const auto begin = actions.begin() + static_cast<std::ptrdiff_t>(std::min(first, actions.size()));
  return std::all_of(begin, actions.end(), has_its_own);
}

/// Whether POST /v1/plan accepts previous actions of this robot, as far as their times, profiles and loads
/// go. Only committed motion may be measured.
bool is_accepted(const ActionSequence& previous, const Robot& robot) {
  const double end = previous.empty() ? 0.0 : previous.back().t_end;
  return end <= kLongestTime && have_profiles(previous, robot.committed.size(), robot) &&
         count_of_executable(robot, previous) == previous.size();
}

/// Ends a commitment where the robot takes a load with which it cannot execute the next actions. A robot that
/// is held, or gets new goals, may serve a goal where its plan did not.
void end_before_unfit_load(Robot& robot) {
  const std::size_t count = count_of_executable(robot, robot.committed);
  if (count > 0 || robot.committed_speed() == 0.0) robot.committed.resize(count);
}

/// What it cannot leave out of this remainder.
ActionSequence braking_in(const Remainder& rest, const Robot& robot, const Execution& execution,
                          const Located& located) {
  if (located.is_elsewhere || rest.actions.empty()) return {};
  // With a profile, the robot brakes by itself.
  if (rest.actions.front().profile) return braked(rest.actions, 0.0);
  const bool brakes = execution.stop_distance > 0.0 && drives(robot, execution, located.progress);
  return brakes ? driven_until(rest.actions, execution.stop_distance) : ActionSequence();
}

/// When it can stand at the earliest, seconds.
double standing_from(const Remainder& rest, const Robot& robot, const Execution& execution,
                     const Located& located) {
  const ActionSequence braking = braking_in(rest, robot, execution, located);
  return braking.empty() ? 0.0 : braking.back().t_end;
}

bool is_released(const Execution& execution) { return execution.reported && execution.reported->released; }

/// What it may do already, after it has been held.
ReleasedRest held_rest(const Robot& robot, const Execution& execution, const Located& located,
                       const Moment& moment) {
  ReleasedRest released = released_rest(robot, execution, moment);
  const double stands_from = standing_from(released.rest, robot, execution, located);
  if (execution.hold) hold(released.rest, stands_from, *execution.hold);
  return released;
}

/// All that a robot will do, and until when it is committed to that.
struct Course {
  Remainder rest;
  double committed_until = 0.0;
};

Course usual_course(const Robot& robot, const Execution& execution, const Located& located,
                    const Moment& moment) {
  Course course{remainder_of(robot, execution, located, moment)};
  const double stands_from = standing_from(course.rest, robot, execution, located);
  // It begins to brake at the horizon of commitment.
  double until = horizon(course.rest.actions, moment);
  if (needs_time_to_stop(robot)) {
    const ActionSequence to_rest = braked(course.rest.actions, until);
    if (!to_rest.empty()) until = std::max(until, to_rest.back().t_end);
  }
  if (execution.hold) {
    hold(course.rest, stands_from, *execution.hold);
    until = *execution.hold;
  }
  course.committed_until = std::max(until, stands_from);
  return course;
}

/// Returns the course of a robot in a fleet in which some are released to go on: it does what is released,
/// and then stands.
Course standing_course(const Robot& robot, const Execution& execution, const Located& located,
                       const Moment& moment) {
  if (!is_released(execution) || located.is_elsewhere) {
    Course course{remainder_of(robot, execution, located, moment)};
    const double stands_from = standing_from(course.rest, robot, execution, located);
    course.committed_until = std::max({*moment.stand_until, execution.hold.value_or(0.0), stands_from});
    if (course.committed_until > 0.0) hold(course.rest, stands_from, course.committed_until);
    return course;
  }
  ReleasedRest released = held_rest(robot, execution, located, moment);
  Course course{std::move(released.rest)};
  ActionSequence& actions = course.rest.actions;
  const double end = actions.empty() ? 0.0 : actions.back().t_end;
  course.committed_until = std::max(end, *moment.stand_until);
  if (course.committed_until - end >= kLeastAction) {
    const Pose pose = actions.empty() ? course.rest.start : actions.back().to;
    actions.push_back({Action::Type::wait, end, course.committed_until, pose, pose});
  }
  append(actions, released.after);
  return course;
}

/// What this robot cannot leave out.
ActionSequence braking_of(const Robot& robot, const Execution& execution, const Moment& moment) {
  if (execution.stop_distance <= 0.0 && !needs_time_to_stop(robot)) return {};
  const Located located = locate(robot, execution, moment);
  const Remainder rest = is_released(execution) && !located.is_elsewhere
                             ? released_rest(robot, execution, moment).rest
                             : remainder_of(robot, execution, located, moment);
  return braking_in(rest, robot, execution, located);
}

}  // namespace

namespace {

/// A robot at the moment, and all that it does if it goes on as planned.
struct Advanced {
  Robot robot;
  ActionSequence course;
};

Advanced advanced_with_course(const Robot& robot, const Execution& execution, const Moment& moment) {
  const Located located = locate(robot, execution, moment);
  Course course = moment.stand_until ? standing_course(robot, execution, located, moment)
                                     : usual_course(robot, execution, located, moment);
  Remainder& rest = course.rest;
  GoalsLeft left = goals_left(robot, execution, located, moment);

  Robot next = robot;
  next.start = rest.start;
  set_load(next, left.load);
  renumber(rest.actions, left.visited);
  course.committed_until = std::min(course.committed_until, kLongestTime);
  next.committed = stopped_by(rest.actions, course.committed_until);
  if (execution.goals) {
    set_other_goals(next, std::move(left.goals), *execution.goals);
  } else {
    set_goals(next, std::move(left.goals));
    align_service(next, rest);
  }
  end_before_unfit_load(next);
  const bool counts_age = moment.has_horizon && next.goal && !execution.goals;
  next.goal_age = counts_age && !has_arrived(itinerary_of(next)) ? left.age : 0.0;
  next.previous.reset();
  const bool goes_on = execution.planned && !located.is_elsewhere && !execution.goals;
  if (goes_on) {
    next.previous = split_at(rest.actions, course.committed_until);
    if (!is_accepted(*next.previous, next)) next.previous.reset();
  }
  return {std::move(next), std::move(rest.actions)};
}

}  // namespace

Robot advanced(const Robot& robot, const Execution& execution, const Moment& moment) {
  return advanced_with_course(robot, execution, moment).robot;
}

PassedGoals passed_goals(const Robot& robot, const Execution& execution, const Moment& moment,
                         const Robot& next) {
  if (!execution.goals) return {};
  const GoalsLeft left = goals_left(robot, execution, locate(robot, execution, moment), moment);
  return {left.visited, count_of_passed(next, left.goals)};
}

void leave_out_unfit(std::vector<Robot>& next, const std::vector<Robot>& robots,
                     const std::vector<Execution>& executions, const Moment& moment, Work& work) {
  for (std::size_t k = 0; k < next.size(); ++k) {
    if (work.met_after(1 + executions[k].actions.size())) return;
    Robot& robot = next[k];
    if (robot.previous && !is_accepted(*robot.previous, robot)) robot.previous.reset();
    if (!executions[k].goals) continue;
    if (work.met_after(kWorkOfAnAction * (1 + executions[k].actions.size()))) return;
    const Located located = locate(robots[k], executions[k], moment);
    set_other_goals(robot, goals_left(robots[k], executions[k], located, moment).goals, *executions[k].goals);
  }
}

void mark_services(std::vector<Robot>& next, Work& work) {
  for (Robot& robot : next) {
    const std::size_t previous = robot.previous ? robot.previous->size() : 0;
    if (work.met_after(kWorkOfAnAction * (1 + robot.committed.size() + previous))) return;
    mark_services(robot, robot.committed, 0);
    if (robot.previous) mark_services(robot, *robot.previous, 0);
  }
}

std::vector<ActionSequence> braking_of(const std::vector<Robot>& robots,
                                       const std::vector<Execution>& executions, const Moment& moment,
                                       Work& work) {
  std::vector<ActionSequence> braking(robots.size());
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (work.met_after(kWorkOfAnAction * (1 + executions[k].actions.size()))) break;
    braking[k] = braking_of(robots[k], executions[k], moment);
  }
  return braking;
}

std::optional<double> standing_time(const std::vector<Robot>& robots,
                                    const std::vector<Execution>& executions, const Moment& moment,
                                    Work& work) {
  std::optional<double> until;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    const Execution& execution = executions[k];
    if (!is_released(execution)) continue;
    if (work.met_after(kWorkOfAnAction * (1 + execution.actions.size()))) break;
    until = std::max(until.value_or(0.0), moment.commit.value_or(0.0));
    const Located located = locate(robots[k], execution, moment);
    if (located.is_elsewhere) continue;
    for (const Action& action : held_rest(robots[k], execution, located, moment).rest.actions) {
      if (action.type == Action::Type::translate) until = std::max(*until, action.t_end);
    }
  }
  return until;
}

ActionPlace place_of(const Robot& robot, const Execution& execution, const Moment& moment) {
  if (execution.reported) return execution.reported->place;
  const ActionSequence& actions = execution.actions;
  const TimedProgress progress = locate(robot, execution, moment).progress;
  if (progress.action == actions.size())
    return actions.empty() ? ActionPlace{} : ActionPlace{actions.size() - 1, 1.0};
  const Action& action = actions[progress.action];
  const bool takes_time = action.t_end > action.t_start;
  return {progress.action, takes_time ? share_at(action, progress.t) : 0.0};
}

std::vector<Robot> advanced(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                            const Moment& moment, Motions& motions, Work& work) {
  std::vector<Robot> next;
  next.reserve(robots.size());
  motions.courses.resize(robots.size());
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (work.met_after(kWorkOfAnAction * (1 + executions[k].actions.size()))) return next;
    auto [robot, course] = advanced_with_course(robots[k], executions[k], moment);
    next.push_back(std::move(robot));
    // What is held or has been released goes no further.
    if (!moment.stand_until && !executions[k].hold) motions.courses[k] = std::move(course);
  }
  clear_commitments(next, margins_of(robots, executions, moment, next, work), motions, work);
  return next;
}

std::optional<MovingObstacle> advanced(const MovingObstacle& obstacle, double at) {
  MovingObstacle left = obstacle;
  left.motion.clear();
  for (const auto& entry : obstacle.motion) {
    if (entry.t >= at) left.motion.push_back({entry.t - at, entry.position});
  }
  const std::size_t passed = obstacle.motion.size() - left.motion.size();
  if (passed == 0) return left;
  const auto& before = obstacle.motion[passed - 1];
  if (left.motion.empty()) {
    if (obstacle.after == MovingObstacle::After::leaves) return std::nullopt;
    left.motion.push_back({0.0, before.position});
  } else if (left.motion.front().t > 0.0) {
    const auto& after = obstacle.motion[passed];
    const double share = (at - before.t) / (after.t - before.t);
    left.motion.insert(left.motion.begin(),
                       {0.0, before.position + share * (after.position - before.position)});
  }
  return left;
}

AdvancedFleet advance(FleetInMotion& fleet, const Judgement& judgement, Work& work) {
  Moment& moment = fleet.moment;
  moment.stand_until = standing_time(fleet.robots, fleet.executions, moment, work);
  Motions motions{braking_of(fleet.robots, fleet.executions, moment, work)};
  for (const MovingObstacle& obstacle : fleet.obstacles) {
    if (moment.stand_until) break;  // what is released cannot be shortened for them
    if (auto left = advanced(obstacle, moment.at)) motions.obstacles.push_back(std::move(*left));
  }
  AdvancedFleet next{advanced(fleet.robots, fleet.executions, moment, motions, work), {}};
  if (work.met()) return next;
  next.circumstances = make_acceptable(fleet, judgement, next.robots, motions, work);
  leave_out_unfit(next.robots, fleet.robots, fleet.executions, moment, work);
  mark_services(next.robots, work);
  return next;
}

}  // namespace fleetplan::core
