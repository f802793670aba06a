// Goals that are served at one of several poses.

#include <fleetplan/fleetplan.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/library/fleet.h"

namespace fleetplan {
namespace TEST_FILE {

using testing::ElementsAre;
using Json = nlohmann::json;
using Choices = std::vector<std::optional<std::size_t>>;

Goal one_of(std::vector<Alternative> poses) {
  Goal goal;
  goal.any_of = std::move(poses);
  return goal;
}

/// Docks at x = 8.5, one above the other from y = 0.5 on.
std::vector<Alternative> docks(int count) {
  std::vector<Alternative> poses;
  for (int k = 0; k < count; ++k) poses.push_back({8.5, 0.5 + k, 0.0});
  return poses;
}

/// Robots at x = 0.5 on a floor of 10 m x 5 m, each of which may take any of the docks.
Problem dock_problem(const std::vector<double>& starts, int count) {
  Problem problem{Map(10, 5, 1.0)};
  for (const double y : starts) {
    problem.robots.push_back(robot_from({0.5, y, 0.0}, {one_of(docks(count))}));
  }
  return problem;
}

/// The docks are in rooms of their own; a parked robot fills the door of the nearer one.
Problem blocked_dock() {
  Problem problem{
      Map::from_rows({"..........", "......####", "..........", "......####", ".........."}, 1.0)};
  problem.robots = {robot_from({0.5, 2.5, 0.0}, {one_of({{8.5, 2.5}, {8.5, 0.5}})}),
                    robot_from({6.5, 2.5, 0.0}, {})};
  return problem;
}

/// Goals on the way, with services, at which robots wait for each other.
Problem stations() {
  Problem problem = dock_problem({0.5, 2.5, 4.5}, 2);
  for (Robot& robot : problem.robots) {
    robot.goals[0].service = 5.0;
    robot.goals[0].any_of[1].bias = 1.5;
    robot.goals.push_back({robot.start.x, robot.start.y});
    robot.idle = Robot::Idle::yield;
  }
  return problem;
}

Choices choices(const Plan& plan) {
  Choices choices;
  for (const RobotPlan& robot : plan.plans) {
    for (const Visit& visit : robot.visits) choices.push_back(visit.choice);
  }
  return choices;
}

Json json_of(const Goal& goal) {
  Json made{{"service", goal.service}};
  if (goal.any_of.empty()) made.update({{"x", goal.x}, {"y", goal.y}});
  for (const Alternative& pose : goal.any_of) {
    made["any_of"].push_back({{"x", pose.x}, {"y", pose.y}, {"bias", pose.bias}});
    if (pose.theta) made["any_of"].back()["theta"] = *pose.theta;
  }
  return made;
}

/// The request for the service that is the same as the problem.
Json request_of(const Problem& problem) {
  Json request{{"robots", Json::array()}};
  for (int row = problem.map.rows() - 1; row >= 0; --row) {
    std::string text;
    for (int column = 0; column < problem.map.columns(); ++column) {
      text += problem.map.blocked(column, row) ? '#' : '.';
    }
    request["map"]["rows"].push_back(text);
  }
  for (const Robot& robot : problem.robots) {
    Json& made =
        request["robots"].emplace_back(Json{{"id", std::to_string(request["robots"].size())},
                                            {"radius", robot.radius},
                                            {"linear_speed", robot.linear_speed},
                                            {"angular_speed", robot.angular_speed},
                                            {"start", {{"x", robot.start.x}, {"y", robot.start.y}}},
                                            {"idle", robot.idle == Robot::Idle::yield ? "yield" : "stay"}});
    for (const Goal& goal : robot.goals) made["goals"].push_back(json_of(goal));
  }
  return request;
}

TEST(PublicAnyOf, ChoosesAsTheServiceDoes) {
  for (const Problem& problem :
       {dock_problem({2.5}, 5), dock_problem({0.5, 2.5, 4.5}, 3), blocked_dock(), stations()}) {
    const Plan plan = fleetplan::plan(problem);
    EXPECT_EQ(plan.status, Plan::Status::solved);
    EXPECT_TRUE(plan.verified);
    EXPECT_TRUE(plan.deterministic);
    EXPECT_TRUE(verify(problem, plan).valid());
    const Json answer = Json::parse(api::plan_endpoint(request_of(problem).dump(), {}).body);
    ASSERT_EQ(answer["status"], "solved") << answer.dump();
    Choices of_service;
    for (const Json& robot : answer["plans"]) {
      for (const Json& visit : robot.value("visits", Json::array())) {
        of_service.push_back(visit.contains("choice") ? std::optional(visit["choice"].get<std::size_t>())
                                                      : std::nullopt);
      }
    }
    EXPECT_EQ(choices(plan), of_service);
    EXPECT_EQ(plan.objectives.flowtime, answer["flowtime"].get<double>());
  }
}

TEST(PublicAnyOf, TellsWhichPoseIsChosen) {
  EXPECT_THAT(choices(plan(dock_problem({2.5}, 5))), ElementsAre(2U));
  EXPECT_THAT(choices(plan(blocked_dock())), ElementsAre(1U)) << "a robot is in the way of the nearer one";
  Problem biased = dock_problem({2.5}, 5);
  biased.robots[0].goals[0].any_of[2].bias = 10.0;
  EXPECT_NE(choices(plan(biased)).at(0), 2U);
  EXPECT_EQ(choices(plan(corridor_swap())), Choices(2)) << "goals with one pose have no choice";
}

TEST(PublicAnyOf, IsCheckedAtThePoseThatAVisitNames) {
  const Problem problem = dock_problem({2.5}, 5);
  const Plan plan = fleetplan::plan(problem);
  std::vector<RobotPlan> plans = plan.plans;
  plans[0].visits.clear();
  EXPECT_TRUE(verify(problem, plans).valid()) << "its actions tell";
  plans = plan.plans;
  plans[0].visits[0].choice = 3;
  EXPECT_FALSE(verify(problem, plans).valid());
  plans[0].visits[0].choice = 5;
  EXPECT_THROW(verify(problem, plans), std::invalid_argument);
}

TEST(PublicAnyOf, GoesOnToThePoseOfThePreviousPlan) {
  Problem problem = dock_problem({2.5}, 5);
  problem.robots[0].goals[0].any_of[2].bias = 10.0;
  const Plan before = plan(problem);
  problem.robots[0].goals[0].any_of[2].bias = 0.0;
  problem.robots[0].previous = before.plans[0].actions;
  const Plan after = plan(problem);
  EXPECT_EQ(choices(after), choices(before));
  EXPECT_TRUE(verify(problem, after).valid());
}

TEST(PublicAnyOf, ServesGoalsWithLoadsAtTheChosenPose) {
  Problem problem = dock_problem({2.5}, 3);
  Goal& dock = problem.robots[0].goals[0];
  dock.service = 1.0;
  dock.linear_speed_after = 0.5;
  problem.robots[0].goals.push_back({0.5, 2.5});
  const Plan plan = fleetplan::plan(problem);
  ASSERT_EQ(plan.status, Plan::Status::solved);
  problem.robots[0].committed = plan.plans[0].actions;
  EXPECT_TRUE(faults_of(problem).empty());
  const Plan committed = fleetplan::plan(problem);
  EXPECT_EQ(choices(committed), choices(plan));
  EXPECT_TRUE(committed.verified);
}

std::vector<std::string> places(const Problem& problem) {
  std::vector<std::string> places;
  for (const Fault& fault : faults_of(problem)) places.push_back(fault.place);
  return places;
}

TEST(PublicAnyOf, HasFaultsAtItsPlaces) {
  Problem problem = dock_problem({2.5}, 5);
  Goal& goal = problem.robots[0].goals[0];
  goal.any_of[1].x = 1e10;
  goal.any_of[2].bias = -1.0;
  goal.choice = 5;
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0].choice", "robots[0].goals[0].any_of[1].x",
                                           "robots[0].goals[0].any_of[2].bias"));
  goal = one_of(docks(1));
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0].any_of"))
      << "a goal with one pose has x and y";
  goal = one_of(std::vector<Alternative>(101));
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0].any_of"));
  goal = Goal();
  goal.choice = 0;
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0].choice"));
  goal = one_of({{-3.0, 0.5}, {8.5, 7.0}});
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0].any_of")) << "none fits";
  EXPECT_THAT(places(dock_problem({0.5, 2.5, 4.5}, 2)), ElementsAre("robots[2].goals[0].any_of"))
      << "two poses for three";
}

}  // namespace TEST_FILE
}  // namespace fleetplan
