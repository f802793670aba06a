#include "core/sipp/start_distances.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/sipp/vertices.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace {

using support::robot_at;

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();
/// Lengths are stored as float.
constexpr double kRounding = 1e-4;

OccupancyGrid two_rooms() {
  return support::ascii_map({".....",  //
                             "..#..",  //
                             "..#.."});
}

/// The lengths of the shortest ways from a vertex to all others (Bellman and Ford).
std::vector<double> lengths_from(const Vertices& vertices, int start) {
  std::vector<double> lengths(static_cast<std::size_t>(vertices.count()), kForever);
  lengths[static_cast<std::size_t>(start)] = 0.0;
  for (bool improved = true; improved;) {
    improved = false;
    for (int vertex = 0; vertex < vertices.count(); ++vertex) {
      const double length = lengths[static_cast<std::size_t>(vertex)];
      if (length == kForever) continue;
      vertices.for_each_neighbour(vertex, [&](int next) {
        const double through = length + (vertices.position(next) - vertices.position(vertex)).norm();
        if (through >= lengths[static_cast<std::size_t>(next)]) return;
        lengths[static_cast<std::size_t>(next)] = through;
        improved = true;
      });
    }
  }
  return lengths;
}

TEST(StartDistances, FollowTheWayAroundAWall) {
  Planning p(two_rooms(), {robot_at(1.5, 0.5).to(3.5, 0.5).radius(0.5)});
  const Vertices vertices(p.instance, 0);
  StartDistances distances(vertices, vertices.start(), vertices.goal());
  EXPECT_EQ(distances.at_least(vertices.goal()), 0.0) << "not yet searched";
  ASSERT_TRUE(distances.reach_goal(kUnlimited, p.never).value());
  EXPECT_NEAR(distances.at_least(vertices.goal()), 6.0, kRounding);
}

TEST(StartDistances, TellThatNoWayLeadsToTheGoal) {
  Planning p(two_rooms(), {robot_at(1.0, 1.0).to(4.0, 1.0).radius(0.6)});
  const Vertices vertices(p.instance, 0);
  StartDistances distances(vertices, vertices.start(), vertices.goal());
  EXPECT_FALSE(distances.reach_goal(kUnlimited, p.never).value()) << "too wide for the gap above the wall";
  EXPECT_EQ(distances.at_least(vertices.goal()), 0.0);
}

TEST(StartDistances, GoOnAfterTheLimit) {
  Planning p(two_rooms(), {robot_at(1.5, 0.5).to(3.5, 0.5).radius(0.5)});
  const Vertices vertices(p.instance, 0);
  StartDistances distances(vertices, vertices.start(), vertices.goal());
  EXPECT_FALSE(distances.reach_goal(2, p.never).has_value());
  EXPECT_EQ(distances.expansions(), 2);
  EXPECT_FALSE(distances.reach_goal(kUnlimited, met()).has_value()) << "stopped";
  EXPECT_TRUE(distances.reach_goal(kUnlimited, p.never).value());
}

TEST(StartDistances, AreLowerBoundsAndExactAtTheGoalOnRandomMaps) {
  const std::uint64_t seed = 20261123;
  support::Dice dice(seed);
  int reached = 0;
  for (int round = 0; round < 60; ++round) {
    Planning p(support::random_problem(dice, 2));
    if (p.movers().empty()) continue;
    const Vertices vertices(p.instance, p.movers().front());
    const std::vector<double> lengths = lengths_from(vertices, vertices.start());
    StartDistances distances(vertices, vertices.start(), vertices.goal());
    const double to_goal = lengths[static_cast<std::size_t>(vertices.goal())];
    ASSERT_EQ(distances.reach_goal(kUnlimited, p.never), to_goal < kForever)
        << "seed " << seed << ", round " << round;
    if (to_goal == kForever) continue;
    ++reached;
    EXPECT_NEAR(distances.at_least(vertices.goal()), to_goal, kRounding);
    for (int vertex = 0; vertex < vertices.count(); ++vertex) {
      EXPECT_LE(distances.at_least(vertex), lengths[static_cast<std::size_t>(vertex)] + kRounding)
          << "round " << round << ", vertex " << vertex;
    }
  }
  EXPECT_GT(reached, 20);
}

}  // namespace
}  // namespace fleetplan::core
