#include "core/sipp/timed_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::box;
using support::expect_safe;
using support::robot_at;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;
/// Seconds: far above rounding.
constexpr double kTime = 1e-6;

OccupancyGrid hall() { return {9, 5, 1.0}; }

/// The last of these goals is Robot::goal.
Robot with_goals(Robot robot, std::vector<Goal> goals) {
  robot.goal = goals.back();
  goals.pop_back();
  robot.via = std::move(goals);
  return robot;
}

Robot reversing(Robot robot) {
  robot.may_reverse = true;
  return robot;
}

Robot with_acceleration(Robot robot, double acceleration) {
  robot.linear_acceleration = acceleration;
  robot.linear_deceleration = acceleration;
  robot.angular_acceleration = 2.0;
  return robot;
}

Problem with_zone(OccupancyGrid grid, Robot robot, Zone zone) {
  ProblemConditions conditions;
  conditions.zones = {std::move(zone)};
  return support::make_problem(std::move(grid), {std::move(robot)}, std::move(conditions));
}

/// Plans all robots, one after the other.
void plan_all(Planning& p) {
  for (const std::size_t robot : p.movers()) {
    const SearchResult result = p.state.plan(robot, kExact, p.never);
    ASSERT_TRUE(result.trajectory) << "robot " << robot;
    p.reservations.follow(robot, *result.trajectory);
  }
}

void expect_same_visits(const std::vector<Visit>& visits, const std::vector<Visit>& expected) {
  ASSERT_EQ(visits.size(), expected.size());
  for (std::size_t k = 0; k < visits.size(); ++k) {
    EXPECT_EQ(visits[k].goal, expected[k].goal);
    EXPECT_NEAR(visits[k].t_arrive, expected[k].t_arrive, kTime);
    EXPECT_NEAR(visits[k].t_leave, expected[k].t_leave, kTime);
  }
}

/// Expects that the robot can follow its path no later than it does, past all others, and lets it. Returns
/// the number of stops.
std::size_t follow_again(Planning& p, std::size_t robot) {
  SCOPED_TRACE(testing::Message() << "robot " << robot);
  const Trajectory before = *p.reservations.trajectory(robot);
  p.reservations.remove(robot);
  TimedPath path(p.instance, p.reservations.table(), robot, StopCondition::never());
  if (!path.follow(before)) {
    ADD_FAILURE() << "the path is refused";
    return 0;
  }
  EXPECT_LE(path.trajectory().cost, before.cost + kTime);
  EXPECT_EQ(path.trajectory().start, before.start);
  EXPECT_EQ(path.trajectory().end(), before.end());
  EXPECT_THAT(p.reservations.conflicting_robots(robot, path.trajectory()), IsEmpty());
  p.reservations.follow(robot, path.trajectory());
  return path.stop_count();
}

/// Plans all robots, and expects that each follows its path again.
void expect_all_followed(Planning& p) {
  plan_all(p);
  for (const std::size_t robot : p.movers()) follow_again(p, robot);
  expect_safe(p.reservations);
}

TEST(TimedPath, TakesThePathsThatSearchesFind) {
  Planning p(support::ascii_map({"............",  //
                                 "....##......",  //
                                 "....##..##..",  //
                                 "............",  //
                                 "..##....##..",  //
                                 "..##........",  //
                                 "............"}),
             {robot_at(0.5, 0.5).to(11.5, 6.5), robot_at(11.5, 6.5).to(0.5, 0.5),
              robot_at(0.5, 6.5).to(11.5, 0.5), robot_at(11.5, 0.5).to(0.5, 6.5),
              robot_at(6.5, 0.5).to(6.5, 6.5, kPi), robot_at(7.5, 6.5).to(5.5, 0.5)});
  expect_all_followed(p);
}

TEST(TimedPath, TakesPathsAmongManyRobots) {
  int followed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(seed);
    PlanOptions options;
    if (dice.chance(0.3)) options.interval_margin = dice.between(0.0, 1.0);
    if (dice.chance(0.3)) options.wait_before_move = dice.between(0.0, 1.0);
    Planning p(support::random_problem(dice, 8), options);
    for (std::size_t i = 0; i < p.instance.size(); ++i) p.reservations.stay_in_place(i);
    for (const std::size_t robot : p.movers()) {
      p.reservations.remove(robot);
      const SearchResult result = p.state.plan(robot, {}, p.never);
      if (!result.trajectory) {
        p.reservations.stay_in_place(robot);
      } else {
        p.reservations.follow(robot, *result.trajectory);
      }
    }
    for (const std::size_t robot : p.movers()) {
      const auto& trajectory = p.reservations.trajectory(robot);
      if (!trajectory || trajectory->moves.empty()) continue;
      follow_again(p, robot);
      ++followed;
    }
  }
  EXPECT_GT(followed, 100);
}

TEST(TimedPath, PassesDirectlyBehindOthers) {
  Planning p(support::ascii_map({"####.####",  //
                                 "####.####",  //
                                 ".........",  //
                                 "####.####",  //
                                 "####.####"}),
             {robot_at(4.5, 0.5, kPi / 2).to(4.5, 4.5), robot_at(2.5, 2.5).to(8.5, 2.5)});
  expect_all_followed(p);
  EXPECT_GT(p.reservations.trajectory(1)->cost, 6.5) << "robot 1 waits for robot 0";
}

TEST(TimedPath, PassesDirectlyBeforeOthers) {
  Planning p(OccupancyGrid(9, 1, 1.0), {robot_at(2.5, 0.5).to(8.5, 0.5), robot_at(0.5, 0.5).to(7.5, 0.5)});
  plan_all(p);
  // Robot 1 follows so closely that they touch all the time.
  p.reservations.follow(1, through({{0.5, 0.5}, {1.7, 0.5}, {7.5, 0.5}}));
  const double before = p.reservations.trajectory(0)->cost;
  follow_again(p, 0);
  EXPECT_NEAR(p.reservations.trajectory(0)->cost, before, kTime);
}

TEST(TimedPath, ServesTheSameGoals) {
  Planning p(OccupancyGrid(10, 10, 1.0), {with_goals(robot_at(1.5, 1.5), {{{6.5, 1.5}, kPi / 2, 3.0},
                                                                          {{6.5, 1.5}, kPi, 1.0},
                                                                          {{6.5, 4.5}, {}, 2.0, 20.0},
                                                                          {{6.5, 6.5}, {}},
                                                                          {{2.13, 4.71}, -kPi / 2, 4.0}})});
  plan_all(p);
  const Trajectory before = *p.reservations.trajectory(0);
  EXPECT_EQ(follow_again(p, 0), 5U) << "two goals in one place";
  const Trajectory& trajectory = *p.reservations.trajectory(0);
  EXPECT_NEAR(trajectory.cost, before.cost, kTime);
  expect_same_visits(trajectory.visits, before.visits);
  expect_safe(p.reservations);
}

TEST(TimedPath, ServesTheLastGoalNotBeforeItsTime) {
  Robot robot = robot_at(0.5, 2.5).to(8.5, 2.5);
  robot.goal->service = 2.0;
  robot.goal->not_before = 30.0;
  Planning p(hall(), {robot});
  plan_all(p);
  follow_again(p, 0);
  EXPECT_EQ(p.reservations.trajectory(0)->cost, 32.0);
}

TEST(TimedPath, KeepsGoalsOnStraightWays) {
  Planning p(OccupancyGrid(10, 3, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{4.5, 1.5}, {}}, {{8.5, 1.5}, {}}})});
  plan_all(p);
  EXPECT_EQ(follow_again(p, 0), 3U);
  ASSERT_EQ(p.reservations.trajectory(0)->visits.size(), 1U);
  EXPECT_NEAR(p.reservations.trajectory(0)->visits[0].t_arrive, 3.0, kTime);
}

TEST(TimedPath, DrivesBackwardsWhereThePathDoes) {
  Planning p(support::ascii_map({"##########",  //
                                 "..........",  //
                                 "##########"}),
             {reversing(with_goals(robot_at(8.5, 1.5), {{{3.5, 1.5}, {}, 1.0}, {{6.5, 1.5}, {}}}))});
  plan_all(p);
  const Trajectory before = *p.reservations.trajectory(0);
  follow_again(p, 0);
  const Trajectory& trajectory = *p.reservations.trajectory(0);
  ASSERT_EQ(trajectory.moves.size(), 2U);
  EXPECT_TRUE(trajectory.moves[0].reverse);
  EXPECT_FALSE(trajectory.moves[1].reverse);
  EXPECT_NEAR(trajectory.cost, 5.0 + 1.0 + 3.0, kTime);
  expect_same_visits(trajectory.visits, before.visits);
}

TEST(TimedPath, KeepsTheLimitsOfAcceleration) {
  Planning p(OccupancyGrid(12, 12, 1.0), {with_acceleration(robot_at(0.5, 0.5).to(11.5, 5.5), 0.5),
                                          with_acceleration(robot_at(11.5, 0.5, kPi).to(0.5, 5.5), 0.25),
                                          with_acceleration(robot_at(5.5, 0.5, kPi / 2).to(5.5, 11.5), 1.0)});
  expect_all_followed(p);
  for (const std::size_t robot : p.movers()) {
    for (const TimedMove& move : p.reservations.trajectory(robot)->moves) EXPECT_TRUE(move.profile);
  }
}

TEST(TimedPath, IsSlowerInSpeedZones) {
  for (const bool accelerates : {false, true}) {
    Robot robot = robot_at(0.5, 2.5).to(8.5, 2.5);
    if (accelerates) robot = with_acceleration(robot, 1.0);
    Zone slow = box(Zone::Type::speed, {3.0, 0.0}, {5.0, 5.0});
    slow.linear_speed = 0.5;
    Planning p(with_zone(hall(), robot, slow));
    plan_all(p);
    const double before = p.reservations.trajectory(0)->cost;
    EXPECT_EQ(follow_again(p, 0), 2U) << "it does not stop where its speed changes";
    EXPECT_EQ(p.reservations.trajectory(0)->moves.size(), 3U);
    EXPECT_NEAR(p.reservations.trajectory(0)->cost, before, kTime);
    EXPECT_GT(before, 10.0 - kTime);
    expect_safe(p.reservations);
  }
}

TEST(TimedPath, BeginsWithTheCommittedActions) {
  Planning p(OccupancyGrid(10, 5, 1.0),
             {robot_at(0.5, 0.5).drives(2.5, 1.1).waits(4.0).to(8.5, 4.5), robot_at(4.5, 0.5).to(4.5, 4.5)});
  expect_all_followed(p);
  const Trajectory& trajectory = *p.reservations.trajectory(0);
  EXPECT_EQ(trajectory.start, Position(0.5, 0.5));
  EXPECT_EQ(trajectory.moves[0].path.to, Position(2.5, 1.1));
  EXPECT_GE(trajectory.moves[1].t_start, 4.0);
}

TEST(TimedPath, NumbersGoalsAfterThoseThatAreCommitted) {
  Robot robot = with_goals(robot_at(0.5, 2.5).drives(2.5, 2.5),
                           {{{2.5, 2.5}, {}}, {{4.5, 2.5}, {}, 1.0}, {{8.5, 2.5}, {}}});
  Planning p(hall(), {robot});
  plan_all(p);
  follow_again(p, 0);
  ASSERT_EQ(p.reservations.trajectory(0)->visits.size(), 1U);
  EXPECT_EQ(p.reservations.trajectory(0)->visits[0].goal, 1U);
  expect_safe(p.reservations);
}

TEST(TimedPath, ShortensWaits) {
  Planning p(hall(), {robot_at(0.5, 2.5).to(8.5, 2.5)});
  p.reservations.follow(0, through({{0.5, 2.5}, {8.5, 2.5}}, 7.0));
  follow_again(p, 0);
  EXPECT_NEAR(p.reservations.trajectory(0)->cost, 8.0, kTime);
}

/// Whether the trajectory of robot 0 is taken, as a search finds it.
bool takes_first(Planning& p) {
  const SearchResult result = p.state.plan(0, {}, p.never);
  EXPECT_TRUE(result.trajectory);
  return TimedPath(p.instance, p.reservations.table(), 0, StopCondition::never())
      .follow(result.trajectory.value_or(Trajectory()));
}

TEST(TimedPath, RefusesRobotsThatChangeTheirLoad) {
  Robot robot = with_goals(robot_at(0.5, 2.5), {{{4.5, 2.5}, {}}, {{7.5, 2.5}, {}}});
  Planning same(hall(), {robot});
  EXPECT_TRUE(takes_first(same));
  robot.via[0].radius_after = 0.3;
  Planning smaller(hall(), {robot});
  EXPECT_FALSE(takes_first(smaller));
  robot.via[0].radius_after.reset();
  robot.goal->radius_after = 0.3;
  Planning smaller_at_last(hall(), {robot});
  EXPECT_FALSE(takes_first(smaller_at_last));
  robot.goal->radius_after.reset();
  robot.via[0].linear_speed_after = 0.5;
  Planning slower(hall(), {robot});
  EXPECT_FALSE(takes_first(slower));
}

TEST(TimedPath, RefusesPlansUpToAHorizon) {
  PlanOptions options;
  options.horizon = 100.0;  // after the end
  Planning p(hall(), {robot_at(0.5, 2.5).to(8.5, 2.5)}, options);
  EXPECT_FALSE(takes_first(p));
  Planning whole(hall(), {robot_at(0.5, 2.5).to(8.5, 2.5)});
  Trajectory cut = through({{0.5, 2.5}, {8.5, 2.5}});
  cut.stops_at = 8.0;
  EXPECT_FALSE(TimedPath(whole.instance, whole.reservations.table(), 0, StopCondition::never()).follow(cut));
}

TEST(TimedPath, RefusesRobotsThatStay) {
  Planning p(hall(), {robot_at(0.5, 2.5).to(0.5, 2.5), robot_at(4.5, 2.5)});
  EXPECT_FALSE(takes_first(p));
  EXPECT_FALSE(
      TimedPath(p.instance, p.reservations.table(), 1, StopCondition::never()).follow({{4.5, 2.5}, {}}));
}

TEST(TimedPath, RefusesRobotsThatOnlyTurn) {
  Planning p(hall(), {robot_at(0.5, 2.5).to(0.5, 2.5, kPi)});
  EXPECT_FALSE(takes_first(p));
}

TEST(TimedPath, RefusesGoalsThatAreServedAtTheStart) {
  Planning p(hall(), {with_goals(robot_at(0.5, 2.5), {{{0.5, 2.5}, {}, 2.0}, {{8.5, 2.5}, {}}})});
  EXPECT_FALSE(takes_first(p));
}

TEST(TimedPath, RefusesRobotsThatYield) {
  Robot robot = robot_at(0.5, 2.5).to(8.5, 2.5);
  robot.let_yield();
  Planning p(hall(), {robot});
  EXPECT_FALSE(takes_first(p));
}

TEST(TimedPath, RefusesAPathThatOthersMakeSlower) {
  Planning p(hall(), {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 0.5).to(4.5, 4.5)});
  const Trajectory alone = through({{0.5, 2.5}, {8.5, 2.5}});
  TimedPath path(p.instance, p.reservations.table(), 0, StopCondition::never());
  EXPECT_TRUE(path.follow(alone));
  p.reservations.follow(1, through({{4.5, 0.5}, {4.5, 4.5}}, 2.0));
  EXPECT_FALSE(path.follow(alone));
}

TEST(TimedPath, RefusesAPathThatBeginsOrEndsElsewhere) {
  Planning p(hall(), {robot_at(0.5, 2.5).to(8.5, 2.5)});
  TimedPath path(p.instance, p.reservations.table(), 0, StopCondition::never());
  EXPECT_FALSE(path.follow(through({{1.5, 2.5}, {8.5, 2.5}})));
  EXPECT_FALSE(path.follow(through({{0.5, 2.5}, {7.5, 2.5}})));
}

/// A path of robot 0 through these points; its goal is the last of them.
struct Bent : Planning {
  Bent(OccupancyGrid grid, const std::vector<Position>& points, std::vector<Robot> others = {})
      : Bent(problem_of(std::move(grid), points, std::move(others)), points) {}
  Bent(Problem given, const std::vector<Position>& points)
      : Planning(std::move(given)), path(instance, reservations.table(), 0, StopCondition::never()) {
    follow(points);
  }

  /// Reserves the trajectory of another robot, and times the path again.
  void reserve(std::size_t other, Trajectory trajectory) {
    reservations.follow(other, std::move(trajectory));
    follow(stops());
  }

  bool replace(std::size_t first, std::size_t count, const std::optional<Position>& by = {},
               double bound = kForever) {
    return path.replace(first, count, by, bound, [](const Trajectory&) { return true; });
  }
  double cost() const { return path.trajectory().cost; }
  std::vector<Position> stops() const {
    std::vector<Position> stops;
    for (std::size_t k = 0; k < path.stop_count(); ++k) stops.push_back(path.position(k));
    return stops;
  }
  /// Expects that the trajectory passes all others, and through the stops.
  void expect_safe_path() {
    std::vector<Position> ends{path.trajectory().start};
    for (const TimedMove& move : path.trajectory().moves) ends.push_back(move.path.to);
    EXPECT_EQ(ends, stops());
    EXPECT_THAT(reservations.conflicting_robots(0, path.trajectory()), IsEmpty());
    reservations.follow(0, path.trajectory());
    expect_safe(reservations);
    reservations.remove(0);
  }

  TimedPath path;

 private:
  void follow(const std::vector<Position>& points) {
    Trajectory slow = through(points);
    slow.cost = 1000.0;  // with time to turn, and for others
    EXPECT_TRUE(path.follow(slow));
  }
  static Problem problem_of(OccupancyGrid grid, const std::vector<Position>& points,
                            std::vector<Robot> others) {
    const Robot robot =
        robot_at(points.front().x(), points.front().y()).to(points.back().x(), points.back().y());
    others.insert(others.begin(), robot);
    return support::make_problem(std::move(grid), std::move(others));
  }
};

const std::vector<Position> kBend{{0.5, 2.5}, {4.5, 4.5}, {8.5, 2.5}};

TEST(TimedPath, BecomesShorterWithoutABend) {
  Bent p(hall(), kBend);
  EXPECT_GT(p.cost(), 8.9);
  EXPECT_TRUE(p.replace(1, 1));
  EXPECT_THAT(p.stops(), ElementsAre(Position(0.5, 2.5), Position(8.5, 2.5)));
  EXPECT_NEAR(p.cost(), 8.0, kTime);
  p.expect_safe_path();
}

TEST(TimedPath, KeepsABendBetweenStopsInTheSamePlace) {
  Bent p(hall(), {{0.5, 2.5}, {4.5, 2.5}, {4.5, 4.5}, {4.5, 2.5}, {8.5, 2.5}});
  EXPECT_FALSE(p.replace(2, 1));
  EXPECT_TRUE(p.replace(2, 2));
  EXPECT_THAT(p.stops(), ElementsAre(Position(0.5, 2.5), Position(4.5, 2.5), Position(8.5, 2.5)));
  p.expect_safe_path();
}

TEST(TimedPath, MovesABend) {
  Bent p(hall(), kBend);
  EXPECT_TRUE(p.replace(1, 1, Position(4.3, 3.1)));
  EXPECT_THAT(p.stops(), ElementsAre(Position(0.5, 2.5), Position(4.3, 3.1), Position(8.5, 2.5)));
  EXPECT_LT(p.cost(), 8.7);
  p.expect_safe_path();
}

TEST(TimedPath, InsertsABend) {
  Bent p(hall(), {{0.5, 2.5}, {8.5, 2.5}});
  EXPECT_TRUE(p.replace(1, 0, Position(4.5, 4.0)));
  EXPECT_THAT(p.stops(), ElementsAre(Position(0.5, 2.5), Position(4.5, 4.0), Position(8.5, 2.5)));
  EXPECT_GT(p.cost(), 8.5);
  p.expect_safe_path();
}

TEST(TimedPath, ReplacesSeveralBendsByOne) {
  Bent p(hall(), {{0.5, 2.5}, {2.5, 4.5}, {4.5, 0.5}, {6.5, 4.5}, {8.5, 2.5}});
  EXPECT_TRUE(p.replace(1, 3, Position(4.5, 3.5)));
  EXPECT_THAT(p.stops(), ElementsAre(Position(0.5, 2.5), Position(4.5, 3.5), Position(8.5, 2.5)));
  p.expect_safe_path();
}

TEST(TimedPath, CountsThePathsThatAreTimed) {
  Bent p(hall(), kBend);
  EXPECT_EQ(p.path.timed(), 1);
  p.replace(1, 1, {}, 5.0);
  EXPECT_EQ(p.path.timed(), 1) << "it cannot be so short";
  p.replace(1, 1);
  EXPECT_EQ(p.path.timed(), 2);
}

/// Expects that a change is refused and nothing has changed.
void expect_refused(Bent& p, std::size_t first, std::size_t count, const std::optional<Position>& by,
                    double bound = kForever) {
  const std::vector<Position> stops = p.stops();
  const double cost = p.cost();
  EXPECT_FALSE(p.replace(first, count, by, bound));
  EXPECT_EQ(p.stops(), stops);
  EXPECT_EQ(p.cost(), cost);
  p.expect_safe_path();
}

TEST(TimedPath, DoesNotLeadThroughWalls) {
  Bent p(support::ascii_map({".........",  //
                             "....#....",  //
                             "....#....",  //
                             "........."}),
         {{0.5, 1.5}, {3.5, 3.5}, {5.5, 3.5}, {8.5, 1.5}});
  expect_refused(p, 1, 2, {});
  expect_refused(p, 1, 1, {});
  expect_refused(p, 1, 1, Position(3.5, 2.5));
  expect_refused(p, 1, 1, Position(3.8, 3.3));
  EXPECT_TRUE(p.replace(1, 1, Position(3.4, 3.45))) << "just past the corner";
  p.expect_safe_path();
}

TEST(TimedPath, StaysOnTheMap) {
  Bent p(hall(), kBend);
  expect_refused(p, 1, 1, Position(4.5, 4.7));
  EXPECT_TRUE(p.replace(1, 1, Position(4.5, 4.6)));
}

TEST(TimedPath, DoesNotLeadAgainstOneWayZones) {
  Zone one_way = box(Zone::Type::one_way, {3.0, -1.0}, {6.0, 3.0});
  one_way.heading = kPi;
  one_way.half_angle = 0.5;
  Bent p(with_zone(hall(), robot_at(0.5, 2.5).to(8.5, 2.5), one_way), kBend);
  expect_refused(p, 1, 1, {});
  one_way.heading = 0.0;
  Bent along(with_zone(hall(), robot_at(0.5, 2.5).to(8.5, 2.5), one_way), kBend);
  EXPECT_TRUE(along.replace(1, 1));
}

TEST(TimedPath, CostsLessThanTheBound) {
  Bent p(hall(), kBend);
  expect_refused(p, 1, 1, {}, 7.999);
  EXPECT_TRUE(p.replace(1, 1, {}, 8.001));
  Bent late(hall(), kBend, {robot_at(6.5, 0.5, kPi / 2).to(6.5, 4.5)});
  late.reserve(1, through({{6.5, 0.5}, {6.5, 4.5}}, 4.0));
  expect_refused(late, 1, 1, {}, 9.0);
  EXPECT_TRUE(late.replace(1, 1, {}, 9.3)) << "when robot 1 has passed";
  late.expect_safe_path();
}

TEST(TimedPath, SatisfiesTheCaller) {
  Bent p(hall(), kBend);
  const double cost = p.cost();
  std::vector<double> asked;
  const auto refuse = [&](const Trajectory& tried) {
    asked.push_back(tried.cost);
    return false;
  };
  EXPECT_FALSE(p.path.replace(1, 1, std::nullopt, kForever, refuse));
  EXPECT_THAT(asked, ElementsAre(testing::DoubleNear(8.0, kTime)));
  EXPECT_EQ(p.cost(), cost);
  EXPECT_EQ(p.stops(), kBend);
}

TEST(TimedPath, DoesNotStopTwiceInOnePlace) {
  Bent p(hall(), kBend);
  expect_refused(p, 1, 0, Position(0.5, 2.5));
  expect_refused(p, 1, 0, Position(4.5, 4.5));
  expect_refused(p, 1, 1, Position(8.5, 2.5));
}

TEST(TimedPath, DoesNotLeadThroughRobotsThatStay) {
  Bent free(hall(), kBend, {robot_at(4.5, 1.9)});
  EXPECT_TRUE(free.replace(1, 1)) << "without its reservation";
  Bent blocked(hall(), kBend, {robot_at(4.5, 1.9)});
  blocked.reservations.stay_in_place(1);
  expect_refused(blocked, 1, 1, {});
  EXPECT_TRUE(blocked.replace(1, 1, Position(4.5, 2.9)));
  blocked.expect_safe_path();
}

TEST(TimedPath, KeepsClearOfGoalsOfOthers) {
  const std::vector<Robot> others{robot_at(4.5, 0.5, kPi / 2).to(4.5, 2.0)};
  Bent before(hall(), kBend, others);
  before.reserve(1, through({{4.5, 0.5}, {4.5, 2.0}}, 20.0));
  EXPECT_TRUE(before.replace(1, 1)) << "robot 0 has passed by then";
  before.expect_safe_path();
  Bent after(hall(), kBend, others);
  after.reserve(1, through({{4.5, 0.5}, {4.5, 2.0}}));
  expect_refused(after, 1, 1, {});
}

TEST(TimedPath, ChangesNothingForNoSoonerEnd) {
  // Robot 1 stands on the last straight move for 20 s.
  Bent p(hall(), {{0.5, 2.5}, {1.5, 4.0}, {2.5, 2.5}, {8.5, 2.5}},
         {robot_at(6.5, 2.5, kPi / 2).to(6.5, 4.5)});
  EXPECT_TRUE(p.replace(1, 1, Position(1.5, 3.9)));
  p.reserve(1, through({{6.5, 2.5}, {6.5, 4.5}}, 20.0));
  EXPECT_GT(p.cost(), 20.0);
  expect_refused(p, 1, 1, Position(1.5, 3.8));
  EXPECT_TRUE(p.replace(2, 1, Position(2.6, 2.5))) << "from where it is sooner at its goal";
  p.expect_safe_path();
}

TEST(TimedPath, HasBendsBetweenItsGoals) {
  Planning p(OccupancyGrid(9, 9, 1.0),
             {with_goals(robot_at(0.5, 0.5), {{{6.5, 0.5}, {}}, {{8.5, 8.5}, {}}})});
  Trajectory trajectory = through({{0.5, 0.5}, {3.5, 1.5}, {6.5, 0.5}, {5.5, 4.5}, {8.5, 8.5}});
  trajectory.cost = 100.0;
  trajectory.visits = {{0, trajectory.moves[1].t_end, trajectory.moves[1].t_end}};
  TimedPath path(p.instance, p.reservations.table(), 0, StopCondition::never());
  ASSERT_TRUE(path.follow(trajectory));
  ASSERT_EQ(path.stop_count(), 5U);
  EXPECT_FALSE(path.is_bend(0)) << "the begin";
  EXPECT_TRUE(path.is_bend(1));
  EXPECT_FALSE(path.is_bend(2)) << "a goal";
  EXPECT_TRUE(path.is_bend(3));
  EXPECT_FALSE(path.is_bend(4)) << "the end";
  const auto any = [](const Trajectory&) { return true; };
  EXPECT_TRUE(path.replace(3, 1, std::nullopt, kForever, any));
  EXPECT_TRUE(path.replace(1, 1, std::nullopt, kForever, any));
  ASSERT_EQ(path.trajectory().visits.size(), 1U);
  EXPECT_NEAR(path.trajectory().visits[0].t_arrive, 6.0, kTime);
  p.reservations.follow(0, path.trajectory());
  expect_safe(p.reservations);
}

TEST(TimedPath, HasNoBendWhereARobotTurnsBack) {
  Planning p(OccupancyGrid(9, 9, 1.0), {reversing(robot_at(2.5, 2.5).to(8.5, 6.5))});
  Trajectory trajectory = through({{2.5, 2.5}, {1.5, 2.5}, {1.5, 4.5}, {4.5, 5.5}, {8.5, 6.5}});
  trajectory.moves[0].reverse = true;
  trajectory.moves[1].reverse = true;
  trajectory.cost = 100.0;
  TimedPath path(p.instance, p.reservations.table(), 0, StopCondition::never());
  ASSERT_TRUE(path.follow(trajectory));
  EXPECT_TRUE(path.is_bend(1)) << "backwards before and after";
  EXPECT_FALSE(path.is_bend(2));
  EXPECT_TRUE(path.is_bend(3));
  ASSERT_TRUE(path.replace(1, 1, Position(1.7, 2.7), kForever, [](const Trajectory&) { return true; }));
  EXPECT_TRUE(path.trajectory().moves[0].reverse);
  p.reservations.follow(0, path.trajectory());
  expect_safe(p.reservations);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
