// Plans have the same digits with every compiler and CPU: the plans of random halls are recorded. If you
// change plans on purpose, record them again, from the message of this test.

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/plan/planner.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kSide = 24;
constexpr std::size_t kRobots = 20;
constexpr std::uint64_t kHalls = 40;

/// Places of which no two are near each other.
std::vector<Position> places(Random& random) {
  std::vector<Position> cells;
  for (int x = 1; x < kSide - 1; x += 2) {
    for (int y = 1; y < kSide - 1; y += 2) cells.emplace_back(x + 0.5, y + 0.5);
  }
  random.shuffle(cells);
  cells.resize(kRobots);
  for (Position& place : cells) {
    place.x() += 0.6 * random.unit() - 0.3;
    place.y() += 0.6 * random.unit() - 0.3;
  }
  return cells;
}

Problem hall(std::uint64_t seed) {
  Random random(seed);
  OccupancyGrid grid(kSide, kSide, 1.0);
  const std::vector<Position> starts = places(random);
  const std::vector<Position> goals = places(random);
  std::vector<Robot> robots(kRobots);
  for (std::size_t k = 0; k < kRobots; ++k) {
    robots[k].radius = 0.3;
    robots[k].linear_speed = 1.0;
    robots[k].angular_speed = 3.0;
    robots[k].start = {starts[k], 0.0};
    robots[k].goal = Goal{goals[k], std::nullopt};
  }
  auto made = Problem::create(grid, robots, StopCondition::never());
  return std::get<Problem>(made);
}

class Digest {
 public:
  void add(double x) { value_ = (value_ ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211u; }
  void add(const Pose& pose) {
    add(pose.position.x());
    add(pose.position.y());
    add(pose.theta);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

std::uint64_t digest_of(const PlanOptions& options) {
  Digest digest;
  for (std::uint64_t seed = 0; seed < kHalls; ++seed) {
    const Plan made = plan(hall(seed), options, StopCondition::never());
    EXPECT_TRUE(made.deterministic);
    EXPECT_TRUE(made.unplanned.empty());
    for (const RobotPlan& robot : made.plans) {
      digest.add(robot.cost);
      for (const Action& action : robot.actions) {
        digest.add(action.t_end);
        digest.add(action.to);
      }
    }
  }
  return digest.value();
}

TEST(RecordedPlans, OfFirstSolutions) { EXPECT_EQ(digest_of({}), 17189994472380669670u); }

TEST(RecordedPlans, OfImprovedSolutions) {
  PlanOptions options;
  options.mode = PlanOptions::Mode::anytime;
  options.max_iterations = 20;
  EXPECT_EQ(digest_of(options), 7208109027361928303u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
