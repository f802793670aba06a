#include "core/moves/ejection_search.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Robots = std::vector<std::size_t>;

/// A wall with two gates. Robots 1 and 2 rest in them; robot 0 has to pass one.
Planning two_gates() {
  return Planning(
      support::ascii_map({"....#....",  //
                          ".........",  //
                          "....#....",  //
                          ".........",  //
                          "....#...."}),
      {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 3.5).to(4.5, 3.5), robot_at(4.5, 1.5).to(4.5, 1.5)});
}

Robots ejected_for_robot_0(Planning& p, EjectionSearch& ejection, const Robots& planned,
                           const std::vector<int>& failures) {
  const SearchResult result = ejection.plan(0, planned, failures);
  return result.trajectory ? p.reservations.conflicting_robots(0, *result.trajectory) : Robots{0};
}

TEST(EjectionSearch, EjectsTheRobotThatFailedLessOften) {
  Planning p = two_gates();
  for (const std::size_t robot : {1u, 2u}) {
    p.reservations.follow(robot, through({p.instance.problem().robots()[robot].start.position}));
  }
  EjectionSearch ejection(p.state, p.random, p.never);
  EXPECT_EQ(ejected_for_robot_0(p, ejection, {1, 2}, {1, 0, 3}), Robots{1});
  EXPECT_EQ(ejected_for_robot_0(p, ejection, {1, 2}, {1, 3, 0}), Robots{2});
}

TEST(EjectionSearch, EjectsNoRobotThatCanBeSpared) {
  // Robot 1 rests in the only gate. Robots 2, 3 and 4 rest on the straight way to it, with room to pass them.
  Planning p(
      support::ascii_map({"......#..",  //
                          ".........",  //
                          "......#.."}),
      {robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(6.5, 1.5).to(6.5, 1.5), robot_at(2.5, 1.5).to(2.5, 1.5),
       robot_at(3.5, 1.5).to(3.5, 1.5), robot_at(4.5, 1.5).to(4.5, 1.5)});
  const Robots others{1, 2, 3, 4};
  for (const std::size_t robot : others) {
    p.reservations.follow(robot, through({p.instance.problem().robots()[robot].start.position}));
  }
  EjectionSearch ejection(p.state, p.random, p.never);
  EXPECT_EQ(ejected_for_robot_0(p, ejection, others, {1, 5, 0, 0, 0}), Robots{1});
  for (const std::size_t robot : others)
    EXPECT_TRUE(p.reservations.trajectory(robot)) << "nothing is removed yet";
}

TEST(EjectionSearch, EjectsARobotLastForWhichOthersWereEjected) {
  Planning p = two_gates();
  for (const std::size_t robot : {1u, 2u}) {
    p.reservations.follow(robot, through({p.instance.problem().robots()[robot].start.position}));
  }
  EjectionSearch ejection(p.state, p.random, p.never);
  p.reservations.remove(1);
  ASSERT_TRUE(ejection.plan(1, {2}, {0, 1, 0}).trajectory);
  p.reservations.follow(1, through({p.instance.problem().robots()[1].start.position}));
  EXPECT_EQ(ejected_for_robot_0(p, ejection, {1, 2}, {1, 1, 3}), Robots{2})
      << "although it failed more often";
}

TEST(EjectionSearch, FindsNothingWhereRobotsThatStayBlockTheOnlyWay) {
  Planning p = two_gates();
  for (const std::size_t robot : {1u, 2u}) p.reservations.stay_in_place(robot);
  EjectionSearch ejection(p.state, p.random, p.never);
  const SearchResult result = ejection.plan(0, {}, {1, 0, 0});
  EXPECT_FALSE(result.trajectory);
  EXPECT_TRUE(result.complete);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
