#include "core/sipp/vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

std::vector<int> neighbours(const Vertices& vertices, int vertex) {
  std::vector<int> all;
  vertices.for_each_neighbour(vertex, [&](int neighbour) { all.push_back(neighbour); });
  std::sort(all.begin(), all.end());
  return all;
}

/// The last one; -1 if there is none.
int goal_of(const Vertices& vertices) {
  return vertices.goals().empty() ? -1 : vertices.goals().back().vertex;
}

TEST(Vertices, AddsNoneIfStartAndGoalAreOnLattice) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(1.5, 2.5).to(6.5, 4.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  EXPECT_EQ(vertices.count(), 48);
  EXPECT_EQ(vertices.start(), 17);
  EXPECT_EQ(goal_of(vertices), 38);
  EXPECT_EQ(neighbours(vertices, 17).size(), 8u);
}

TEST(Vertices, AddsStartAndGoalOffLattice) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(1.2, 2.7).to(6.51, 4.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  EXPECT_EQ(vertices.count(), 50);
  EXPECT_EQ(vertices.start(), 48);
  EXPECT_EQ(goal_of(vertices), 49);
  EXPECT_EQ(vertices.position(48), Position(1.2, 2.7));
  EXPECT_EQ(vertices.position(49), Position(6.51, 4.5));
}

TEST(Vertices, SharesOneVertexForEqualStartAndGoal) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(1.2, 2.7).to(1.2, 2.7, 1.0)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  EXPECT_EQ(vertices.start(), goal_of(vertices));
  EXPECT_EQ(vertices.count(), 49);
}

TEST(Vertices, HasNoGoalForParkedRobot) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(1.2, 2.7)});
  EXPECT_EQ(goal_of(Vertices(p.instance, 0, 0, StopCondition::never())), -1);
}

PlanOptions inflated(double metres) {
  PlanOptions options;
  options.inflation = metres;
  return options;
}

TEST(Vertices, AddsAStartOnTheLatticeThatIsTooNearToAWall) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(0.5, 2.5).to(6.5, 4.5)}, inflated(0.2));
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  EXPECT_EQ(vertices.start(), 48);
  EXPECT_EQ(vertices.position(48), Position(0.5, 2.5));
  const auto from_start = neighbours(vertices, vertices.start());
  EXPECT_TRUE(std::binary_search(from_start.begin(), from_start.end(), 17)) << "straight away from it";
  EXPECT_FALSE(std::binary_search(from_start.begin(), from_start.end(), 16)) << "the same place";
  EXPECT_FALSE(std::binary_search(from_start.begin(), from_start.end(), 24)) << "as near to the wall";
  EXPECT_TRUE(vertices.in_sight(48, 17));
  EXPECT_FALSE(vertices.in_sight(17, 48)) << "it is left once, and never entered again";
  EXPECT_FALSE(vertices.allow(17, 48));
  EXPECT_TRUE(vertices.allow(48, 17));
  EXPECT_FALSE(vertices.in_sight(48, 22)) << "far away, the robot keeps its full distance";
}

TEST(Vertices, LinksAStartThatIsTooNearFarEnoughToBeClear) {
  PlanOptions options = inflated(0.1);
  options.lattice_spacing = 0.1;
  const Planning p(OccupancyGrid(80, 80, 0.1), {robot_at(4.05, 4.05).to(7.5, 7.5), robot_at(4.9, 4.05)},
                   options);
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  ASSERT_GE(vertices.start(), 6400);
  double farthest = 0.0;
  for (const int vertex : neighbours(vertices, vertices.start())) {
    farthest = std::max(farthest, (vertices.position(vertex) - Position(4.05, 4.05)).norm());
  }
  EXPECT_NEAR(farthest, 0.2 + 2.0 * 0.15, 0.1) << "two cells, and twice what is missing";
}

TEST(Vertices, LinksNearbyStartAndGoalDirectly) {
  const Planning p(OccupancyGrid(8, 6, 1.0), {robot_at(1.2, 2.7).to(2.3, 3.1)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  const auto from_start = neighbours(vertices, vertices.start());
  EXPECT_TRUE(std::binary_search(from_start.begin(), from_start.end(), goal_of(vertices)));
  const auto from_goal = neighbours(vertices, goal_of(vertices));
  EXPECT_TRUE(std::binary_search(from_goal.begin(), from_goal.end(), vertices.start()));
}

TEST(Vertices, DoesNotLinkStartAndGoalOutOfSight) {
  const Planning p(support::ascii_map({"...",  //
                                       "###",  //
                                       "..."}),
                   {robot_at(1.2, 0.5).radius(0.3).to(1.2, 2.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  EXPECT_EQ(neighbours(vertices, vertices.start()), (std::vector<int>{0, 1, 2}));
}

TEST(Vertices, LinksOwnVerticesBothWaysWithLatticeInSightWithinTwoCells) {
  const std::uint64_t seed = 23;
  support::Dice dice(seed);
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    const Planning p(support::random_problem(dice, 1));
    const Vertices vertices(p.instance, 0, 0, StopCondition::never());
    const int start = vertices.start();
    if (start < p.instance.lattice(0).vertex_count()) continue;
    std::vector<int> expected;
    for (int v = 0; v < p.instance.lattice(0).vertex_count(); ++v) {
      const Position there = vertices.position(v);
      if ((there - vertices.position(start)).norm() > 2.0 * p.problem.grid().resolution()) continue;
      const bool seen = p.instance.sight_past_walls().may_sweep(vertices.position(start), there,
                                                                p.instance.body(0).wall_radius);
      if (seen) expected.push_back(v);
      const auto back = neighbours(vertices, v);
      ASSERT_EQ(std::binary_search(back.begin(), back.end(), start), seen) << "from vertex " << v;
    }
    auto links = neighbours(vertices, start);
    std::erase(links, goal_of(vertices));
    std::erase_if(links, [&](int v) { return v >= p.instance.lattice(0).vertex_count(); });  // finer ones
    std::erase(expected, goal_of(vertices));
    ASSERT_EQ(links, expected);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
