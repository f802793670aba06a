#include "core/lns/smoothing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/model/objective_share.h"
#include "core/plan/collect_plan.h"
#include "tests/core/support/planning.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::exact_text;
using support::expect_safe;
using support::plans_of;
using support::robot_at;
using testing::IsEmpty;

constexpr double kUp = 1.5707963267948966;
constexpr int kTries = 400;

OccupancyGrid hall_with_block() {
  return support::ascii_map({"...........",  //
                             "...........",  //
                             "...........",  //
                             "...#####...",  //
                             "...#####...",  //
                             "...#####...",  //
                             "...#####..."});
}

PlanOptions with_objective(PlanOptions::Objective objective) {
  PlanOptions options;
  options.objective = objective;
  return options;
}

/// Robot 0 has to pass over a block, and follows the best path on the lattice.
struct Corners : Planning {
  explicit Corners(const PlanOptions& options = {}) : Corners({robot_at(0.5, 1.5).to(10.5, 1.5)}, options) {}
  explicit Corners(std::vector<Robot> robots, const PlanOptions& options = {})
      : Planning(hall_with_block(), std::move(robots), options) {
    for (std::size_t other = 1; other < instance.size(); ++other) reservations.stay_in_place(other);
    reservations.follow(0, *state.plan(0, kExact, never).trajectory);
  }

  const Trajectory& now() const { return *reservations.trajectory(0); }
  Smoothed smooth_with(std::uint64_t seed) {
    Random seeded(seed);
    return smooth(state, 0, now(), kTries, seeded, never);
  }
  /// Smooths robot 0 and expects that this is an improvement. Returns by how many seconds.
  double improve() {
    Smoothed smoothed = smooth_with(0);
    if (!smoothed.trajectory) {
      ADD_FAILURE() << "nothing is gained";
      return 0.0;
    }
    EXPECT_THAT(reservations.conflicting_robots(0, *smoothed.trajectory), IsEmpty());
    const double gain = now().cost - smoothed.trajectory->cost;
    reservations.follow(0, std::move(*smoothed.trajectory));
    expect_safe(reservations);
    return gain;
  }
  std::string text() const {
    Plan plan;
    plan.plans = plans_of(reservations);
    return exact_text(plan);
  }
  std::string text_of(const Trajectory& trajectory) const {
    Plan plan;
    plan.plans = {{0, trajectory.cost, to_actions(instance.problem().robots()[0], trajectory)}};
    return exact_text(plan);
  }
};

TEST(Smoothing, IsBetterThanAnyPathOnTheLattice) {
  Corners p;
  EXPECT_GT(p.improve(), 0.1);
}

TEST(Smoothing, TellsTheGain) {
  Corners p;
  EXPECT_EQ(p.now().smoothed_by, 0.0);
  const double first = p.improve();
  EXPECT_DOUBLE_EQ(p.now().smoothed_by, first);
  Random random(1);
  const Smoothed again = smooth(p.state, 0, p.now(), 20 * kTries, random, p.never);
  ASSERT_TRUE(again.trajectory);
  EXPECT_NEAR(again.trajectory->smoothed_by, first + p.now().cost - again.trajectory->cost, 1e-9);
}

TEST(Smoothing, OfOneSeedIsAlwaysTheSame) {
  Corners p;
  const Smoothed first = p.smooth_with(3);
  const Smoothed second = p.smooth_with(3);
  const Smoothed other = p.smooth_with(4);
  ASSERT_TRUE(first.trajectory && second.trajectory && other.trajectory);
  EXPECT_EQ(p.text_of(*first.trajectory), p.text_of(*second.trajectory));
  EXPECT_EQ(first.timed, second.timed);
  EXPECT_NE(p.text_of(*first.trajectory), p.text_of(*other.trajectory));
}

TEST(Smoothing, LeavesTheStateUnchanged) {
  Corners p({robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(0.5, 5.5)});
  const std::string before = p.text();
  EXPECT_TRUE(p.smooth_with(0).trajectory);
  EXPECT_EQ(p.text(), before);
  EXPECT_EQ(p.reservations.conflicting_robots(1, through({{0.5, 5.5}, {10.5, 1.5}})),
            std::vector<std::size_t>{0})
      << "reservations as well";
}

TEST(Smoothing, OfARobotWithoutAReservationPassesTheOthers) {
  Corners p({robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(5.5, 5.8)});
  const Trajectory trajectory = p.now();
  p.reservations.remove(0);
  Random random(0);
  const Smoothed smoothed = smooth(p.state, 0, trajectory, kTries, random, p.never);
  ASSERT_TRUE(smoothed.trajectory);
  p.reservations.follow(0, *smoothed.trajectory);
  expect_safe(p.reservations);
}

TEST(Smoothing, EndsWhenItIsStopped) {
  Corners p;
  Random random(0);
  const Smoothed smoothed = smooth(p.state, 0, p.now(), kTries, random, met());
  EXPECT_FALSE(smoothed.trajectory);
  EXPECT_EQ(smoothed.timed, 1);
  EXPECT_FALSE(smooth(p.state, 0, p.now(), 0, random, p.never).trajectory) << "no tries";
}

TEST(Smoothing, KeepsClearOfARobotThatIsParked) {
  Corners alone;
  alone.improve();
  // Just above the corner of the block, and robot 0 passes above it.
  Corners p({robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(3.0, 4.5)});
  p.improve();
  EXPECT_GT(p.now().cost, alone.now().cost + 0.5);
}

TEST(Smoothing, KeepsClearOfRobotsThatMove) {
  Corners p({robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(5.5, 6.5, -kUp).to(5.5, 4.4)});
  p.reservations.follow(1, through({{5.5, 6.5}, {5.5, 4.4}}, 14.0));
  p.reservations.remove(0);
  p.reservations.follow(0, *p.state.plan(0, kExact, p.never).trajectory);
  p.improve();
}

TEST(Smoothing, ShortensWaits) {
  Planning p(OccupancyGrid(9, 9, 1.0),
             {robot_at(0.5, 4.5).to(8.5, 4.5), robot_at(4.5, 0.5, kUp).to(4.5, 8.5)});
  p.reservations.follow(0, through({{0.5, 4.5}, {8.5, 4.5}}, 6.0));
  p.reservations.follow(1, through({{4.5, 0.5}, {4.5, 8.5}}, 1.0));
  Smoothed smoothed = smooth(p.state, 0, *p.reservations.trajectory(0), kTries, p.random, p.never);
  ASSERT_TRUE(smoothed.trajectory);
  EXPECT_LT(smoothed.trajectory->cost, 10.0);
  EXPECT_GT(smoothed.trajectory->cost, 8.0);
  p.reservations.follow(0, std::move(*smoothed.trajectory));
  expect_safe(p.reservations);
}

TEST(Smoothing, GainsNothingOnAStraightWay) {
  Planning p(OccupancyGrid(9, 5, 1.0), {robot_at(0.5, 2.5).to(8.5, 2.5)});
  p.reservations.follow(0, through({{0.5, 2.5}, {8.5, 2.5}}));
  const Smoothed smoothed = smooth(p.state, 0, *p.reservations.trajectory(0), kTries, p.random, p.never);
  EXPECT_FALSE(smoothed.trajectory);
}

TEST(Smoothing, LeavesPathsThatCannotBeTimed) {
  Robot robot = robot_at(0.5, 1.5).to(10.5, 1.5);
  robot.goal->radius_after = 0.2;
  Corners p({robot});
  const Smoothed smoothed = p.smooth_with(0);
  EXPECT_FALSE(smoothed.trajectory);
  EXPECT_EQ(smoothed.timed, 0);
}

/// Robot 0 is due at two goals, over the block.
Robot due_robot(double first_due, double last_due) {
  Robot robot = robot_at(0.5, 1.5).to(10.5, 1.5);
  robot.via = {{{5.5, 5.5}, {}, 1.0}};
  robot.via[0].due = first_due;
  robot.goal->due = last_due;
  robot.weight = 3.0;
  return robot;
}

TEST(Smoothing, MakesTheShareInTheTardinessLess) {
  using Objective = PlanOptions::Objective;
  for (const auto& [first_due, last_due] :
       std::vector<std::pair<double, double>>{{0.0, 0.0}, {0.0, 1000.0}, {1000.0, 0.0}, {1000.0, 1000.0}}) {
    SCOPED_TRACE(testing::Message() << "due at " << first_due << " and " << last_due);
    Corners p({due_robot(first_due, last_due)}, with_objective(Objective::tardiness));
    const Itinerary& itinerary = p.instance.itinerary(0);
    const Trajectory before = p.now();
    p.improve();
    EXPECT_LT(share_of(itinerary, Objective::tardiness, p.now()),
              share_of(itinerary, Objective::tardiness, before) - 1e-7);
    EXPECT_EQ(p.now().visits.size(), 1U);
  }
}

/// The robots are smoothed one after the other, which gains something or not.
double gained_briefly(Corners& p, const StopCondition& stop = StopCondition::never()) {
  const double before = p.now().cost;
  EXPECT_EQ(smooth_briefly(p.state, {0}, p.random, stop, p.progress), stop.met());
  return before - p.now().cost;
}

TEST(SmoothBriefly, ReplacesTrajectories) {
  Corners p;
  const double gain = gained_briefly(p);
  EXPECT_GT(gain, 0.05);
  EXPECT_DOUBLE_EQ(p.now().smoothed_by, gain);
  expect_safe(p.reservations);
  EXPECT_EQ(p.progress.counts()[static_cast<std::size_t>(Method::smoothing)].served, 1);
}

TEST(SmoothBriefly, SmoothsOneRobotAfterTheOther) {
  Planning p(hall_with_block(),
             {robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(10.5, 0.5, 2 * kUp).to(0.5, 2.5)});
  double before = 0.0;
  for (const std::size_t robot : p.movers()) {
    p.reservations.follow(robot, *p.state.plan(robot, kExact, p.never).trajectory);
    before += p.reservations.trajectory(robot)->cost;
  }
  EXPECT_FALSE(smooth_briefly(p.state, p.movers(), p.random, p.never, p.progress));
  double after = 0.0;
  for (const std::size_t robot : p.movers()) {
    EXPECT_GT(p.reservations.trajectory(robot)->smoothed_by, 0.0);
    after += p.reservations.trajectory(robot)->cost;
  }
  EXPECT_LT(after, before - 0.1);
  expect_safe(p.reservations);
}

TEST(SmoothBriefly, LeavesPreviousPlans) {
  Corners p;
  Trajectory previous = p.now();
  previous.is_previous = true;
  p.reservations.follow(0, previous);
  EXPECT_EQ(gained_briefly(p), 0.0);
  EXPECT_TRUE(p.now().is_previous);
}

TEST(SmoothBriefly, EndsWhenItIsStopped) {
  Corners p;
  EXPECT_EQ(gained_briefly(p, met()), 0.0);
}

TEST(SmoothBriefly, LeavesTheLatticeOnlyIfTheOptionsAllowIt) {
  PlanOptions options;
  EXPECT_TRUE(may_smooth(options));
  const auto expect_unchanged = [](const PlanOptions& given) {
    EXPECT_FALSE(may_smooth(given));
    Corners p(given);
    EXPECT_EQ(gained_briefly(p), 0.0);
  };
  options.smoothing = false;
  expect_unchanged(options);
  options = {};
  options.any_angle = false;
  expect_unchanged(options);
  options = {};
  options.horizon = 100.0;
  expect_unchanged(options);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
