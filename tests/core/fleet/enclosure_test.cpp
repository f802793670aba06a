#include "core/fleet/enclosure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Answer = Enclosure::Answer;
using Robots = std::vector<std::size_t>;

constexpr std::int64_t kMany = 1'000'000;

/// Two rooms, a doorway of a metre between them.
OccupancyGrid rooms() {
  return support::ascii_map({"....#....",  //
                             ".........",  //
                             "....#...."});
}

TEST(Enclosure, NamesTheRobotInTheDoorway) {
  const Planning p(rooms(), {robot_at(1, 1).to(8, 1), robot_at(4.5, 1.5), robot_at(7, 2)});
  const auto result = Enclosure(p.instance, 0, {1, 2}, p.never).find(kMany);
  EXPECT_EQ(result.answer, Answer::closed);
  EXPECT_EQ(result.robots, Robots{1});
}

TEST(Enclosure, NamesAllRobotsThatCloseTheWayOneAfterTheOther) {
  const Planning p(support::ascii_map({"....#.#....",  //
                                       "...........",  //
                                       "....#.#...."}),
                   {robot_at(1, 1).to(10, 1), robot_at(4.5, 1.5), robot_at(6.5, 1.5)});
  EXPECT_EQ(Enclosure(p.instance, 0, {1, 2}, p.never).find(kMany).robots, (Robots{1, 2}));
}

TEST(Enclosure, IsOpenWhereTheRobotFitsPastAnotherOne) {
  const Planning p(rooms(), {robot_at(1, 1).to(8, 1).radius(0.2), robot_at(4.5, 1.7).radius(0.25)});
  EXPECT_EQ(Enclosure(p.instance, 0, {1}, p.never).find(kMany).answer, Answer::open);
  EXPECT_EQ(Enclosure(p.instance, 0, {}, p.never).find(kMany).answer, Answer::open);
}

TEST(Enclosure, NamesNoRobotWhereObstaclesCloseTheWay) {
  const Planning p(rooms(), {robot_at(1, 1).to(8, 1).radius(0.6), robot_at(4.5, 1.5)});
  const auto result = Enclosure(p.instance, 0, {1}, p.never).find(kMany);
  EXPECT_EQ(result.answer, Answer::closed);
  EXPECT_EQ(result.robots, Robots{});
}

TEST(Enclosure, IsOpenForARobotInContactWithAnotherOneAndAWall) {
  const Planning p(rooms(), {robot_at(0.4, 0.4).to(8, 1), robot_at(1.2, 0.4), robot_at(0.4, 2.6)});
  EXPECT_EQ(Enclosure(p.instance, 0, {1, 2}, p.never).find(kMany).answer, Answer::open);
}

TEST(Enclosure, EndsAfterTheGivenSteps) {
  const Planning p(OccupancyGrid(400, 400, 1.0), {robot_at(1, 1).to(399, 399)});
  EXPECT_EQ(Enclosure(p.instance, 0, {}, p.never).find(1'000).answer, Answer::unknown);
}

/// Whoever looks at many disks near every border asks the stop condition sooner.
TEST(Enclosure, EndsWhenTheStopConditionIsMet) {
  std::vector<Robot> robots{robot_at(5, 5).to(115, 115)};
  Robots staying;
  for (int k = 0; k < 16 * 12; ++k) {  // with gaps of a metre
    robots.push_back(robot_at(4.0 + 7.0 * (k % 16), 20.0 + 7.0 * (k / 16)).radius(3.0));
    staying.push_back(robots.size() - 1);
  }
  const Planning p(OccupancyGrid(120, 120, 1.0), std::move(robots));
  const StopCondition met(StopCondition::Clock::time_point::min());
  EXPECT_EQ(Enclosure(p.instance, 0, {}, met).find(kMany).answer, Answer::open) << "little work";
  EXPECT_EQ(Enclosure(p.instance, 0, staying, met).find(kMany).answer, Answer::unknown);
  EXPECT_EQ(Enclosure(p.instance, 0, staying, p.never).find(kMany).answer, Answer::open);
}

/// Rooms with doorways of several widths: the narrowest place of the widest way is in the widest doorway.
TEST(Enclosure, FindsTheNarrowestPlaceOfTheWidestWay) {
  for (const double radius : {0.55, 0.8, 1.4}) {
    const Planning p(support::ascii_map({"............#......",  //
                                         "............#......",  //
                                         "...................",  // 1 m wide
                                         "............#......",  //
                                         "............#......",  //
                                         "............#......",  //
                                         "..................."}),
                     {robot_at(2, 4).to(16, 4).radius(radius)});
    std::int64_t left = kMany;
    const auto narrow = Enclosure(p.instance, 0, {}, p.never).narrowest_place(kMany, left);
    ASSERT_TRUE(narrow) << radius;
    EXPECT_NEAR(narrow->width, 1.0, 0.002);
    EXPECT_NEAR(narrow->needed, 2.0 * radius, 1e-4);
    EXPECT_NEAR(narrow->place.x(), 12.5, 0.51);
    EXPECT_TRUE(std::abs(narrow->place.y() - 4.5) < 0.51 || std::abs(narrow->place.y() - 0.5) < 0.51)
        << narrow->place.transpose();
    EXPECT_LT(left, kMany);
  }
}

TEST(Enclosure, FindsNoNarrowPlaceOfAWayThatIsOpenOrWalledUp) {
  std::int64_t left = kMany;
  const Planning open(rooms(), {robot_at(1, 1).to(8, 1).radius(0.4)});
  EXPECT_FALSE(Enclosure(open.instance, 0, {}, open.never).narrowest_place(kMany, left));
  const Planning walled(support::ascii_map({"....#....", "....#....", "....#...."}),
                        {robot_at(1, 1).to(8, 1).radius(0.4)});
  EXPECT_FALSE(Enclosure(walled.instance, 0, {}, walled.never).narrowest_place(kMany, left));
  left = 3;
  const Planning narrow(rooms(), {robot_at(1, 1).to(8, 1).radius(0.6)});
  EXPECT_FALSE(Enclosure(narrow.instance, 0, {}, narrow.never).narrowest_place(kMany, left));
}

TEST(Enclosure, MeasuresTheWidestWay) {
  const Planning p(rooms(), {robot_at(1, 1).to(8, 1).radius(0.2)});
  const auto widest = Enclosure(p.instance, 0, {}, p.never).widest_way(3.0, kMany);
  ASSERT_TRUE(widest);
  EXPECT_NEAR(*widest, 1.0, 0.005) << "the doorway";
}

TEST(Enclosure, NeverClosesOffARobotThatHasAPath) {
  Random random(17);
  int closed_count = 0;
  for (int round = 0; round < 400; ++round) {
    OccupancyGrid grid(10, 8, 1.0);
    for (int k = 0; k < 16; ++k) {
      grid.block({static_cast<int>(random.below(10)), static_cast<int>(random.below(8))});
    }
    std::vector<Robot> robots{robot_at(0.5, 0.5).to(9.5, 7.5).radius(0.1 + 0.35 * random.unit())};
    for (int k = 0; k < 8; ++k) {
      robots.push_back(robot_at(10 * random.unit(), 8 * random.unit()).radius(0.1 + 0.5 * random.unit()));
    }
    auto problem = Problem::create(grid, robots, StopCondition::never());
    while (robots.size() > 1 && !std::holds_alternative<Problem>(problem)) {
      robots.erase(robots.begin() +
                   static_cast<std::ptrdiff_t>(std::get<ProblemFaults>(problem).listed.front().robot));
      problem = Problem::create(grid, robots, StopCondition::never());
      if (robots.empty() || !robots.front().goal) break;
    }
    if (!std::holds_alternative<Problem>(problem) || !robots.front().goal) continue;
    PlanOptions options;
    options.connectivity = 32;
    Planning p(std::get<Problem>(std::move(problem)), options);
    Robots staying;
    for (std::size_t robot = 1; robot < p.instance.size(); ++robot) {
      p.reservations.stay_in_place(robot);
      staying.push_back(robot);
    }
    const bool closed = Enclosure(p.instance, 0, staying, p.never).find(kMany).answer == Answer::closed;
    closed_count += closed ? 1 : 0;
    EXPECT_FALSE(closed && p.state.plan(0, {}, p.never).trajectory) << "round " << round;
  }
  EXPECT_GT(closed_count, 20);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
