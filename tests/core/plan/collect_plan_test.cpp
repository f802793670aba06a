#include "core/plan/collect_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Type = Action::Type;

constexpr double kPi = std::numbers::pi;

/// The actions, checked by the verifier.
std::vector<Action> checked_actions(const Robot& robot, const Trajectory& trajectory) {
  const Problem problem = support::make_problem(OccupancyGrid(10, 10, 1.0), {robot});
  const std::vector<Action> actions = to_actions(robot, trajectory);
  support::expect_safe(problem, {RobotPlan{0, trajectory.cost, actions}});
  return actions;
}

std::vector<Type> types(const std::vector<Action>& actions) {
  std::vector<Type> types;
  for (const Action& action : actions) types.push_back(action.type);
  return types;
}

TEST(Actions, AreEmptyIfRobotIsAtGoal) {
  EXPECT_TRUE(checked_actions(robot_at(1, 1, 0.5).to(1, 1), {{1, 1}, {}, 0.0}).empty());
  EXPECT_TRUE(checked_actions(robot_at(1, 1, 0.5).to(1, 1, 0.5), {{1, 1}, {}, 0.0}).empty());
}

TEST(Actions, AreOneRotationIfOnlyHeadingDiffers) {
  const auto actions = checked_actions(robot_at(1, 1).to(1, 1, -kPi / 2), {{1, 1}, {}, 1.0});
  ASSERT_EQ(types(actions), std::vector<Type>{Type::rotate});
  EXPECT_EQ(actions[0].t_end, 1.0);
  EXPECT_EQ(actions[0].to.theta, -kPi / 2);
}

TEST(Actions, RotateBeforeTranslationAndAtGoal) {
  const Trajectory trajectory{{1, 1}, {{{{{1, 1}, {1, 4}}, 1.0, 4.0}}}, 5.0};
  const auto actions = checked_actions(robot_at(1, 1).to(1, 4, kPi), trajectory);
  ASSERT_EQ(types(actions), (std::vector<Type>{Type::rotate, Type::translate, Type::rotate}));
  EXPECT_DOUBLE_EQ(actions[0].to.theta, kPi / 2);
  EXPECT_EQ(actions[1].t_start, 1.0);
  EXPECT_EQ(actions[1].t_end, 4.0);
  EXPECT_EQ(actions[1].to.position, Position(1, 4));
  EXPECT_EQ(actions[2].t_end, 5.0);
  EXPECT_EQ(actions[2].to.theta, kPi);
}

TEST(Actions, OmitRotationByZero) {
  const Trajectory trajectory{{1, 1}, {{{{{1, 1}, {4, 1}}, 0.0, 3.0}}}, 3.0};
  EXPECT_EQ(types(checked_actions(robot_at(1, 1).to(4, 1), trajectory)), std::vector<Type>{Type::translate});
}

TEST(Actions, RotateBeforeWaiting) {
  const Trajectory trajectory{{1, 1}, {{{{{1, 1}, {1, 4}}, 6.0, 9.0}}}, 9.0};
  const auto actions = checked_actions(robot_at(1, 1).to(1, 4), trajectory);
  ASSERT_EQ(types(actions), (std::vector<Type>{Type::rotate, Type::wait, Type::translate}));
  EXPECT_DOUBLE_EQ(actions[0].t_end, 1.0);
  EXPECT_EQ(actions[1].t_end, 6.0);
  EXPECT_DOUBLE_EQ(actions[1].from.theta, kPi / 2) << "already rotated";
}

TEST(Actions, WaitWithoutRotationBetweenCollinearMoves) {
  const Trajectory trajectory{{1, 1}, {{{{{1, 1}, {3, 1}}, 0.0, 2.0}}, {{{{3, 1}, {5, 1}}, 4.0, 6.0}}}, 6.0};
  EXPECT_EQ(types(checked_actions(robot_at(1, 1).to(5, 1), trajectory)),
            (std::vector<Type>{Type::translate, Type::wait, Type::translate}));
}

TEST(Actions, HaveNoMoveOfNoLength) {
  // A start off the lattice is left for the vertex in the same place.
  const Trajectory trajectory{{1, 1}, {{{{{1, 1}, {1, 1}}, 4.0, 4.0}}, {{{{1, 1}, {1, 4}}, 6.0, 9.0}}}, 9.0};
  const auto actions = checked_actions(robot_at(1, 1, kPi / 4).to(1, 4), trajectory);
  ASSERT_EQ(types(actions), (std::vector<Type>{Type::rotate, Type::rotate, Type::wait, Type::translate}));
  EXPECT_EQ(actions[2].t_end, 6.0);
  Trajectory stops{{1, 1}, {{{{{1, 1}, {1, 1}}, 4.0, 4.0}}}, 9.0};
  stops.stops_at = 9.0;
  EXPECT_EQ(types(to_actions(robot_at(1, 1).to(1, 4), stops)), std::vector<Type>{Type::wait});
}

TEST(Actions, RotateTheShorterWayAcrossPi) {
  // From heading 3 towards (-1, -0.1): across pi, where headings change sign.
  const Position to(4.0, 4.9);
  const double heading = std::atan2(-0.1, -1.0);
  const double turn = (heading + 2.0 * kPi - 3.0) / (kPi / 2);
  const double seconds = (to - Position(5, 5)).norm();
  const Trajectory trajectory{{5, 5}, {{{{{5, 5}, to}, turn, turn + seconds}}}, turn + seconds};
  const auto actions = checked_actions(robot_at(5, 5, 3.0).to(4.0, 4.9), trajectory);
  ASSERT_EQ(types(actions), (std::vector<Type>{Type::rotate, Type::translate}));
  EXPECT_NEAR(actions[0].to.theta, heading, 1e-12);
}

TEST(Actions, RotateByPiBeforeMovingBack) {
  const Trajectory trajectory{{5, 5}, {{{{{5, 5}, {3, 5}}, 2.0, 4.0}}}, 4.0};
  const auto actions = checked_actions(robot_at(5, 5).to(3, 5), trajectory);
  ASSERT_EQ(types(actions), (std::vector<Type>{Type::rotate, Type::translate}));
  EXPECT_EQ(actions[0].to.theta, kPi);
}

TEST(Actions, LeaveNoGapInTimeOrPose) {
  const double third = 1.0 / 3.0;
  const Trajectory trajectory{{1, 1},
                              {{{{{1, 1}, {1 + third, 1}}, 0.0, third}},
                               {{{{1 + third, 1}, {1 + third, 2}}, third + 1.0, third + 2.0}}},
                              third + 3.0};
  const auto actions = checked_actions(robot_at(1, 1).to(1 + third, 2, 0.0), trajectory);
  EXPECT_EQ(actions.front().t_start, 0.0);
  EXPECT_EQ(actions.back().t_end, trajectory.cost);
  for (std::size_t i = 1; i < actions.size(); ++i) {
    EXPECT_EQ(actions[i].t_start, actions[i - 1].t_end);
    EXPECT_EQ(actions[i].from.position, actions[i - 1].to.position);
    EXPECT_EQ(actions[i].from.theta, actions[i - 1].to.theta);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
