#include "core/model/itinerary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetplan::core {
namespace TEST_FILE {

using Type = Action::Type;
using testing::IsEmpty;
using testing::SizeIs;

Action move(double t_start, double t_end, const Position& from, const Position& to) {
  return {Type::translate, t_start, t_end, {from, 0.0}, {to, 0.0}};
}

Action wait(double t_start, double t_end, const Position& at) {
  return {Type::wait, t_start, t_end, {at, 0.0}, {at, 0.0}};
}

/// At (1, 1), with the last goal (9, 1).
Robot robot_via(std::vector<Goal> via, std::vector<Action> committed) {
  Robot robot;
  robot.start.position = {1, 1};
  robot.goal = Goal{{9, 1}, {}};
  robot.via = std::move(via);
  robot.committed = std::move(committed);
  return robot;
}

TEST(Itinerary, BeginsAtTheStartWithoutCommittedActions) {
  const Itinerary itinerary = itinerary_of(robot_via({{{1, 1}, {}}}, {}));
  EXPECT_EQ(itinerary.t_begin, 0.0);
  EXPECT_EQ(itinerary.pose.position, Position(1, 1));
  EXPECT_THAT(itinerary.visited, IsEmpty());
  EXPECT_THAT(itinerary.goals, SizeIs(2));
}

TEST(Itinerary, BeginsWhereAndWhenTheCommittedActionsEnd) {
  const Itinerary itinerary = itinerary_of(robot_via({}, {move(0, 2, {1, 1}, {3, 1}), wait(2, 3, {3, 1})}));
  EXPECT_EQ(itinerary.t_begin, 3.0);
  EXPECT_EQ(itinerary.pose.position, Position(3, 1));
  ASSERT_THAT(itinerary.committed.moves, SizeIs(1));
  EXPECT_EQ(itinerary.committed.end(), Position(3, 1));
  EXPECT_EQ(itinerary.committed.cost, 3.0);
}

TEST(Itinerary, LeavesOutGoalsThatTheCommittedActionsServe) {
  const Goal pass{{3, 1}, {}};
  const Goal shelf{{5, 1}, {}, 2.0, 5.0};
  const Robot robot = robot_via({pass, shelf}, {move(0, 2, {1, 1}, {3, 1}), move(2, 4, {3, 1}, {5, 1}),
                                                wait(4, 7, {5, 1}), move(7, 8, {5, 1}, {6, 1})});
  const Itinerary itinerary = itinerary_of(robot);
  ASSERT_THAT(itinerary.visited, SizeIs(2));
  EXPECT_EQ(itinerary.visited[0].t_arrive, 2.0);
  EXPECT_EQ(itinerary.visited[0].t_leave, 2.0);
  EXPECT_EQ(itinerary.visited[1].t_arrive, 4.0);
  EXPECT_EQ(itinerary.visited[1].t_leave, 7.0) << "two seconds from not_before on";
  EXPECT_EQ(itinerary.first_goal, 2u);
  EXPECT_THAT(itinerary.goals, SizeIs(1));
}

TEST(Itinerary, CountsThePartOfAServiceThatIsDone) {
  const Robot robot = robot_via({{{3, 1}, {}, 5.0}}, {move(0, 2, {1, 1}, {3, 1}), wait(2, 3.5, {3, 1})});
  const Itinerary itinerary = itinerary_of(robot);
  EXPECT_THAT(itinerary.visited, IsEmpty());
  EXPECT_EQ(itinerary.first_goal, 0u);
  EXPECT_EQ(itinerary.arrived, 2.0);
  EXPECT_EQ(itinerary.service_done, 1.5);
}

TEST(Itinerary, RequiresTheHeadingOfAGoal) {
  const Robot robot = robot_via({{{3, 1}, 1.0}}, {move(0, 2, {1, 1}, {3, 1}), wait(2, 3, {3, 1})});
  EXPECT_EQ(itinerary_of(robot).first_goal, 0u);
}

TEST(Itinerary, ServesRepeatedGoalsOneAfterTheOther) {
  const Goal shelf{{3, 1}, {}, 1.0};
  const Itinerary itinerary =
      itinerary_of(robot_via({shelf, shelf, shelf}, {move(0, 2, {1, 1}, {3, 1}), wait(2, 4.5, {3, 1})}));
  EXPECT_EQ(itinerary.first_goal, 2u);
  EXPECT_EQ(itinerary.service_done, 0.5);
  EXPECT_EQ(itinerary.arrived, 4.0);
}

TEST(Itinerary, AlwaysKeepsTheLastGoal) {
  Robot robot = robot_via({}, {wait(0, 4, {1, 1})});
  robot.goal = Goal{{1, 1}, {}, 3.0};
  const Itinerary itinerary = itinerary_of(robot);
  EXPECT_THAT(itinerary.goals, SizeIs(1));
  EXPECT_EQ(itinerary.service_done, 3.0);
  EXPECT_EQ(itinerary.arrived, 0.0);
}

TEST(Itinerary, ForgetsAServiceThatTheRobotLeaves) {
  const Robot robot =
      robot_via({{{3, 1}, {}, 5.0}}, {move(0, 2, {1, 1}, {3, 1}), wait(2, 4, {3, 1}),
                                      move(4, 5, {3, 1}, {4, 1}), move(5, 6, {4, 1}, {3, 1})});
  const Itinerary itinerary = itinerary_of(robot);
  EXPECT_EQ(itinerary.service_done, 0.0);
  EXPECT_EQ(itinerary.arrived, 6.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
