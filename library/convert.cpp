#include "library/convert.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/model/action.h"
#include "core/model/objective_share.h"

namespace fleetplan::library {

namespace {

/// Whether two enumerations have equal values. The arguments are the last value of each; the values are in
/// the same order.
template <typename A, typename B>
constexpr bool same(A a, B b) {
  return static_cast<int>(a) == static_cast<int>(b);
}
static_assert(same(Action::Type::wait, core::Action::Type::wait));
static_assert(same(Zone::Type::one_way, core::Zone::Type::one_way));
static_assert(same(Options::Mode::anytime, core::PlanOptions::Mode::anytime));
static_assert(same(Options::Objective::makespan, core::PlanOptions::Objective::makespan));
static_assert(same(Options::Objective::tardiness, core::PlanOptions::Objective::tardiness));
static_assert(same(Options::Priority::random, core::PlanOptions::Priority::random));
static_assert(same(Options::Reordering::none, core::PlanOptions::Reordering::none));
static_assert(same(Options::Replan::where_needed, core::PlanOptions::Replan::where_needed));
static_assert(same(Unplanned::Reason::invalid, core::Unplanned::Reason::invalid));
static_assert(same(Violation::Kind::zone, core::Violation::Kind::zone));

core::SpeedProfile profile_of(const Profile& profile) {
  return {
      profile.start, profile.cruise, profile.end, {1.0 / profile.acceleration, 1.0 / profile.deceleration}};
}

}  // namespace

core::Pose Frame::to_core(const Pose& pose) const {
  return {to_core(pose.x, pose.y), core::normalize_angle(pose.theta)};
}

core::Action Frame::to_core(const Action& action) const {
  return {.type = static_cast<core::Action::Type>(action.type),
          .t_start = action.t_start,
          .t_end = action.t_end,
          .from = to_core(action.from),
          .to = to_core(action.to),
          .goal = action.goal,
          .reverse = action.reverse,
          .profile = action.profile ? std::optional(profile_of(*action.profile)) : std::nullopt};
}

Pose Frame::from_core(const core::Pose& pose) const {
  const core::Position position = pose.position + origin_;
  return {position.x(), position.y(), pose.theta};
}

Action Frame::from_core(const core::Action& action) const {
  Action made{.type = static_cast<Action::Type>(action.type),
              .t_start = action.t_start,
              .t_end = action.t_end,
              .from = from_core(action.from),
              .to = from_core(action.to),
              .goal = action.goal,
              .reverse = action.reverse};
  if (const auto& profile = action.profile) {
    made.profile = {.start = profile->start,
                    .cruise = profile->cruise,
                    .end = profile->end,
                    .acceleration = 1.0 / profile->inertia.rise,
                    .deceleration = 1.0 / profile->inertia.fall};
  }
  return made;
}

core::OccupancyGrid grid_of(const Map& map) {
  core::OccupancyGrid grid(map.columns(), map.rows(), map.resolution());
  for (int row = 0; row < map.rows(); ++row) {
    for (int column = 0; column < map.columns(); ++column) {
      if (map.blocked(column, row)) grid.block({column, row});
    }
  }
  return grid;
}

namespace {

std::optional<double> normalized(const std::optional<double>& theta) {
  return theta ? std::optional(core::normalize_angle(*theta)) : std::nullopt;
}

/// Gives a goal the pose at which it is served, or the first pose at which it may be served.
void set_pose(core::Goal& made, const Goal& goal, const Frame& frame) {
  std::optional<double> theta = goal.theta;
  made.position = frame.to_core(goal.x, goal.y);
  if (!goal.any_of.empty()) {
    const std::size_t choice = goal.choice.value_or(0);
    const Alternative& pose = goal.any_of[choice < goal.any_of.size() ? choice : 0];
    theta = pose.theta;
    made.position = frame.to_core(pose.x, pose.y);
  }
  if (goal.tolerance > 0.0 && goal.place) made.position = frame.to_core(goal.place->x, goal.place->y);
  made.theta = normalized(theta);
}

}  // namespace

core::Robot robot_of(const Robot& robot, const Frame& frame) {
  core::Robot made;
  made.id = robot.id;
  made.radius = robot.radius;
  made.linear_speed = robot.linear_speed;
  made.angular_speed = robot.angular_speed;
  made.start = frame.to_core(robot.start);
  made.may_reverse = robot.may_reverse;
  made.vicinity = robot.vicinity;
  made.goal_age = robot.goal_age;
  made.weight = robot.weight;
  made.linear_acceleration = robot.linear_acceleration.value_or(core::Robot::kNoLimit);
  made.linear_deceleration = robot.linear_deceleration.value_or(made.linear_acceleration);
  made.angular_acceleration = robot.angular_acceleration.value_or(core::Robot::kNoLimit);
  for (const Goal& goal : robot.goals) {
    core::Goal& each = made.via.emplace_back();
    set_pose(each, goal, frame);
    each.service = goal.service > 0.0 ? std::max(goal.service, core::kShortestWait) : 0.0;
    each.not_before = goal.not_before;
    each.radius_after = goal.radius_after;
    each.linear_speed_after = goal.linear_speed_after;
    each.linear_acceleration_after = goal.linear_acceleration_after;
    each.linear_deceleration_after = goal.linear_deceleration_after;
    each.due = goal.due;
  }
  if (made.via.empty()) return made;
  made.goal = made.via.back();
  made.via.pop_back();
  return made;
}

namespace {

core::OpenGoal goal_with_tolerance(const Goal& goal, std::size_t number, const Frame& frame) {
  core::OpenGoal made;
  made.tolerance = goal.tolerance;
  made.own = frame.to_core(goal.x, goal.y);
  made.poses = {{made.own, normalized(goal.theta)}};
  made.is_told = goal.place && core::take_place(made, frame.to_core(goal.place->x, goal.place->y));
  made.goal = number;
  return made;
}

}  // namespace

std::vector<core::OpenGoal> open_goals_of(const Robot& robot, const Frame& frame) {
  std::vector<core::OpenGoal> open;
  for (std::size_t k = 0; k < robot.goals.size(); ++k) {
    const Goal& goal = robot.goals[k];
    if (goal.tolerance > 0.0 && goal.any_of.empty()) open.push_back(goal_with_tolerance(goal, k, frame));
    if (goal.any_of.empty()) continue;
    core::OpenGoal& made = open.emplace_back();
    made.goal = k;
    made.is_told = goal.choice && *goal.choice < goal.any_of.size();
    if (made.is_told) made.chosen = *goal.choice;
    for (const Alternative& pose : goal.any_of) {
      made.poses.push_back(
          {frame.to_core(pose.x, pose.y), normalized(pose.theta), pose.bias, made.poses.size()});
    }
  }
  return open;
}

core::MovingObstacle obstacle_of(const MovingObstacle& obstacle, const Frame& frame) {
  using After = core::MovingObstacle::After;
  core::MovingObstacle made{obstacle.id, obstacle.radius, {}, obstacle.stays ? After::stays : After::leaves};
  for (const MovingObstacle::Entry& entry : obstacle.motion) {
    made.motion.push_back({entry.t, frame.to_core(entry.position.x, entry.position.y)});
  }
  return made;
}

core::Zone zone_of(const Zone& zone, const Frame& frame) {
  core::Zone made;
  made.id = zone.id;
  made.type = static_cast<core::Zone::Type>(zone.type);
  for (const Position& corner : zone.polygon) made.polygon.push_back(frame.to_core(corner.x, corner.y));
  made.linear_speed = zone.linear_speed.value_or(core::Zone::kNoLimit);
  made.angular_speed = zone.angular_speed.value_or(core::Zone::kNoLimit);
  made.heading = core::normalize_angle(zone.heading);
  made.half_angle = zone.half_angle;
  made.robots = zone.robots;
  std::sort(made.robots.begin(), made.robots.end());
  made.robots.erase(std::unique(made.robots.begin(), made.robots.end()), made.robots.end());
  return made;
}

core::PlanOptions options_of(const Options& options, bool in_motion) {
  core::PlanOptions made;
  made.mode = static_cast<core::PlanOptions::Mode>(options.mode);
  made.objective = static_cast<core::PlanOptions::Objective>(options.objective);
  made.seed = options.seed;
  made.priority = static_cast<core::PlanOptions::Priority>(options.priority);
  made.reordering = static_cast<core::PlanOptions::Reordering>(options.reordering);
  // The service has the same default, see api/request/parse_body.cpp.
  const double in_motion_interval = options.horizon ? 1.0 : 0.0;
  made.start_safe_interval =
      options.start_safe_interval.value_or(in_motion ? in_motion_interval : made.start_safe_interval);
  made.inflation = options.inflation;
  made.wait_before_move = options.wait_before_move;
  made.any_angle = options.any_angle;
  made.smoothing = options.smoothing;
  made.connectivity = options.connectivity;
  made.replan = static_cast<core::PlanOptions::Replan>(options.replan);
  made.interval_margin = options.interval_margin;
  made.start_overlap = options.start_overlap;
  made.goal_overlap = options.goal_overlap;
  made.lattice_spacing = options.lattice_spacing;
  made.horizon = options.horizon;
  made.max_iterations = options.max_iterations;
  return made;
}

core::RobotPlan plan_of(const RobotPlan& plan, const Frame& frame) {
  core::RobotPlan made;
  made.robot = plan.robot;
  made.cost = plan.cost;
  for (const Action& action : plan.actions) made.actions.push_back(frame.to_core(action));
  for (const Visit& visit : plan.visits) {
    made.visits.push_back({visit.goal, visit.t_arrive, visit.t_leave.value_or(core::kForever)});
  }
  made.estimated_cost = plan.estimated_cost;
  return made;
}

std::vector<core::UnavoidableCollision> unavoidable_of(const std::vector<UnavoidableCollision>& collisions) {
  std::vector<core::UnavoidableCollision> made;
  for (const UnavoidableCollision& collision : collisions) {
    made.push_back({collision.robot, collision.other, collision.obstacle, collision.t});
  }
  return made;
}

namespace {

/// Tells where an open goal is served.
void tell_choice(const std::vector<core::OpenGoal>& open, const Frame& frame, Visit& visit) {
  const core::OpenGoal* found = core::find_open(open, visit.goal);
  if (found == nullptr) return;
  if (found->tolerance == 0.0) {
    visit.choice = found->choice().number;
    return;
  }
  const Pose world = frame.from_core(core::Pose{found->choice().position, 0.0});
  visit.place = Position{world.x, world.y};
}

/// The places where idle robots end do not count as the user's goals.
RobotPlan plan_of(const core::RobotPlan& plan, std::size_t goals, const std::vector<core::OpenGoal>& open,
                  const Frame& frame) {
  RobotPlan made;
  made.robot = plan.robot;
  made.cost = plan.cost;
  made.lower_bound = plan.lower_bound;
  made.estimated_cost = plan.estimated_cost;
  for (const core::Visit& visit : plan.estimated_visits) {
    if (visit.goal >= goals) continue;
    made.estimated_visits.push_back({visit.goal, visit.t_arrive});
  }
  made.stuck = plan.is_stuck;
  made.blocked_by = {plan.blocked_by.begin(), plan.blocked_by.end()};
  made.actions.reserve(plan.actions.size());
  for (const core::Action& action : plan.actions) made.actions.push_back(frame.from_core(action));
  for (const core::Visit& visit : plan.visits) {
    if (visit.goal >= goals) continue;
    const bool leaves = visit.t_leave < core::kForever;
    Visit& told = made.visits.emplace_back();
    told.goal = visit.goal;
    told.t_arrive = visit.t_arrive;
    if (leaves) told.t_leave = visit.t_leave;
    tell_choice(open, frame, told);
  }
  return made;
}

}  // namespace

Plan plan_of(const core::Plan& plan, const Problem& problem, const core::OpenGoals& open) {
  static const std::vector<core::OpenGoal> none;
  const Frame frame(problem.map);
  Plan made;
  for (const core::RobotPlan& robot : plan.plans) {
    made.plans.push_back(plan_of(robot, problem.robots[robot.robot].goals.size(),
                                 open.empty() ? none : open[robot.robot], frame));
  }
  for (const core::Unplanned& robot : plan.unplanned) {
    made.unplanned.push_back({robot.robot,
                              static_cast<Unplanned::Reason>(robot.reason),
                              robot.detail,
                              {robot.blocked_by.begin(), robot.blocked_by.end()}});
  }
  for (const core::UnavoidableCollision& collision : plan.unavoidable) {
    made.unavoidable.push_back({collision.robot, collision.other, collision.obstacle, collision.t});
  }
  using Status = Plan::Status;
  made.status = made.unplanned.empty() ? Status::solved : made.plans.empty() ? Status::none : Status::partial;
  made.objectives = {plan.objectives.flowtime, plan.objectives.makespan};
  made.lower_bound = {plan.lower_bound.flowtime, plan.lower_bound.makespan};
  made.deterministic = plan.deterministic;
  made.search.attempts = plan.search.attempts;
  made.search.expansions = plan.search.expansions;
  made.search.improvements = plan.search.improvements;
  made.search.exhausted = plan.search.exhausted;
  const auto counts_of = [&](core::Method method) {
    const core::MethodCounts& counts = plan.search.moves[static_cast<std::size_t>(method)];
    return MethodCounts{counts.tried, counts.served, counts.could_not_serve};
  };
  made.search.priorities = counts_of(core::Method::priorities);
  made.search.steps = counts_of(core::Method::steps);
  made.search.room = counts_of(core::Method::room);
  made.search.smoothing = counts_of(core::Method::smoothing);
  made.search.improvement = counts_of(core::Method::improvement);
  return made;
}

Verification verification_of(core::VerifyReport report) {
  Verification made;
  made.finished = true;
  made.violation_count = report.violation_count;
  made.min_clearance = report.min_clearance;
  for (core::Violation& found : report.violations) {
    made.violations.push_back({.kind = static_cast<Violation::Kind>(found.kind),
                               .robots = std::move(found.robots),
                               .t = found.t,
                               .distance = found.distance,
                               .required = found.required,
                               .detail = std::move(found.detail),
                               .obstacle = found.obstacle,
                               .zone = found.zone});
  }
  return made;
}

Progress progress_of(const core::Progress& progress) {
  Progress made{progress.attempts, progress.planned, std::nullopt};
  if (progress.best) made.best = Objectives{progress.best->flowtime, progress.best->makespan};
  return made;
}

}  // namespace fleetplan::library

namespace fleetplan {

Pose pose_at(std::span<const Action> actions, const Pose& start, double t) {
  if (actions.empty() || t <= actions.front().t_start) return start;
  const auto next = std::upper_bound(actions.begin(), actions.end(), t,
                                     [](double time, const Action& action) { return time < action.t_start; });
  const Action& action = *(next - 1);
  if (t >= action.t_end) return action.to;
  const double fraction = core::share_at(library::Frame().to_core(action), t);
  const double turn = core::rotation_between(action.from.theta, action.to.theta);
  return {action.from.x + fraction * (action.to.x - action.from.x),
          action.from.y + fraction * (action.to.y - action.from.y),
          core::normalize_angle(action.from.theta + fraction * turn)};
}

Plan library::plan_of(const core::MadePlan& made, const Problem& problem,
                      const std::vector<std::vector<Fault>>& invalid) {
  const auto& open = made.task.open;
  Plan plan = plan_of(made.plan, problem, open ? open->goals : core::OpenGoals());
  plan.objective_value =
      core::objective_value(made.plan, made.task.problem.robots(), made.task.options.objective);
  plan.search.seconds = std::chrono::duration<double>(made.times.planned - made.times.begun).count();
  for (Unplanned& robot : plan.unplanned) {
    if (robot.reason == Unplanned::Reason::invalid) robot.faults = invalid[robot.robot];
  }
  if (!made.report) return plan;
  if (!made.report->valid()) throw_rejected(*made.report);
  plan.verified = true;
  plan.min_clearance = made.report->min_clearance;
  return plan;
}

void library::throw_rejected(const core::VerifyReport& report) {
  throw std::logic_error("fleetplan made a plan that its checker rejects: " +
                         report.violations.front().detail);
}

core::StopCondition::Clock::time_point library::end_of(std::chrono::nanoseconds budget,
                                                       core::StopCondition::Clock::time_point begin) {
  using Time = core::StopCondition::Clock::time_point;
  const auto left = Time::max() - begin;
  return budget >= left ? Time::max() : begin + budget;
}

}  // namespace fleetplan
