// Random fleets in random moments of random plans: commitments cut anywhere, late robots, new goals,
// services, moving obstacles and margins. The independent checker accepts every plan, and previous plans that
// hold stay.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry/tolerance.h"
#include "core/map/obstacle_distance.h"
#include "core/planner.h"
#include "core/verify/verify.h"
#include "tests/support/expect_safe.h"
#include "tests/support/moments.h"
#include "tests/support/random_problem.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace {

using support::Dice;

StopCondition budget_of(int ms) {
  return StopCondition(StopCondition::Clock::now() + std::chrono::milliseconds(ms));
}

Position random_place(Dice& dice, const OccupancyGrid& grid) {
  return {dice.between(0.0, grid.width()), dice.between(0.0, grid.height())};
}

/// Some goals on the way, where the robot has room, some of them served for some time.
void add_goals(Dice& dice, const OccupancyGrid& grid, Robot& robot) {
  for (int attempt = dice.below(4); attempt > 0; --attempt) {
    Goal goal{random_place(dice, grid), {}};
    if (dice.chance(0.3)) goal.position = grid.center(grid.cell_at(goal.position));
    if (dice.chance(0.1)) goal.position = robot.start.position;
    if (obstacle_distance(grid, goal.position, robot.radius) < robot.radius) continue;
    if (dice.chance(0.5)) goal.theta = dice.between(-std::numbers::pi, std::numbers::pi);
    robot.via.push_back(goal);
    if (dice.chance(0.1)) robot.via.push_back(goal);
  }
  const auto add_service = [&](Goal& goal) {
    if (dice.chance(0.5)) goal.service = dice.between(0.0, 5.0);
    if (dice.chance(0.2)) goal.not_before = dice.between(0.0, 30.0);
  };
  for (Goal& goal : robot.via) add_service(goal);
  if (dice.chance(0.5)) add_service(*robot.goal);
}

/// Disks of the size of a robot that walk from place to place for half a minute.
std::vector<MovingObstacle> random_obstacles(Dice& dice, const OccupancyGrid& grid) {
  std::vector<MovingObstacle> obstacles;
  for (int k = dice.below(4); k > 0; --k) {
    MovingObstacle obstacle{
        "person " + std::to_string(k), grid.resolution() * dice.between(0.1, 0.8), {}, {}};
    Position here = random_place(dice, grid);
    for (double t = dice.between(0.0, 10.0); t < 40.0;) {
      obstacle.motion.push_back({t, here});
      const Position next = random_place(dice, grid);
      t += std::max(1.0, (next - here).norm() / (grid.resolution() * dice.between(0.3, 3.0)));
      here = next;
      if (dice.chance(0.2)) break;
    }
    obstacle.after = dice.chance(0.2) ? MovingObstacle::After::stays : MovingObstacle::After::leaves;
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

/// What a request has, before it is known to be valid.
struct Request {
  OccupancyGrid grid;
  std::vector<Robot> robots;
  std::vector<MovingObstacle> obstacles;
  PlanOptions options;
};

std::optional<Problem> problem_of(const Request& request) {
  ProblemConditions conditions;
  conditions.obstacles = request.obstacles;
  conditions.pair_overlap = std::max(0.0, request.options.start_overlap - 2.0 * request.options.inflation);
  conditions.wall_overlap = std::max(0.0, request.options.start_overlap - request.options.inflation);
  auto created = Problem::create(request.grid, request.robots, std::move(conditions), StopCondition());
  auto* valid = std::get_if<Problem>(&created);
  return valid != nullptr ? std::optional<Problem>(std::move(*valid)) : std::nullopt;
}

/// The first robot starts so near to the second one that their bare disks overlap, or in a wall.
void overlap_starts(Dice& dice, Request& request) {
  if (request.robots.size() < 2) return;
  Robot& robot = request.robots[0];
  const Robot& other = request.robots[1];
  const double depth = 0.3 * std::min(robot.radius, other.radius) * dice.between(0.0, 1.0);
  const double direction = dice.between(-std::numbers::pi, std::numbers::pi);
  const Position start = other.start.position + (robot.radius + other.radius - depth) *
                                                    Position(std::cos(direction), std::sin(direction));
  if (obstacle_distance(request.grid, start, robot.radius) < robot.radius - depth) return;
  for (std::size_t i = 2; i < request.robots.size(); ++i) {
    const Robot& third = request.robots[i];
    if ((third.start.position - start).norm() < third.radius + robot.radius) return;
  }
  robot.start.position = start;
  request.options.start_overlap = depth + 2.0 * request.options.inflation;
}

Request random_request(Dice& dice) {
  const Problem problem = support::random_problem(dice, 2 + dice.below(8));
  Request request{problem.grid(), problem.robots(), {}, support::random_options(dice, problem)};
  if (dice.chance(0.4)) request.options.interval_margin = dice.between(0.0, 2.0);
  if (dice.chance(0.2)) overlap_starts(dice, request);
  if (dice.chance(0.5)) request.options.replan = PlanOptions::Replan::where_needed;
  if (dice.chance(0.5)) request.obstacles = random_obstacles(dice, request.grid);
  for (Robot& robot : request.robots) {
    if (robot.goal && dice.chance(0.5)) add_goals(dice, request.grid, robot);
  }
  return request;
}

double objective(const PlanOptions& options, const std::vector<double>& costs) {
  double sum = 0.0;
  double most = 0.0;
  for (const double cost : costs) {
    sum += cost;
    most = std::max(most, cost);
  }
  return options.objective == PlanOptions::Objective::flowtime ? sum : most;
}

/// The previous plans of all robots with goals, if there are so many.
std::optional<std::vector<RobotPlan>> previous_plans(const Problem& problem) {
  std::vector<RobotPlan> plans;
  for (std::size_t i = 0; i < problem.robots().size(); ++i) {
    const Robot& robot = problem.robots()[i];
    if (!robot.goal) continue;
    if (!robot.previous) return std::nullopt;
    plans.push_back({i, robot.previous->empty() ? 0.0 : robot.previous->back().t_end, *robot.previous});
  }
  return plans;
}

bool hold(const Problem& problem, const PlanOptions& options, const std::vector<RobotPlan>& plans) {
  CheckRules rules;
  rules.inflation = options.inflation;
  rules.interval_margin = options.interval_margin;
  rules.wait_before_move = options.wait_before_move;
  rules.start_overlap = options.start_overlap;
  return support::safety_report(problem, plans, rules).valid();
}

std::string unplanned_text(const Plan& plan) {
  std::string text;
  for (const Unplanned& robot : plan.unplanned)
    text += std::to_string(robot.robot) + ": " + robot.detail + "\n";
  return text;
}

bool same(const Action& a, const Action& b) {
  return a.type == b.type && a.t_start == b.t_start && a.t_end == b.t_end &&
         a.from.position == b.from.position && a.from.theta == b.from.theta &&
         a.to.position == b.to.position && a.to.theta == b.to.theta;
}

void expect_each_robot_once(const Problem& problem, const Plan& plan) {
  std::set<std::size_t> seen;
  for (const RobotPlan& robot : plan.plans) EXPECT_TRUE(seen.insert(robot.robot).second);
  for (const Unplanned& robot : plan.unplanned) EXPECT_TRUE(seen.insert(robot.robot).second);
  EXPECT_EQ(seen.size(), problem.robots().size());
}

/// If all previous plans hold, the answer has all robots and is no worse; `first` returns them as they are.
/// Returns whether they do.
bool expect_no_worse_than_previous(const Problem& problem, const PlanOptions& options, const Plan& plan) {
  const auto previous = previous_plans(problem);
  if (!previous || !hold(problem, options, *previous)) return false;
  EXPECT_TRUE(plan.unplanned.empty()) << unplanned_text(plan);
  std::vector<double> before;
  std::vector<double> after;
  for (const RobotPlan& robot : *previous) before.push_back(robot.cost);
  for (const RobotPlan& robot : plan.plans) {
    if (problem.robots()[robot.robot].goal) after.push_back(robot.cost);
  }
  EXPECT_LE(objective(options, after), objective(options, before) + 1e-9);
  if (options.mode == PlanOptions::Mode::anytime) return true;
  for (const RobotPlan& robot : plan.plans) {
    const auto& given = problem.robots()[robot.robot].previous;
    if (!given || !problem.robots()[robot.robot].goal) continue;
    EXPECT_TRUE(std::equal(given->begin(), given->end(), robot.actions.begin(), robot.actions.end(), same))
        << "robot " << robot.robot << " does not keep its plan";
  }
  return true;
}

/// Every listed meeting is a collision that the checker finds, and each pair is listed once.
void expect_real_meetings(const Problem& problem, const Plan& plan) {
  if (plan.unavoidable.empty()) return;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::set<std::pair<std::size_t, std::size_t>> with_obstacles;
  CheckRules rules;
  rules.tolerances.assign(problem.robots().size(), Tolerance::of_all(kContactTolerance));
  const auto report =
      verify({problem.grid(), problem.robots(), problem.obstacles()}, plan.plans, rules, StopCondition());
  for (const Violation& violation : report->violations) {
    if (violation.kind == Violation::Kind::robot_collision)
      pairs.insert({violation.robots[0], violation.robots[1]});
    if (violation.obstacle) with_obstacles.insert({violation.robots[0], *violation.obstacle});
  }
  for (const Meeting& meeting : plan.unavoidable) {
    if (meeting.obstacle) {
      EXPECT_TRUE(with_obstacles.contains({meeting.robot, *meeting.obstacle}))
          << "robot " << meeting.robot << " and obstacle " << *meeting.obstacle << " at " << meeting.t;
    } else {
      const auto pair = std::minmax(meeting.robot, meeting.other.value());
      EXPECT_TRUE(pairs.contains(pair))
          << "robots " << pair.first << " and " << pair.second << " at " << meeting.t;
    }
  }
}

Plan planned(const Problem& problem, const PlanOptions& options, int budget_ms) {
  Plan plan = core::plan(problem, options, budget_of(budget_ms));
  support::expect_safe(problem, plan, options);
  expect_each_robot_once(problem, plan);
  expect_real_meetings(problem, plan);
  return plan;
}

/// The request at a later moment of its plan.
Request moment_of(Dice& dice, const Request& request, const Plan& plan, double t) {
  Request next = request;
  next.options.start_safe_interval = dice.chance(0.7) ? 0.0 : 3.0;
  for (const RobotPlan& robot : plan.plans) {
    const double commit = dice.chance(0.2) ? 0.0 : dice.between(0.0, 5.0);
    next.robots[robot.robot] = support::robot_at_moment(request.robots[robot.robot], robot, t, commit);
  }
  for (const Unplanned& robot : plan.unplanned) {
    next.robots[robot.robot] = support::robot_at_moment(request.robots[robot.robot], t);
  }
  next.obstacles.clear();
  for (const MovingObstacle& obstacle : request.obstacles) {
    if (auto left = support::obstacle_at_moment(obstacle, t)) next.obstacles.push_back(std::move(*left));
  }
  return next;
}

/// A robot stops where it is for some time.
void hold_back(Dice& dice, Robot& robot) {
  const double seconds = dice.between(0.5, 20.0);
  const Action wait{Action::Type::wait, 0.0, seconds, robot.start, robot.start};
  if (robot.previous) {
    robot.previous = support::later(*robot.previous, seconds);
    robot.previous->insert(robot.previous->begin(), wait);
  }
  robot.committed = {wait};
}

class FleetInMotion : public testing::TestWithParam<int> {};

TEST_P(FleetInMotion, GoesOnFromAnyMoment) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  Request request = random_request(dice);
  std::optional<Problem> problem = problem_of(request);
  ASSERT_TRUE(problem);
  Plan plan = planned(*problem, request.options, 1000);
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const double t = dice.between(0.0, std::max(1.0, 0.8 * plan.objectives.makespan));
    Request next = moment_of(dice, request, plan, t);
    const int disturbed = dice.below(static_cast<int>(next.robots.size()));
    Robot& robot = next.robots[static_cast<std::size_t>(disturbed)];
    const int disturbance = dice.below(4);
    if (disturbance == 1) hold_back(dice, robot);
    if (disturbance == 2) robot.previous.reset();
    if (disturbance == 3 && robot.goal) {
      robot.previous.reset();
      robot.via.clear();
      robot.goal->not_before = 0.0;
    }
    problem = problem_of(next);
    // A robot that is held stands in the way of what others are committed to; others are amid a meeting.
    if (!problem && (disturbance == 1 || !plan.unavoidable.empty())) return;
    ASSERT_TRUE(problem) << "at t = " << t << " the fleet is not accepted";
    const int budget = dice.chance(0.3) ? 10 : 500;
    Plan later = planned(*problem, next.options, budget);
    expect_no_worse_than_previous(*problem, next.options, later);
    request = std::move(next);
    plan = std::move(later);
  }
}

TEST_P(FleetInMotion, KeepsPlansThatHoldWhateverTheBudget) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 100'000);
  Request request = random_request(dice);
  const Plan plan = planned(*problem_of(request), request.options, 1000);
  if (!plan.unplanned.empty()) return;
  const double t = dice.between(0.0, plan.objectives.makespan);
  Request next = moment_of(dice, request, plan, t);
  const std::optional<Problem> problem = problem_of(next);
  ASSERT_TRUE(problem) << "at t = " << t;
  const Plan later = planned(*problem, next.options, dice.below(2) * 10);
  const bool holds = expect_no_worse_than_previous(*problem, next.options, later);
  // What was planned without moves under way that keep less than the full distance goes on as planned.
  if (request.options.inflation == 0.0 && request.options.wait_before_move == 0.0) {
    EXPECT_TRUE(holds) << support::text(support::safety_report(*problem, *previous_plans(*problem)));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FleetInMotion, testing::Range(0, 150));

}  // namespace
}  // namespace fleetplan::core
