// Robots that end each other's commitments again and again, each time by less: that takes few steps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/advance/advance.h"
#include "core/advance/pieces.h"
#include "core/geometry/speed_profile.h"
#include "core/geometry/tolerance.h"
#include "core/model/action.h"
#include "tests/core/advance/driving_fleet.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using Type = Action::Type;

/// Looks at the clock that a moment of a few robots takes at most; nearly all take less than one.
constexpr std::int64_t kLooks = 20;

/// A moment of a fleet.
struct Advanced {
  std::vector<Robot> robots;
  std::vector<Collision> collisions;
  bool ended;  // by itself, and not by the limit of its steps
};

Advanced advanced_in_few_steps(const DrivingFleet& fleet, const Moment& moment) {
  support::StepLimit limit(kLooks);
  Work work(Work::Bounds{.early_end = &limit});
  Motions motions{braking_of(fleet.robots, fleet.executions, moment, work)};
  std::vector<Robot> robots = advanced(fleet.robots, fleet.executions, moment, motions, work);
  std::vector<Collision> collisions = collisions_of_commitments(robots, motions.braking, work).listed;
  return {std::move(robots), std::move(collisions), !work.met()};
}

/// A robot that waits, drives from one place to another at this speed, and waits again, to rest.
void add_driving(DrivingFleet& fleet, Robot robot, double wait, const Position& to, double speed,
                 double wait_after = 0.0) {
  const Position path = to - robot.start.position;
  robot.start.theta = std::atan2(path.y(), path.x());
  robot.linear_speed = speed;
  robot.goal = Goal{to, std::nullopt};
  const Pose end{to, robot.start.theta};
  std::vector<Action> actions;
  if (wait > 0.0) actions.push_back({Type::wait, 0.0, wait, robot.start, robot.start});
  Action drive{Type::translate, wait, wait + path.norm() / speed, robot.start, end};
  if (robot.linear_inertia().is_limited) {
    drive.profile = fastest_profile(path.norm(), speed, robot.linear_inertia());
    drive.t_end = wait + duration(*drive.profile, path.norm());
  }
  actions.push_back(drive);
  if (wait_after > 0.0) actions.push_back({Type::wait, drive.t_end, drive.t_end + wait_after, end, end});
  fleet.add(robot, std::move(actions));
}

/// What robots are committed to does not overlap, unless they do at the moment or cannot stop.
void expect_apart(const Advanced& next) {
  for (std::size_t i = 0; i < next.robots.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto is_pair = [&](const Collision& collision) {
        return collision.first == k && collision.second == i;
      };
      if (std::any_of(next.collisions.begin(), next.collisions.end(), is_pair)) continue;
      for (const Piece& mine : committed_pieces(next.robots[i])) {
        for (const Piece& theirs : committed_pieces(next.robots[k])) {
          const double distance = next.robots[i].radius + next.robots[k].radius - kContactTolerance;
          EXPECT_FALSE(first_overlap(mine, theirs, distance)) << k << " and " << i;
        }
      }
    }
  }
}

/// The commitment is the begin of the previous plan, which POST /v1/plan accepts: it has no gap.
void expect_prefix(const Robot& robot) {
  if (!robot.previous) return;
  double now = 0.0;
  for (const Action& action : *robot.previous) {
    EXPECT_NEAR(action.t_start, now, kContactTolerance);
    now = action.t_end;
  }
  ASSERT_LE(robot.committed.size(), robot.previous->size());
  for (std::size_t k = 0; k < robot.committed.size(); ++k) {
    const Action& planned = robot.previous->at(k);
    EXPECT_EQ(robot.committed[k].type, planned.type);
    EXPECT_NEAR(robot.committed[k].t_end, planned.t_end, 1e-9);
    EXPECT_NEAR((robot.committed[k].to.position - planned.to.position).norm(), 0.0, 1e-9);
  }
}

/// A slow robot drives towards a robot that stands, so far that less than an action is too much.
TEST(MutualEnds, ACommitmentThatIsTooLongByLessThanAnActionStays) {
  for (const double wait_after : {0.0, 1.0}) {
    SCOPED_TRACE(wait_after);
    constexpr double kTooFar = 1.05e-8;  // metres: by 5e-10 more than disks may overlap
    DrivingFleet fleet;
    const Pose stay = at_x(3.0);
    fleet.add(robot_at(stay), {{Type::wait, 0.0, 100.0, stay, stay}});
    add_driving(fleet, robot_at(at_x(2.0)), 0.0, at_x(2.5 + kTooFar).position, 0.1, wait_after);
    const Advanced next = advanced_in_few_steps(fleet, moment(0.0, 100.0));
    EXPECT_TRUE(next.ended);
    ASSERT_EQ(next.robots[1].committed.size(), 1U);
    EXPECT_DOUBLE_EQ(next.robots[1].committed_until(), 5.0 + 10.0 * kTooFar);
    EXPECT_TRUE(next.robots[1].previous);
    expect_prefix(next.robots[1]);
  }
}

/// The robot ahead speeds up, but the robot behind comes faster. Both stop where the robot behind touches.
/// Then the robot ahead has been slower until then, so that the robot behind has to stop earlier, and so on.
TEST(MutualEnds, OneThatSpeedsUpAheadStopsWithTheOneBehind) {
  for (int apart = 25; apart <= 35; ++apart) {
    SCOPED_TRACE(apart);
    DrivingFleet fleet;
    Robot ahead = robot_at(at_x(2.0));
    ahead.linear_acceleration = ahead.linear_deceleration = 0.5;
    add_driving(fleet, ahead, 0.5, at_x(4.0).position, 1.0);
    add_driving(fleet, robot_at(at_x(1.5 - 0.01 * apart)), 0.0, at_x(3.0).position, 0.4);
    const Advanced next = advanced_in_few_steps(fleet, moment(0.0, 2.0));
    ASSERT_TRUE(next.ended);
    expect_apart(next);
    const Robot& first = next.robots[0];
    const Robot& second = next.robots[1];
    expect_prefix(first);
    expect_prefix(second);
    EXPECT_GT(second.committed_until(), 0.01 * apart / 0.4);  // it goes on to where the other one was
    EXPECT_NEAR(first.committed_until(), second.committed_until(), 1e-7);
    EXPECT_NEAR(first.committed_end().position.x() - second.committed_end().position.x(), 0.5, 1e-6);
  }
}

/// Robots that drive along one line or across it, in any order, at speeds over a factor of a hundred. Some of
/// them need time to start and to stop.
DrivingFleet random_fleet(Dice& dice) {
  DrivingFleet fleet;
  if (dice.chance(0.3)) fleet.inflation = dice.between(0.0, 0.1);
  const bool in_line = dice.chance(0.6);
  double x = 0.0;
  for (int count = 2 + dice.below(4); count > 0; --count) {
    Robot robot = robot_at({{x, in_line ? 0.0 : dice.between(-0.5, 0.5)}, 0.0}, dice.between(0.1, 0.3));
    robot.id = std::to_string(count);
    if (dice.chance(0.6)) robot.linear_acceleration = std::pow(10.0, dice.between(-1.5, 0.5));
    robot.linear_deceleration = robot.linear_acceleration;
    if (robot.linear_inertia().is_limited && dice.chance(0.5))
      robot.linear_deceleration = std::pow(10.0, dice.between(-1.5, 0.5));
    const double direction = dice.chance(0.8) ? 1.0 : -1.0;
    const Position to(x + direction * dice.between(0.1, 3.0), in_line ? 0.0 : dice.between(-1.0, 1.0));
    const double wait = dice.chance(0.7) ? dice.between(0.0, 3.0) : 0.0;
    add_driving(fleet, robot, wait, to, std::pow(10.0, dice.between(-2.0, 0.0)));
    if (!robot.linear_inertia().is_limited && dice.chance(0.2))
      fleet.executions.back().stop_distance = dice.between(0.0, 0.3);
    x += 0.6 + (dice.chance(0.5) ? dice.between(0.0, 0.5) : 0.0);
  }
  return fleet;
}

TEST(MutualEnds, TakeFewStepsInRandomFleets) {
  constexpr std::uint64_t kSeeds = 3000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    const DrivingFleet fleet = random_fleet(dice);
    Moment then = moment(dice.chance(0.5) ? 0.0 : dice.between(0.0, 3.0), dice.between(0.0, 6.0));
    then.inflation = fleet.inflation;
    const Advanced next = advanced_in_few_steps(fleet, then);
    ASSERT_TRUE(next.ended);
    expect_apart(next);
    for (const Robot& robot : next.robots) expect_prefix(robot);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
