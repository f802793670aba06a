#include "core/moves/place_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/moves/joint_steps.h"
#include "core/moves/single_move_search.h"
#include "core/moves/step_places.h"
#include "tests/core/support/planning.h"
#include "tests/support/mazes.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

/// Two robots that have to change places, one of which can go aside.
struct Siding : Planning {
  explicit Siding(const PlanOptions& options = {})
      : Planning(support::ascii_map({"#.#",  //
                                     "..."}),
                 {robot_at(0.5, 0.5).to(2.5, 0.5), robot_at(2.5, 0.5).to(0.5, 0.5)}, options) {}
};

void follow_all(Planning& p, const PlaceSteps& steps, std::vector<Trajectory> trajectories) {
  for (std::size_t k = 0; k < trajectories.size(); ++k) {
    EXPECT_TRUE(p.reservations.conflicting_robots(steps.robots()[k], trajectories[k]).empty());
    p.reservations.follow(steps.robots()[k], std::move(trajectories[k]));
  }
  support::expect_safe(p.reservations);
}

TEST(PlaceSteps, LetRobotsGoAside) {
  Siding p;
  PlaceSteps steps(p.reservations, {0, 1}, p.random);
  auto trajectories = steps.run(p.never);
  ASSERT_TRUE(trajectories);
  EXPECT_FALSE(steps.has_no_way());
  follow_all(p, steps, std::move(*trajectories));
}

TEST(PlaceSteps, GoOnWhereTheTimeWasOver) {
  Siding p;
  PlaceSteps steps(p.reservations, {0, 1}, p.random);
  EXPECT_FALSE(steps.run(met()));
  EXPECT_FALSE(steps.has_no_way());
  EXPECT_TRUE(steps.run(p.never));
}

TEST(PlaceSteps, ProveThatThereIsNoWay) {
  Planning p(support::ascii_map({"...."}),
             {robot_at(0.5, 0.5).to(3.5, 0.5), robot_at(3.5, 0.5).to(0.5, 0.5)});
  PlaceSteps steps(p.reservations, {0, 1}, p.random);
  EXPECT_FALSE(steps.run(p.never));
  EXPECT_TRUE(steps.has_no_way());
}

TEST(PlaceSteps, WaitForAnObstacleThatPasses) {
  MovingObstacle obstacle;
  obstacle.radius = 0.3;
  obstacle.motion = {{0.0, {1.5, 3.5}}, {6.0, {1.5, 0.5}}, {9.0, {1.5, -3.0}}};
  obstacle.after = MovingObstacle::After::leaves;
  Planning p(support::make_problem(support::ascii_map({"#.#",  //
                                                       "..."}),
                                   {robot_at(0.5, 0.5).to(2.5, 0.5), robot_at(2.5, 0.5).to(0.5, 0.5)},
                                   {.obstacles = {obstacle}}));
  PlaceSteps steps(p.reservations, {0, 1}, p.random);
  auto trajectories = steps.run(p.never);
  ASSERT_TRUE(trajectories);
  follow_all(p, steps, std::move(*trajectories));
}

TEST(PlaceSteps, GoRoundRobotsThatStay) {
  Planning p(support::ascii_map({".....",  //
                                 ".....",  //
                                 "....."}),
             {robot_at(0.5, 1.5).to(4.5, 1.5), robot_at(2.6, 1.4), robot_at(2.4, 0.5)});
  p.reservations.stay_in_place(1);
  p.reservations.stay_in_place(2);
  PlaceSteps steps(p.reservations, {0}, p.random);
  auto trajectories = steps.run(p.never);
  ASSERT_TRUE(trajectories);
  follow_all(p, steps, std::move(*trajectories));
}

TEST(PlaceSteps, StopAtGoalsOnAStraightWay) {
  Robot through = robot_at(0.5, 0.5).to(3.5, 0.5);
  through.via.push_back({{1.5, 0.5}, std::nullopt});
  through.via.push_back({{2.5, 0.5}, std::nullopt});
  through.via.back().radius_after = 0.3;
  Planning p(support::ascii_map({"...."}), {through});
  PlaceSteps steps(p.reservations, {0}, p.random);
  auto trajectories = steps.run(p.never);
  ASSERT_TRUE(trajectories);
  const Trajectory& trajectory = trajectories->front();
  EXPECT_EQ(trajectory.moves.size(), 3u);
  ASSERT_EQ(trajectory.visits.size(), 2u);
  EXPECT_NEAR(trajectory.visits[0].t_arrive, 1.0, 1e-9);
  EXPECT_NEAR(trajectory.visits[1].t_arrive, 2.0, 1e-9);
}

/// A fleet so dense that robots have to push each other away.
TEST(PlaceSteps, PushManyRobots) {
  std::vector<Robot> robots;
  for (int k = 0; k < 12; ++k) {
    const double x = 0.6 + 0.9 * (k % 4);
    const double y = 0.6 + 0.9 * (k / 4);  // NOLINT(bugprone-integer-division): the row
    robots.push_back(robot_at(x, y).to(0.6 + 0.9 * ((k + 5) % 4), 0.6 + 0.9 * ((k + 5) % 12 / 4)));
  }
  Planning p(OccupancyGrid(60, 60, 0.1), robots);
  PlaceSteps steps(p.reservations, p.movers(), p.random);
  auto trajectories = steps.run(p.never);
  ASSERT_TRUE(trajectories);
  follow_all(p, steps, std::move(*trajectories));
}

/// Whether steps of one robot at a time lead to the goals, by vertices of a lattice that all robots share.
/// Written for itself: nothing of the search is used but which steps of the lattice walls leave free.
class BruteForce {
 public:
  explicit BruteForce(const Planning& p) : p_(p), lattice_(p.instance.lattice(0)) {}

  bool solves() {
    std::vector<int> start;
    for (std::size_t i = 0; i < p_.instance.size(); ++i) {
      start.push_back(lattice_.vertex_at(p_.instance.itinerary(i).pose.position));
      goal_.push_back(lattice_.vertex_at(p_.instance.itinerary(i).goals.front().position));
    }
    std::set<std::vector<int>> known{start};
    std::vector<std::vector<int>> open{start};
    while (!open.empty()) {
      const std::vector<int> at = open.back();
      open.pop_back();
      if (at == goal_) return true;
      for (std::size_t i = 0; i < at.size(); ++i) {
        std::uint32_t mask = p_.instance.views(i)[0].free_space->steps_from(at[i]);
        for (std::size_t k = 0; mask != 0; ++k, mask >>= 1U) {
          const Lattice::Step& step = lattice_.steps()[k];
          std::vector<int> next = at;
          next[i] += step.rows * lattice_.columns() + step.columns;
          if ((mask & 1U) != 0 && is_clear(at, i, next[i]) && known.insert(next).second) open.push_back(next);
        }
      }
    }
    return false;
  }

 private:
  bool is_clear(const std::vector<int>& at, std::size_t robot, int to) const {
    const Position from = lattice_.position(at[robot]);
    const Position way = lattice_.position(to) - from;
    for (std::size_t other = 0; other < at.size(); ++other) {
      if (other == robot) continue;
      const Position rest = lattice_.position(at[other]);
      const double along = std::clamp((rest - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const double reach = p_.instance.body(robot).radius + p_.instance.body(other).radius;
      if ((from + along * way - rest).norm() < reach - 1e-6) return false;
    }
    return true;
  }

  const Planning& p_;
  const Lattice& lattice_;
  std::vector<int> goal_;
};

TEST(PlaceSteps, FindAPlanWhereverSingleStepsLeadToTheGoals) {
  int solved = 0;
  int proven = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    support::Dice dice(seed);
    OccupancyGrid grid(3 + dice.below(3), 2 + dice.below(3), 1.0);
    std::vector<Position> cells;
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        if (dice.chance(0.3)) {
          grid.block({column, row});
        } else {
          cells.push_back(grid.center({column, row}));
        }
      }
    }
    const std::size_t count = 2 + static_cast<std::size_t>(dice.below(2));
    if (cells.size() < count + 1) continue;
    std::vector<Position> goals = cells;
    Random random(seed);
    random.shuffle(cells);
    random.shuffle(goals);
    std::vector<Robot> robots;
    for (std::size_t i = 0; i < count; ++i) {
      robots.push_back(
          robot_at(cells[i].x(), cells[i].y()).radius(dice.between(0.3, 0.5)).to(goals[i].x(), goals[i].y()));
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlanOptions options;
    options.lattice_spacing = 1.0;
    Planning p(std::move(grid), std::move(robots), options);
    PlaceSteps steps(p.reservations, p.movers(), p.random);
    auto trajectories = steps.run(p.never);
    if (BruteForce(p).solves()) {
      ++solved;
      EXPECT_TRUE(trajectories);
      EXPECT_FALSE(steps.has_no_way());
    } else if (steps.has_no_way()) {
      ++proven;
    }
    if (trajectories) follow_all(p, steps, std::move(*trajectories));
  }
  EXPECT_GT(solved, 40);
  EXPECT_GT(proven, 10);
}

TEST(PlaceSteps, SolveMazesOnAnyLattice) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    support::Dice dice(seed);
    const support::Maze maze = support::solvable_maze(dice, 2 + seed % 4, seed % 2 == 0);
    std::vector<Robot> robots = support::robots_of(maze);
    for (Robot& robot : robots) {
      robot.radius = dice.between(0.3, 0.45);
      robot.start.position.x() += dice.between(-0.04, 0.04);
      robot.start.theta = dice.between(-std::numbers::pi, std::numbers::pi);
      robot.may_reverse = dice.chance(0.3);
      if (dice.chance(0.3)) robot.linear_acceleration = dice.between(0.2, 2.0);
      if (dice.chance(0.3)) robot.goal->service = dice.between(0.0, 5.0);
    }
    PlanOptions options;
    if (dice.chance(0.5)) options.connectivity = 16;
    if (dice.chance(0.3)) options.wait_before_move = dice.between(0.1, 1.0);
    Planning p(support::map_of(maze, dice.chance(0.5) ? 4 : 20), std::move(robots), options);
    PlaceSteps steps(p.reservations, p.movers(), p.random);
    auto trajectories = steps.run(p.never);
    ASSERT_TRUE(trajectories);
    follow_all(p, steps, std::move(*trajectories));
  }
}

/// Places of two robots of radius 0.5 on a line: 0 m, 1 m and 2 m.
std::vector<StepPlaces> two_on_a_line(const Planning& p) {
  return *places_of_steps(p.reservations, {0, 1}, 0.0, p.never);
}

TEST(JointSteps, KnowWhoHasToMoveFirst) {
  const Planning p(support::ascii_map({"..."}), {robot_at(0.5, 0.5).radius(0.5).to(1.5, 0.5),
                                                 robot_at(1.5, 0.5).radius(0.5).to(2.5, 0.5)});
  const std::vector<StepPlaces> places = two_on_a_line(p);
  const JointSteps steps(places);
  const auto place_at = [&](std::size_t robot, double x) {
    int found = -1;
    for (std::size_t k = 0; k < places[robot].places.size(); ++k) {
      if (places[robot].places[k].position.x() == x) found = static_cast<int>(k);
    }
    return found;
  };
  using Order = JointSteps::Order;
  const JointSteps::Move follows{0, place_at(0, 0.5), place_at(0, 1.5)};
  const JointSteps::Move leads{1, place_at(1, 1.5), place_at(1, 2.5)};
  const JointSteps::Move rests{1, place_at(1, 1.5), place_at(1, 1.5)};
  const JointSteps::Move comes{1, place_at(1, 1.5), place_at(1, 0.5)};
  EXPECT_EQ(steps.order_of(follows, leads), Order::second);
  EXPECT_EQ(steps.order_of(leads, follows), Order::first);
  EXPECT_EQ(steps.order_of(follows, rests), Order::none);
  EXPECT_EQ(steps.order_of(follows, comes), Order::none) << "they would exchange places";
  const auto order = steps.order_of_step({follows.from, leads.from}, {follows.to, leads.to});
  ASSERT_TRUE(order);
  EXPECT_EQ(*order, (std::vector<std::size_t>{1, 0}));
  EXPECT_FALSE(steps.order_of_step({follows.from, comes.from}, {follows.to, comes.to}));
}

TEST(SingleMoveSearch, GoesOnWhereItWasCutOff) {
  const Siding p;
  const std::vector<StepPlaces> places = two_on_a_line(p);
  const JointSteps steps(places);
  SingleMoveSearch search(steps);
  EXPECT_EQ(search.run(2, p.never), SingleMoveSearch::Outcome::cut_off);
  EXPECT_EQ(search.run(1000, p.never), SingleMoveSearch::Outcome::found);
  const std::vector<Configuration> plan = search.plan();
  EXPECT_TRUE(steps.is_end(plan.back()));
  for (std::size_t k = 1; k < plan.size(); ++k) {
    EXPECT_NE(plan[k - 1][0] == plan[k][0], plan[k - 1][1] == plan[k][1]) << "one robot moves";
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
