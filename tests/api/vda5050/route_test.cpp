#include "api/vda5050/route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/plan_builder.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::DoubleNear;
using testing::ElementsAre;

constexpr double kRight = std::numbers::pi / 2.0;

core::Robot make_robot() { return {"a", 0.3, 1.0, 2.0, {{0.5, 0.5}, 0.0}, core::Goal{{4.5, 2.5}, {}}}; }

support::PlanBuilder plan(const core::Robot& robot) { return {0, robot}; }

Route route(const core::Robot& robot, const core::RobotPlan& plan,
            const std::vector<core::ActionPlace>& cuts = {}, double wait_before_move = 0.0) {
  return route_of(robot, plan.actions, cuts, wait_before_move);
}

/// Nodes as "x,y heading action+fraction stops".
std::vector<std::string> brief(const Route& route) {
  const auto text = [](double number) { return testing::PrintToString(number); };
  std::vector<std::string> lines;
  for (const RouteNode& node : route.nodes) {
    lines.push_back(text(node.position.x()) + "," + text(node.position.y()) + " " +
                    (node.theta ? text(*node.theta) : "-") + " " + std::to_string(node.at.action) + "+" +
                    text(node.at.fraction) + " " + std::to_string(node.stops.size()));
  }
  return lines;
}

TEST(Route, HasANodeWhereverTheRobotStops) {
  const core::Robot robot = make_robot();
  const auto straight = plan(robot).translate_to(4.5, 0.5).wait(3.0).translate_to(6.5, 0.5).build();
  const Route way = route(robot, straight);
  EXPECT_THAT(brief(way), ElementsAre("0.5,0.5 0 0+0 0", "4.5,0.5 - 1+0 0", "6.5,0.5 0 3+0 0"));
  ASSERT_EQ(way.edges.size(), 2U);
  EXPECT_EQ(way.edges[0].length, 4.0);
  EXPECT_EQ(way.edges[0].speed, 1.0);
}

TEST(Route, HasTheGreatestSpeedsOfProfiles) {
  core::Robot robot = make_robot();
  robot.linear_acceleration = robot.linear_deceleration = 0.5;
  robot.angular_acceleration = 1.0;
  auto corner = plan(robot).translate_to(4.5, 0.5).rotate_to(kRight).translate_to(4.5, 2.5).build();
  double t = 0.0;
  for (core::Action& action : corner.actions) {
    const bool turns = action.type == core::Action::Type::rotate;
    const core::Inertia inertia = turns ? robot.angular_inertia() : robot.linear_inertia();
    const double amount = turns ? kRight : (action.to.position - action.from.position).norm();
    action.profile = core::fastest_profile(amount, turns ? 2.0 : 1.0, inertia);
    action.t_start = t;
    action.t_end = t += core::duration(*action.profile, amount);
  }
  const Route way = route(robot, corner, {{0, 0.25}});
  ASSERT_EQ(way.edges.size(), 3U);
  EXPECT_EQ(way.edges[0].speed, 1.0);
  EXPECT_EQ(way.edges[1].speed, 1.0);
  EXPECT_DOUBLE_EQ(way.edges[2].speed, 1.0) << "a metre to start, and one to stop";
  EXPECT_DOUBLE_EQ(way.edges[2].rotation_speed, std::sqrt(kRight));
  // It starts and stops in 2 s and 1 m each. After 2 s of the 6 s, it is at 1 m, and after 4 s at 3 m.
  const std::vector<core::Action> first(corner.actions.begin(), corner.actions.begin() + 1);
  const auto points = with_points_within(2.0, {}, first, unbounded_work());
  ASSERT_EQ(points.size(), 2U);
  EXPECT_DOUBLE_EQ(points[0].fraction, 0.25);
  EXPECT_DOUBLE_EQ(points[1].fraction, 0.75);
}

TEST(Gates, OfProfilesAreMovedByTime) {
  core::Robot robot = make_robot();
  robot.linear_acceleration = robot.linear_deceleration = 0.5;
  auto way = plan(robot).translate_to(4.5, 0.5).build();
  way.actions[0].profile = core::fastest_profile(4.0, 1.0, robot.linear_inertia());
  way.actions[0].t_end = 6.0;
  // 0.1 m behind its start it has 0.32 m/s; a centimetre takes it 30 ms there, not 15.
  const std::vector<core::Actions> actions{way.actions};
  const auto gates = gates_of({{{0, 0, 0.025}, {0, 0, 0.5}, 0.06}}, actions);
  EXPECT_NEAR(gates[0].place.fraction * 4.0, 0.1 - 0.015 * std::sqrt(0.1), 1e-4);
  EXPECT_NEAR(gates[0].until.fraction * 4.0, 2.0 + 0.01, 1e-12);
}

TEST(Route, TellsTheHeadingWhereTheRobotTurns) {
  const core::Robot robot = make_robot();
  const auto corner = plan(robot).translate_to(4.5, 0.5).rotate_to(kRight).translate_to(4.5, 2.5).build();
  const Route way = route(robot, corner);
  ASSERT_EQ(way.nodes.size(), 3U);
  EXPECT_EQ(way.nodes[1].theta, kRight);
  EXPECT_EQ(way.nodes[2].theta, kRight);
  EXPECT_DOUBLE_EQ(way.edges[1].rotation_speed, robot.angular_speed);
}

TEST(Route, BeginsWithTheHeadingThatTheRobotHas) {
  const core::Robot robot = make_robot();
  const Route turned = route(robot, plan(robot).rotate_to(kRight).translate_to(0.5, 2.5).build());
  ASSERT_EQ(turned.nodes.size(), 2U);  // the edge tells the heading to drive in
  EXPECT_EQ(turned.nodes[0].theta, 0.0);

  const Route only_turns = route(robot, plan(robot).rotate_to(kRight).build());
  ASSERT_EQ(only_turns.nodes.size(), 2U);
  EXPECT_EQ(only_turns.nodes[1].theta, kRight);
  EXPECT_EQ(only_turns.edges[0].length, 0.0);
}

TEST(Route, IsCutWhereOthersDependOnIt) {
  const core::Robot robot = make_robot();
  const auto corner = plan(robot).translate_to(4.5, 0.5).rotate_to(kRight).translate_to(4.5, 2.5).build();
  const Route way =
      route(robot, corner, {{0, 0.0}, {0, 0.25}, {0, 0.75}, {1, 0.5}, {2, 0.0}, {2, 0.5}, {3, 0.0}});
  EXPECT_THAT(brief(way), ElementsAre("0.5,0.5 0 0+0 0", "1.5,0.5 - 0+0.25 0", "3.5,0.5 - 0+0.75 0",
                                      testing::StartsWith("4.5,0.5 1.57"), "4.5,1.5 - 2+0.5 0",
                                      testing::StartsWith("4.5,2.5 1.57")));
  ASSERT_EQ(way.edges.size(), 5U);
  EXPECT_THAT(way.edges[1].length, DoubleNear(2.0, 1e-12));
}

TEST(Route, HasServicesAndAddedWaitsButNoWaitsThatGiveWay) {
  core::Robot robot = make_robot();
  robot.via = {core::Goal{{4.5, 0.5}, 0.0, 2.0, 30.0}};
  auto visit =
      plan(robot).translate_to(4.5, 0.5).wait(5.0).rotate_to(kRight).wait(4.0).translate_to(4.5, 2.5).build();
  visit.actions[1].goal = 0;
  const Route way = route(robot, visit, {}, 1.5);
  ASSERT_EQ(way.nodes.size(), 4U);
  ASSERT_EQ(way.nodes[1].stops.size(), 1U);
  EXPECT_EQ(way.nodes[1].theta, 0.0);
  EXPECT_EQ(way.nodes[1].stops[0].goal, 0U);
  EXPECT_EQ(way.nodes[1].stops[0].duration, 2.0);
  EXPECT_EQ(way.nodes[1].stops[0].not_before, 30.0);
  // In another heading, so at a node of its own.
  EXPECT_EQ(way.nodes[2].position, way.nodes[1].position);
  EXPECT_EQ(way.nodes[2].theta, kRight);
  ASSERT_EQ(way.nodes[2].stops.size(), 1U);
  EXPECT_FALSE(way.nodes[2].stops[0].goal);
  EXPECT_EQ(way.nodes[2].stops[0].duration, 1.5);
  EXPECT_EQ(way.nodes[2].at, way.nodes[1].at);
}

TEST(Route, HasTheAddedWaitThatIsLongerThanTheServiceAtItsEnd) {
  core::Robot robot = make_robot();
  robot.via = {core::Goal{{4.5, 0.5}, {}, 2.0, 7.0}};
  auto visit = plan(robot).translate_to(4.5, 0.5).wait(5.0).translate_to(6.5, 0.5).build();
  visit.actions[1].goal = 0;
  const Route way = route(robot, visit, {}, 3.5);
  ASSERT_EQ(way.nodes.size(), 3U);
  ASSERT_EQ(way.nodes[1].stops.size(), 2U);
  EXPECT_FALSE(way.nodes[1].stops[0].goal);
  EXPECT_EQ(way.nodes[1].stops[0].duration, 1.5);
  EXPECT_EQ(way.nodes[1].stops[1].goal, 0U);
  EXPECT_EQ(way.nodes[1].stops[1].duration, 2.0);
  EXPECT_EQ(way.nodes[1].stops[1].not_before, 7.0);
}

TEST(Route, HasNoServiceOfAGoalThatTheRobotDoesNotHave) {
  core::Robot robot = make_robot();
  robot.goal.reset();
  auto visit = plan(robot).translate_to(4.5, 0.5).wait(5.0).build();
  visit.actions[1].goal = 0;
  EXPECT_THAT(brief(route(robot, visit)), ElementsAre("0.5,0.5 0 0+0 0", "4.5,0.5 0 1+0 0"));
}

TEST(Route, IsEmptyWithoutActions) { EXPECT_TRUE(route(make_robot(), {}).nodes.empty()); }

TEST(Release, EndsAtTheFirstGateWhoseConditionIsNotMet) {
  const core::Robot robot = make_robot();
  const auto way = plan(robot).translate_to(4.5, 0.5).wait(1.0).translate_to(6.5, 0.5).build();
  const std::vector<core::Dependency> dependencies{
      {{0, 0, 0.5}, {1, 0, 0.25}, 1.0}, {{0, 1, 0.5}, {1, 0, 0.5}, 1.0}, {{0, 2, 0.5}, {1, 0, 1.0}, 1.0}};
  const auto gates = gates_of(dependencies, {way.actions, way.actions});
  const auto points = points_of(gates, 2);
  // A centimetre behind the points that open gates, and before gates.
  EXPECT_THAT(points[1], ElementsAre(core::ActionPlace{0, 0.2525}, core::ActionPlace{0, 0.5025},
                                     core::ActionPlace{1, 0.0}));
  EXPECT_THAT(points[0], ElementsAre(core::ActionPlace{0, 0.4975}, core::ActionPlace{1, 0.5},
                                     core::ActionPlace{2, 0.495}));
  const std::vector<Route> routes{route(robot, way, points[0]), {}};
  const auto released = [&](core::ActionPlace other) {
    return released_nodes(routes[0], closed_gates(gates, {core::ActionPlace{}, other}).front());
  };
  ASSERT_EQ(routes[0].nodes.size(), 5U);
  EXPECT_EQ(released({0, 0.0}), 2U);     // up to the gate in the first translation
  EXPECT_EQ(released({0, 0.2525}), 3U);  // to the end of it: the next gate is in the wait there
  EXPECT_EQ(released({0, 0.5025}), 4U);
  EXPECT_EQ(released({0, 0.9}), 4U);
  EXPECT_EQ(released({1, 0.0}), 5U);
}

TEST(Release, GoesSoManySecondsAheadAndToTheNextNodeAtLeast) {
  const core::Robot robot = make_robot();
  const auto way = plan(robot).translate_to(4.5, 0.5).wait(10.0).translate_to(6.5, 0.5).build();
  const auto cuts = with_points_within(1.5, {{0, 0.5}}, way.actions, unbounded_work());
  EXPECT_THAT(cuts, ElementsAre(core::ActionPlace{0, 1.0 / 3.0}, core::ActionPlace{0, 0.5},
                                core::ActionPlace{0, 2.0 / 3.0}, core::ActionPlace{2, 0.5}));
  const Route cut = route(robot, way, cuts);
  const auto within = [&](double seconds, core::ActionPlace at) {
    return nodes_within(seconds, cut, way.actions, at);
  };
  ASSERT_EQ(cut.nodes.size(), 7U);
  EXPECT_EQ(within(3.0, {}), 4U);
  EXPECT_EQ(within(0.1, {}), 2U);
  EXPECT_EQ(within(0.1, {0, 0.4}), 3U);
  EXPECT_EQ(within(3.0, {1, 0.0}), 6U) << "the next node comes after a wait of 10 s";
  EXPECT_EQ(within(100.0, {}), 7U);
}

TEST(Route, ContinuesAnOrderBehindItsCommittedActions) {
  core::Robot robot = make_robot();
  robot.via = {core::Goal{{4.5, 0.5}, {}, 2.0}};
  auto way = plan(robot).translate_to(4.5, 0.5).wait(2.0).rotate_to(kRight).translate_to(4.5, 2.5).build();
  way.actions[1].goal = 0;
  const auto stitched = [&](std::size_t action) {
    return route_of(robot, way.actions, {{0, 0.5}}, 0.0, {action, 8, true});
  };
  const Route behind = stitched(2);
  EXPECT_THAT(brief(behind), ElementsAre("4.5,0.5 0 2+0 0", testing::StartsWith("4.5,2.5 1.57")));
  EXPECT_EQ(behind.sequence_id(1), 10U);
  EXPECT_EQ(behind.node_of(10), 1U);
  EXPECT_EQ(behind.node_of(6), std::nullopt);
  EXPECT_EQ(behind.node_of(9), std::nullopt);
  EXPECT_EQ(behind.node_of(12), std::nullopt);
  // What the vehicle is to do where it stands is at a separate node, because it has the first node already.
  const Route before = stitched(1);
  ASSERT_EQ(before.nodes.size(), 3U);
  EXPECT_TRUE(before.nodes[0].stops.empty());
  EXPECT_EQ(before.nodes[1].position, before.nodes[0].position);
  ASSERT_EQ(before.nodes[1].stops.size(), 1U);
  EXPECT_EQ(before.nodes[1].until, (core::ActionPlace{2, 0.0}));
  EXPECT_THAT(brief(stitched(4)), ElementsAre(testing::StartsWith("4.5,2.5 1.57")));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
