#include <fleetplan/fleetplan.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "core/model/plan_options.h"
#include "library/convert.h"
#include "tests/library/fleet.h"

namespace fleetplan {
namespace TEST_FILE {

using Status = Plan::Status;

TEST(PublicPlan, SwapsTwoRobotsWithoutACollision) {
  const Problem problem = corridor_swap();
  const Plan plan = fleetplan::plan(problem);
  EXPECT_EQ(plan.status, Status::solved);
  EXPECT_TRUE(plan.verified);
  EXPECT_TRUE(plan.deterministic);
  ASSERT_TRUE(plan.min_clearance);
  EXPECT_GE(*plan.min_clearance, -1e-6);
  ASSERT_NE(plan.plan_of(1), nullptr);
  EXPECT_EQ(plan.plan_of(1)->robot, 1U);
  EXPECT_EQ(plan.plan_of(2), nullptr);
  EXPECT_NEAR(plan.objectives.flowtime, plan.plans[0].cost + plan.plans[1].cost, 1e-9);
  EXPECT_LE(plan.lower_bound.flowtime, plan.objectives.flowtime);
  EXPECT_TRUE(verify(problem, plan).valid());
}

TEST(PublicPlan, IsTheSameAtAnyOrigin) {
  const Plan here = plan(corridor_swap());
  const Plan there = plan(corridor_swap({1000.0, -500.0}));
  ASSERT_EQ(here.plans.size(), there.plans.size());
  EXPECT_DOUBLE_EQ(here.objectives.flowtime, there.objectives.flowtime);
  const Pose end = there.plans[0].actions.back().to;
  EXPECT_NEAR(end.x, 1008.5, 1e-9);
  EXPECT_NEAR(end.y, -499.5, 1e-9);
}

/// A robot without goals stands in the corridor beside the passing bay, and another robot has to pass.
Problem one_in_the_way(Robot::Idle idle) {
  Problem problem = corridor_swap();
  problem.robots[1].start = {5.5, 0.5, 0.0};
  problem.robots[1].goals.clear();
  problem.robots[1].idle = idle;
  return problem;
}

TEST(PublicPlan, LeavesRobotsWithoutGoalsInTheWayUnlessTheyMakeWay) {
  const Plan plan = fleetplan::plan(one_in_the_way(Robot::Idle::stay));
  ASSERT_EQ(plan.unplanned.size(), 1U);
  EXPECT_EQ(plan.unplanned[0].robot, 0U);
  EXPECT_EQ(plan.unplanned[0].blocked_by, std::vector<std::size_t>{1});
}

TEST(PublicPlan, LetsIdleRobotsMakeWayAndEndAnywhereOrComeBack) {
  for (const Robot::Idle idle : {Robot::Idle::yield, Robot::Idle::come_back}) {
    const Problem problem = one_in_the_way(idle);
    const Plan plan = fleetplan::plan(problem);
    ASSERT_EQ(plan.status, Status::solved);
    EXPECT_TRUE(plan.verified);
    EXPECT_TRUE(verify(problem, plan).valid());
    ASSERT_FALSE(plan.plans[1].actions.empty());
    const Pose end = plan.plans[1].actions.back().to;
    EXPECT_EQ(std::hypot(end.x - 5.5, end.y - 0.5) < 1e-9, idle == Robot::Idle::come_back);
    EXPECT_EQ(plan.plans[0].visits.size(), 1U);
    EXPECT_TRUE(plan.plans[1].visits.empty());
  }
}

TEST(PublicPlan, MovesIdleRobotsThatHaveServedTheirGoals) {
  Problem problem = corridor_swap();
  problem.robots[1].start = {6.5, 0.5, 0.0};
  problem.robots[1].goals = {{5.5, 0.5, {}, 2.0}};
  problem.robots[1].idle = Robot::Idle::yield;
  const Plan plan = fleetplan::plan(problem);
  ASSERT_EQ(plan.status, Status::solved);
  EXPECT_TRUE(verify(problem, plan).valid());
  ASSERT_EQ(plan.plans[1].visits.size(), 1U);
  EXPECT_LT(plan.plans[1].visits[0].t_arrive, 3.0);
  EXPECT_GT(std::abs(plan.plans[1].actions.back().to.x - 5.5), 0.1);
}

/// Robots of the corridor need 1 s and half a metre to start, and 2 s and a metre to stop.
Problem heavy_corridor() {
  Problem problem = corridor_swap();
  for (Robot& robot : problem.robots) {
    robot.linear_acceleration = 1.0;
    robot.linear_deceleration = 0.5;
    robot.angular_acceleration = 4.0;
  }
  return problem;
}

TEST(PublicPlan, HasProfilesIfAccelerationIsLimited) {
  Problem problem = heavy_corridor();
  problem.robots.pop_back();
  const Plan alone = plan(problem);
  const std::vector<Action>& actions = alone.plans[0].actions;
  ASSERT_EQ(actions.size(), 1U);
  ASSERT_TRUE(actions[0].profile.has_value());
  EXPECT_EQ(actions[0].profile->cruise, 1.0);
  EXPECT_EQ(actions[0].profile->acceleration, 1.0);
  EXPECT_EQ(actions[0].profile->deceleration, 0.5);
  EXPECT_NEAR(alone.plans[0].cost, 8.0 + 0.5 + 1.0, 1e-9);
  const Pose& start = problem.robots[0].start;
  EXPECT_NEAR(pose_at(actions, start, 0.5).x, 0.5 + 0.125, 1e-9);
  EXPECT_NEAR(pose_at(actions, start, 1.0).x, 0.5 + 0.5, 1e-9);
  EXPECT_NEAR(pose_at(actions, start, 5.0).x, 0.5 + 4.5, 1e-9);
  EXPECT_NEAR(pose_at(actions, start, 8.5).x, 8.5 - 0.25, 1e-9);
  EXPECT_EQ(pose_at(actions, start, 9.5).x, 8.5);
}

TEST(PublicPlan, WithProfilesIsVerifiedAndCanBeCommitted) {
  Problem problem = heavy_corridor();
  const Plan first = plan(problem);
  EXPECT_EQ(first.status, Status::solved);
  EXPECT_TRUE(first.verified);
  EXPECT_TRUE(verify(problem, first).valid());
  Plan without = first;
  for (RobotPlan& robot : without.plans) {
    for (Action& action : robot.actions) action.profile.reset();
  }
  const Verification found = verify(problem, without.plans);
  ASSERT_FALSE(found.violations.empty());
  EXPECT_EQ(found.violations[0].kind, Violation::Kind::profile);
  for (std::size_t robot = 0; robot < 2; ++robot) {
    problem.robots[robot].committed = first.plans[robot].actions;
    for (Action& action : problem.robots[robot].committed) {
      if (action.profile) action.profile->acceleration = action.profile->deceleration = 7.0;  // not read
    }
  }
  const Plan second = plan(problem);
  EXPECT_EQ(second.status, Status::solved);
  EXPECT_TRUE(second.verified);
  EXPECT_DOUBLE_EQ(second.objectives.flowtime, first.objectives.flowtime);
  const std::vector<Action>& again = second.plans[0].actions;
  ASSERT_EQ(again.size(), first.plans[0].actions.size());
  for (std::size_t k = 0; k < again.size(); ++k) {
    EXPECT_EQ(again[k].profile.has_value(), again[k].type != Action::Type::wait) << k;
    if (again[k].type == Action::Type::translate) {
      EXPECT_EQ(again[k].profile->deceleration, 0.5);
    }
  }
}

TEST(PublicPlan, GoesOnFromWhatIsCommittedAndKeepsThePreviousPlan) {
  Problem problem = corridor_swap();
  const Plan first = plan(problem);
  for (std::size_t robot = 0; robot < 2; ++robot) {
    const std::vector<Action>& actions = first.plans[robot].actions;
    problem.robots[robot].previous = actions;
    problem.robots[robot].committed = {actions.front()};
  }
  Options keep;
  keep.replan = Options::Replan::where_needed;
  const Plan second = plan(problem, keep);
  EXPECT_EQ(second.status, Status::solved);
  EXPECT_TRUE(second.verified);
  EXPECT_DOUBLE_EQ(second.objectives.flowtime, first.objectives.flowtime);
  EXPECT_TRUE(verify(problem, second.plans).valid());
}

TEST(PublicPlan, AvoidsMovingObstaclesAndZones) {
  Problem problem{Map(12, 6, 1.0), {robot_from({1.0, 3.0, 0.0}, {{11.0, 3.0}})}};
  const double straight = plan(problem).objectives.flowtime;
  problem.zones.push_back(
      {"", Zone::Type::blocked, {{5.0, 1.0}, {7.0, 1.0}, {7.0, 4.0}, {5.0, 4.0}}, {}, {}, 0.0, 0.0, {}});
  const double around = plan(problem).objectives.flowtime;
  EXPECT_GT(around, straight + 0.1);
  problem.zones.clear();
  problem.obstacles.push_back({"", 1.0, {{0.0, {6.0, 3.0}}, {20.0, {6.0, 3.0}}}, true});
  const Plan passes = plan(problem);
  EXPECT_EQ(passes.status, Status::solved);
  EXPECT_GT(passes.objectives.flowtime, straight + 0.1);
  EXPECT_TRUE(passes.verified);
}

TEST(PublicPlan, VisitsGoalsInTheirOrder) {
  Problem problem{Map(10, 10, 1.0),
                  {robot_from({1.0, 1.0, 0.0}, {{8.0, 1.0}, {8.0, 8.0, 0.0, 2.0}, {1.0, 8.0}})}};
  const Plan plan = fleetplan::plan(problem);
  ASSERT_EQ(plan.plans.size(), 1U);
  const std::vector<Visit>& visits = plan.plans[0].visits;
  ASSERT_EQ(visits.size(), 3U);
  ASSERT_TRUE(visits[1].t_leave);
  EXPECT_GE(*visits[1].t_leave, visits[1].t_arrive + 2.0);
  EXPECT_FALSE(visits[2].t_leave) << "it stays at the last goal";
  const Pose served = pose_at(plan.plans[0].actions, problem.robots[0].start, visits[1].t_arrive + 1.0);
  EXPECT_NEAR(served.x, 8.0, 1e-9);
  EXPECT_NEAR(served.theta, 0.0, 1e-9);
}

TEST(PublicPlan, NamesTheReasonOfARobotWithoutAPlan) {
  const Problem problem{Map::from_rows({"..#.."}, 1.0), {robot_from({0.5, 0.5, 0.0}, {{4.5, 0.5}})}};
  const Plan plan = fleetplan::plan(problem);
  EXPECT_EQ(plan.status, Status::none);
  ASSERT_EQ(plan.unplanned.size(), 1U);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_unreachable);
  EXPECT_FALSE(plan.unplanned[0].detail.empty());
  EXPECT_TRUE(plan.verified) << "nobody moves";
}

TEST(PublicPlan, EndsWhenAStopIsRequested) {
  std::stop_source stop;
  stop.request_stop();
  Control control;
  control.stop = stop.get_token();
  const Plan plan = fleetplan::plan(corridor_swap(), {}, control);
  EXPECT_EQ(plan.status, Status::none);
  EXPECT_FALSE(plan.deterministic);
  ASSERT_EQ(plan.unplanned.size(), 2U);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::budget_exhausted);
}

TEST(PublicPlan, ReportsProgressAndPassesExceptionsOn) {
  Progress last;
  Control control;
  control.progress = [&](const Progress& progress) { last = progress; };
  plan(corridor_swap(), {}, control);
  EXPECT_EQ(last.planned, 2U);
  EXPECT_GE(last.attempts, 1);
  control.progress = [](const Progress&) { throw std::runtime_error("enough"); };
  EXPECT_THROW(plan(corridor_swap(), {}, control), std::runtime_error);
}

TEST(PublicPlan, ImprovesByAsManyStepsAsAreAskedFor) {
  Options options;
  options.mode = Options::Mode::anytime;
  options.max_iterations = 20;
  options.time_budget = std::chrono::seconds(60);
  const Plan first = plan(corridor_swap());
  const Plan improved = plan(corridor_swap(), options);
  EXPECT_TRUE(improved.deterministic);
  EXPECT_LE(improved.objectives.flowtime, first.objectives.flowtime);
}

TEST(PublicPlan, AcceptsAnyTimeBudget) {
  Options options;
  options.time_budget = std::chrono::nanoseconds::max();
  EXPECT_EQ(plan(corridor_swap(), options).status, Status::solved);
  options.time_budget = std::chrono::nanoseconds(1);
  EXPECT_EQ(plan(corridor_swap(), options).status, Status::none);
}

TEST(PublicOptions, HaveTheDefaultsOfTheService) {
  const core::PlanOptions service;
  const core::PlanOptions own = library::options_of(Options(), false);
  EXPECT_EQ(own.mode, service.mode);
  EXPECT_EQ(own.objective, service.objective);
  EXPECT_EQ(own.seed, service.seed);
  EXPECT_EQ(own.priority, service.priority);
  EXPECT_EQ(own.reordering, service.reordering);
  EXPECT_EQ(own.start_safe_interval, service.start_safe_interval);
  EXPECT_EQ(own.inflation, service.inflation);
  EXPECT_EQ(own.wait_before_move, service.wait_before_move);
  EXPECT_EQ(own.any_angle, service.any_angle);
  EXPECT_EQ(own.smoothing, service.smoothing);
  EXPECT_EQ(own.connectivity, service.connectivity);
  EXPECT_EQ(own.replan, service.replan);
  EXPECT_EQ(own.interval_margin, service.interval_margin);
  EXPECT_EQ(own.start_overlap, service.start_overlap);
  EXPECT_EQ(own.goal_overlap, service.goal_overlap);
  EXPECT_EQ(own.lattice_spacing, service.lattice_spacing);
  EXPECT_EQ(own.horizon, service.horizon);
  EXPECT_EQ(own.max_iterations, service.max_iterations);
  EXPECT_EQ(Options().invalid_robots, Options::InvalidRobots::refuse);
  EXPECT_EQ(library::options_of(Options(), true).start_safe_interval, 0.0);
}

TEST(PoseAt, InterpolatesActions) {
  using Type = Action::Type;
  const Pose start{0.0, 0.0, 0.0};
  const std::vector<Action> actions{{Type::translate, 0.0, 2.0, start, {2.0, 0.0, 0.0}, {}, false},
                                    {Type::rotate, 2.0, 4.0, {2.0, 0.0, 0.0}, {2.0, 0.0, 2.0}, {}, false}};
  EXPECT_EQ(pose_at(actions, start, -1.0), start);
  EXPECT_EQ(pose_at(actions, start, 1.0), (Pose{1.0, 0.0, 0.0}));
  EXPECT_NEAR(pose_at(actions, start, 3.0).theta, 1.0, 1e-12);
  EXPECT_EQ(pose_at(actions, start, 9.0), (Pose{2.0, 0.0, 2.0}));
  EXPECT_EQ(pose_at({}, start, 9.0), start);
}

}  // namespace TEST_FILE
}  // namespace fleetplan
