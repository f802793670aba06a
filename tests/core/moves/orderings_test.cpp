#include "core/moves/orderings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Priority = PlanOptions::Priority;
using Reordering = PlanOptions::Reordering;

/// Robots 0 to 4 have 3, 1, 5, 3 and 2 metres to go.
PriorityOrder first_order(Priority priority, std::uint64_t seed = 0) {
  PlanOptions options;
  options.priority = priority;
  options.seed = seed;
  Planning p(OccupancyGrid(10, 10, 1.0),
             {robot_at(1, 1).to(4, 1), robot_at(1, 3).to(2, 3), robot_at(1, 5).to(6, 5),
              robot_at(1, 7).to(4, 7), robot_at(1, 9).to(3, 9)},
             options);
  return initial_order(p.instance, p.movers(), p.random);
}

TEST(InitialOrder, IsByDistanceOrAsListed) {
  EXPECT_EQ(first_order(Priority::shortest_first), (PriorityOrder{1, 4, 0, 3, 2}));
  EXPECT_EQ(first_order(Priority::longest_first), (PriorityOrder{2, 0, 3, 4, 1}));
  EXPECT_EQ(first_order(Priority::as_listed), (PriorityOrder{0, 1, 2, 3, 4}));
}

TEST(InitialOrder, WithAHorizonTheOldestGoalComesFirst) {
  const auto order_with = [](double age, double other_age, std::optional<double> horizon) {
    PlanOptions options;
    options.horizon = horizon;
    std::vector<Robot> robots{robot_at(1, 1).to(2, 1), robot_at(1, 3).to(4, 3), robot_at(1, 5).to(7, 5),
                              robot_at(1, 7).to(1, 7)};
    robots[1].goal_age = other_age;
    robots[2].goal_age = age;
    robots[3].goal_age = 100.0;  // it has arrived
    Planning p(OccupancyGrid(10, 10, 1.0), robots, options);
    return initial_order(p.instance, p.movers(), p.random);
  };
  EXPECT_EQ(order_with(0.0, 0.0, 10.0), (PriorityOrder{0, 1, 2, 3}));
  EXPECT_EQ(order_with(0.1, 0.0, 10.0), (PriorityOrder{2, 0, 1, 3}));
  EXPECT_EQ(order_with(2.0, 2.0, 10.0), (PriorityOrder{1, 0, 2, 3})) << "a tie";
  EXPECT_EQ(order_with(2.0, 0.0, std::nullopt), (PriorityOrder{3, 0, 1, 2}));
}

TEST(InitialOrder, AtRandomDependsOnlyOnTheSeed) {
  std::set<PriorityOrder> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PriorityOrder order = first_order(Priority::random, seed);
    EXPECT_EQ(first_order(Priority::random, seed), order);
    seen.insert(order);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, (PriorityOrder{0, 1, 2, 3, 4}));
  }
  EXPECT_GT(seen.size(), 10u);
}

TEST(OrderSequence, GivesAFailedRobotTheHighestPriority) {
  Random random(0);
  OrderSequence orders(Reordering::raise_failed, {0, 1, 2, 3}, random);
  EXPECT_EQ(orders.current(), (PriorityOrder{0, 1, 2, 3}));
  ASSERT_TRUE(orders.advance(2));
  EXPECT_EQ(orders.current(), (PriorityOrder{2, 0, 1, 3}));
  ASSERT_TRUE(orders.advance(3));
  EXPECT_EQ(orders.current(), (PriorityOrder{3, 2, 0, 1}));
}

TEST(OrderSequence, ShufflesWhereRaisingRepeatsAnOrder) {
  Random random(0);
  OrderSequence orders(Reordering::raise_failed, {0, 1, 2}, random);
  ASSERT_TRUE(orders.advance(1));
  ASSERT_TRUE(orders.advance(0));
  std::set<PriorityOrder> seen{{0, 1, 2}, {1, 0, 2}};
  EXPECT_TRUE(seen.insert(orders.current()).second) << "raising 0 leads back to the first order";
}

TEST(OrderSequence, HasOneOrderWithoutReordering) {
  Random random(0);
  OrderSequence orders(Reordering::none, {0, 1, 2}, random);
  EXPECT_FALSE(orders.advance(2));
  EXPECT_EQ(orders.current(), (PriorityOrder{0, 1, 2}));
}

TEST(OrderSequence, HasOneOrderForOneRobot) {
  Random random(0);
  EXPECT_FALSE(OrderSequence(Reordering::raise_failed, {5}, random).advance(5));
  EXPECT_FALSE(OrderSequence(Reordering::random, {5}, random).advance(5));
}

class OrderSequenceReordering : public testing::TestWithParam<Reordering> {};

TEST_P(OrderSequenceReordering, TriesEveryOrderOnceAndEnds) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    OrderSequence orders(GetParam(), {0, 1, 2, 3}, random);
    std::set<PriorityOrder> seen{orders.current()};
    while (orders.advance(orders.current()[random.below(4)])) {
      ASSERT_TRUE(seen.insert(orders.current()).second) << "seed " << seed;
    }
    EXPECT_EQ(seen.size(), 24u) << "seed " << seed;
  }
}

TEST_P(OrderSequenceReordering, OmitsADroppedRobot) {
  Random random(1);
  OrderSequence orders(GetParam(), {0, 1, 2, 3}, random);
  ASSERT_TRUE(orders.advance(2));
  orders.drop(1);
  std::set<PriorityOrder> seen{orders.current()};
  while (orders.advance(orders.current().back())) {
    ASSERT_EQ(orders.current().size(), 3u);
    ASSERT_EQ(std::count(orders.current().begin(), orders.current().end(), 1u), 0);
    ASSERT_TRUE(seen.insert(orders.current()).second);
  }
  EXPECT_EQ(seen.size(), 6u);
}

INSTANTIATE_TEST_SUITE_P(Kinds, OrderSequenceReordering,
                         testing::Values(Reordering::raise_failed, Reordering::random));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
