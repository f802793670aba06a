#include "core/moves/lattice_steps.h"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>

#include "tests/core/support/planning.h"
#include "tests/support/plan_checked.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

bool plans(const Planning& p, const std::vector<std::size_t>& robots) {
  Random random(0);
  return plan_on_lattice(p.reservations, robots, random, p.never).has_value();
}

OccupancyGrid hall() {
  return support::ascii_map({"......",  //
                             "......",  //
                             "......"});
}

TEST(LatticeSteps, PlansRobotsThatFitBesideEachOther) {
  const Planning p(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(5.5, 0.5).to(0.5, 0.5)});
  EXPECT_TRUE(plans(p, {0, 1}));
}

TEST(LatticeSteps, RefusesFleetsThatStepsDoNotDescribe) {
  const auto is_refused = [](const Robot& robot, const PlanOptions& options = {}) {
    return !plans(Planning(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot}, options), {0, 1});
  };
  EXPECT_FALSE(is_refused(robot_at(0.5, 2.5).to(5.5, 2.5)));
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.4).to(5.5, 2.5))) << "start off the lattice";
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.5).to(5.5, 2.4))) << "goal off the lattice";
  EXPECT_TRUE(is_refused(robot_at(1.5, 1.5).radius(0.6).to(4.5, 1.5))) << "too wide";
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.5).drives(1.5, 2.5).to(5.5, 2.5))) << "a commitment";
  Robot through = robot_at(0.5, 2.5).to(5.5, 2.5);
  through.via.push_back({{3.5, 2.5}, std::nullopt});
  EXPECT_TRUE(is_refused(through)) << "two goals";
  PlanOptions options;
  options.interval_margin = 1.0;
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.5).to(5.5, 2.5), options)) << "interval margin";
  options = {};
  options.horizon = 5.0;
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.5).to(5.5, 2.5), options)) << "horizon";
  options = {};
  options.inflation = 0.2;
  EXPECT_TRUE(is_refused(robot_at(0.5, 2.5).to(5.5, 2.5), options)) << "too wide with the inflation";
}

TEST(LatticeSteps, RefusesFleetsBesideCommittedMotion) {
  const Planning p(hall(), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(0.5, 2.5).drives(3.5, 2.5)});
  EXPECT_FALSE(plans(p, {0})) << "of a robot without a goal";
}

TEST(LatticeSteps, RefusesFleetsAmongMovingObstacles) {
  MovingObstacle obstacle;
  obstacle.radius = 0.1;
  obstacle.motion = {{0.0, {5.5, 2.5}}};
  const Planning p(
      support::make_problem(hall(), {robot_at(0.5, 0.5).to(4.5, 0.5)}, {.obstacles = {obstacle}}));
  EXPECT_FALSE(plans(p, {0}));
}

/// A random fleet on the lattice: of different radii, speeds, accelerations and headings.
Planning random_fleet(std::uint64_t seed) {
  support::Dice dice(seed);
  OccupancyGrid grid(4 + dice.below(8), 4 + dice.below(8), 1.0);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (dice.chance(0.1)) grid.block({column, row});
    }
  }
  std::vector<Position> starts;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (!grid.blocked({column, row})) starts.push_back(grid.center({column, row}));
    }
  }
  std::vector<Position> goals = starts;
  Random random(seed);
  random.shuffle(starts);
  random.shuffle(goals);
  const bool are_limited = dice.chance(0.3);
  const double most = dice.between(0.2, 0.5);
  std::vector<Robot> robots;
  const auto count = 1 + random.below(starts.size() * 3 / 5);
  for (std::size_t i = 0; i < count; ++i) {
    Robot robot = robot_at(starts[i].x(), starts[i].y(), dice.between(-std::numbers::pi, std::numbers::pi))
                      .radius(dice.chance(0.5) ? most : dice.between(0.1, most))
                      .speeds(dice.between(0.3, 3.0), dice.between(0.5, 20.0))
                      .to(goals[i].x(), goals[i].y());
    if (dice.chance(0.5)) robot.goal->theta = dice.between(-std::numbers::pi, std::numbers::pi);
    if (dice.chance(0.2)) robot.goal->service = dice.between(0.0, 5.0);
    if (dice.chance(0.2)) robot.goal->not_before = dice.between(0.0, 50.0);
    if (are_limited && dice.chance(0.7)) robot.linear_acceleration = dice.between(0.2, 2.0);
    if (are_limited && dice.chance(0.7)) robot.linear_deceleration = dice.between(0.2, 2.0);
    if (are_limited && dice.chance(0.5)) robot.angular_acceleration = dice.between(0.5, 5.0);
    if (dice.chance(0.05)) robot.goal.reset();
    robots.push_back(robot);
  }
  PlanOptions options;
  if (dice.chance(0.3)) options.wait_before_move = dice.between(0.0, 2.0);
  return Planning(std::move(grid), std::move(robots), options);
}

TEST(LatticeSteps, RandomFleetsNeverMeet) {
  int planned = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Planning p = random_fleet(seed);
    const std::vector<std::size_t> robots = p.movers();
    for (std::size_t i = 0; i < p.instance.size(); ++i) {
      if (!p.instance.problem().robots()[i].goal) p.reservations.stay_in_place(i);
    }
    auto trajectories = plan_on_lattice(p.reservations, robots, p.random, p.never);
    if (!trajectories) continue;  // walls may part them
    ++planned;
    for (std::size_t k = 0; k < robots.size(); ++k) p.reservations.follow(robots[k], (*trajectories)[k]);
    support::expect_safe(p.reservations);
    for (std::size_t k = 0; k < robots.size(); ++k) {
      EXPECT_TRUE(p.reservations.conflicting_robots(robots[k], (*trajectories)[k]).empty());
    }
  }
  EXPECT_GT(planned, 100);
}

/// Two thirds of the cells are taken: priorities come to no end there.
Problem crowd(std::uint64_t seed) {
  OccupancyGrid grid(10, 9, 1.0);
  std::vector<Position> cells;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) cells.push_back(grid.center({column, row}));
  }
  std::vector<Position> goals = cells;
  Random random(seed);
  random.shuffle(cells);
  random.shuffle(goals);
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < 60; ++i) {
    robots.push_back(robot_at(cells[i].x(), cells[i].y()).to(goals[i].x(), goals[i].y()));
  }
  return support::make_problem(std::move(grid), std::move(robots));
}

TEST(LatticeSteps, SolveFleetsThatPrioritiesDoNot) {
  const Plan plan = support::plan_checked(crowd(3));
  EXPECT_EQ(plan.plans.size(), 60u);
  EXPECT_TRUE(plan.unplanned.empty());
}

/// However the time ends, each robot has a plan or a reason for none.
TEST(LatticeSteps, AreKeptWhenTheFirstPartOfTheTimeEnds) {
  for (const auto reordering : {PlanOptions::Reordering::raise_failed, PlanOptions::Reordering::random,
                                PlanOptions::Reordering::none}) {
    for (const int milliseconds : {20, 100, 400}) {
      const Problem problem = crowd(4);
      PlanOptions options;
      options.reordering = reordering;
      const StopCondition stop(StopCondition::Clock::now() + std::chrono::milliseconds(milliseconds));
      const Plan plan = core::plan(problem, options, stop);
      support::expect_safe(problem, plan);
      EXPECT_EQ(plan.plans.size() + plan.unplanned.size(), 60u);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
