#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();
/// Times are stored as float.
constexpr double kRounding = 1e-4;

OccupancyGrid two_rooms() {
  return support::ascii_map({".....",  //
                             "..#..",  //
                             "..#.."});
}

/// The times of the fastest ways from a vertex to all others (Bellman and Ford).
std::vector<double> times_from(const Vertices& vertices, int start) {
  std::vector<double> times(static_cast<std::size_t>(vertices.count()), kForever);
  times[static_cast<std::size_t>(start)] = 0.0;
  for (bool improved = true; improved;) {
    improved = false;
    for (int vertex = 0; vertex < vertices.count(); ++vertex) {
      const double seconds = times[static_cast<std::size_t>(vertex)];
      if (seconds == kForever) continue;
      vertices.for_each_neighbour(vertex, [&](int next) {
        const double length = (vertices.position(next) - vertices.position(vertex)).norm();
        const double through = seconds + vertices.body().translation_time(length);
        if (through >= times[static_cast<std::size_t>(next)]) return;
        times[static_cast<std::size_t>(next)] = through;
        improved = true;
      });
    }
  }
  return times;
}

TEST(TimesFromStart, FollowTheWayAroundAWall) {
  Planning p(two_rooms(), {robot_at(1.5, 0.5).to(3.5, 0.5).radius(0.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  TimesFromStart times(vertices, vertices.start(), vertices.goals().back().vertex);
  EXPECT_EQ(times.at_least(vertices.goals().back().vertex), 0.0) << "not yet searched";
  ASSERT_TRUE(times.reach_goal(kUnlimited, p.never).value());
  EXPECT_NEAR(times.at_least(vertices.goals().back().vertex), 6.0, kRounding);
}

TEST(TimesFromStart, PreferTheFastWayAroundASlowZone) {
  Zone slow{
      .id = "slow", .type = Zone::Type::speed, .polygon = {{2.0, 0.0}, {3.0, 0.0}, {3.0, 1.0}, {2.0, 1.0}}};
  slow.linear_speed = 0.1;
  slow.angular_speed = 1.0;
  Planning p(
      support::make_problem(OccupancyGrid(5, 3, 1.0), {robot_at(0.5, 0.5).to(4.5, 0.5)}, {.zones = {slow}}));
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  TimesFromStart times(vertices, vertices.start(), vertices.goals().back().vertex);
  ASSERT_TRUE(times.reach_goal(kUnlimited, p.never).value());
  EXPECT_NEAR(times.at_least(vertices.goals().back().vertex), 2.0 + 2.0 * std::sqrt(2.0), kRounding)
      << "10 s through the zone";
}

TEST(TimesFromStart, TellThatNoWayLeadsToTheGoal) {
  Planning p(two_rooms(), {robot_at(1.0, 1.0).to(4.0, 1.0).radius(0.6)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  TimesFromStart times(vertices, vertices.start(), vertices.goals().back().vertex);
  EXPECT_FALSE(times.reach_goal(kUnlimited, p.never).value()) << "too wide for the gap above the wall";
  EXPECT_EQ(times.at_least(vertices.goals().back().vertex), 0.0);
}

TEST(TimesFromStart, GoOnAfterTheLimit) {
  Planning p(two_rooms(), {robot_at(1.5, 0.5).to(3.5, 0.5).radius(0.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  TimesFromStart times(vertices, vertices.start(), vertices.goals().back().vertex);
  EXPECT_FALSE(times.reach_goal(2, p.never).has_value());
  EXPECT_EQ(times.expansions(), 2);
  EXPECT_FALSE(times.reach_goal(kUnlimited, met()).has_value()) << "stopped";
  EXPECT_TRUE(times.reach_goal(kUnlimited, p.never).value());
}

TEST(TimesFromStart, AreLowerBoundsAndExactAtTheGoalOnRandomMaps) {
  const std::uint64_t seed = 20261123;
  support::Dice dice(seed);
  int reached = 0;
  for (int round = 0; round < 60; ++round) {
    Planning p(support::random_problem(dice, 2));
    if (p.movers().empty()) continue;
    const Vertices vertices(p.instance, p.movers().front(), 0, StopCondition::never());
    const std::vector<double> exact = times_from(vertices, vertices.start());
    TimesFromStart times(vertices, vertices.start(), vertices.goals().back().vertex);
    const double to_goal = exact[static_cast<std::size_t>(vertices.goals().back().vertex)];
    ASSERT_EQ(times.reach_goal(kUnlimited, p.never), to_goal < kForever)
        << "seed " << seed << ", round " << round;
    if (to_goal == kForever) continue;
    ++reached;
    EXPECT_NEAR(times.at_least(vertices.goals().back().vertex), to_goal, kRounding);
    for (int vertex = 0; vertex < vertices.count(); ++vertex) {
      EXPECT_LE(times.at_least(vertex), exact[static_cast<std::size_t>(vertex)] + kRounding)
          << "round " << round << ", vertex " << vertex;
    }
  }
  EXPECT_GT(reached, 20);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
