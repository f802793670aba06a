#include <fleetplan/fleetplan.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/library/fleet.h"

namespace fleetplan {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> places(const Problem& problem, const Options& options = {}) {
  std::vector<std::string> places;
  for (const Fault& fault : faults_of(problem, options)) {
    places.push_back(fault.place);
    EXPECT_TRUE(fault.detail.ends_with('.')) << fault.detail;
  }
  return places;
}

TEST(PublicFaults, AreNoneForAValidProblem) {
  EXPECT_THAT(places(corridor_swap()), IsEmpty());
  EXPECT_THAT(places({Map(1, 1, 1.0)}), IsEmpty()) << "without robots";
}

TEST(PublicFaults, NameEveryNumberOutOfRange) {
  Problem problem = corridor_swap();
  problem.robots[0].radius = 0.0;
  problem.robots[1].angular_speed = std::numeric_limits<double>::infinity();
  problem.robots[1].goals[0].theta = std::numeric_limits<double>::quiet_NaN();
  problem.obstacles.push_back({"", 0.5, {{1.0, {0.0, 0.0}}, {1.0, {1.0, 0.0}}}});
  problem.obstacles.push_back({"", 0.5, {}});
  problem.zones.push_back(
      {"", Zone::Type::one_way, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}, {}, {}, 0.0, 0.0, {7}});
  Options options;
  options.connectivity = 5;
  options.horizon = 0.0;
  EXPECT_THAT(places(problem, options),
              ElementsAre("robots[0].radius", "robots[1].angular_speed", "robots[1].goals[0].theta",
                          "obstacles[0].motion[1].t", "obstacles[1].motion", "zones[0].half_angle",
                          "zones[0].robots[0]", "options.horizon", "options.connectivity"));
}

TEST(PublicFaults, NamePosesThatCollide) {
  Problem problem = corridor_swap();
  problem.robots[0].start = {0.5, 1.5, 0.0};
  EXPECT_THAT(places(problem), ElementsAre("robots[0].start"));
  problem = corridor_swap();
  problem.robots[0].goals.insert(problem.robots[0].goals.begin(), {3.5, 1.5});
  EXPECT_THAT(places(problem), ElementsAre("robots[0].goals[0]"));
  problem = corridor_swap();
  problem.robots[1].start = {0.8, 0.5, 0.0};
  EXPECT_THAT(places(problem), ElementsAre("robots[1].start"));
  Options measured;
  measured.start_overlap = 0.4;
  EXPECT_THAT(places(problem, measured), IsEmpty());
}

TEST(PublicFaults, NameCommittedActionsThatTheRobotCannotExecute) {
  using Type = Action::Type;
  const auto places_with = [](const std::vector<Action>& committed) {
    Problem problem = corridor_swap();
    problem.robots[0].committed = committed;
    return places(problem);
  };
  const Pose start{0.5, 0.5, 0.0};
  const Pose there{2.5, 0.5, 0.0};
  EXPECT_THAT(places_with({{Type::translate, 0.0, 2.0, start, there, {}, false}}), IsEmpty());
  EXPECT_THAT(places_with({{Type::translate, 0.0, 1.0, start, there, {}, false}}),
              ElementsAre("robots[0].committed[0]"))
      << "too fast";
  EXPECT_THAT(places_with({{Type::translate, 0.0, 2.0, start, {2.5, 0.7, 0.0}, {}, false}}),
              ElementsAre("robots[0].committed[0]"))
      << "sideways";
  EXPECT_THAT(places_with({{Type::wait, 0.0, 2.0, start, there, {}, false}}),
              ElementsAre("robots[0].committed[0]"))
      << "a wait that moves";
  EXPECT_THAT(places_with({{Type::wait, 0.0, 1.0, start, start, {}, false},
                           {Type::wait, 1.5, 2.0, start, start, {}, false}}),
              ElementsAre("robots[0].committed[1]"))
      << "a gap in time";
  Problem parked = corridor_swap();
  parked.robots[1].goals.clear();
  parked.robots[0].committed = {{Type::translate, 0.0, 9.0, start, {8.5, 0.5, 0.0}, {}, false}};
  EXPECT_THAT(places(parked), testing::Contains("robots[0].committed"));
}

TEST(PublicFaults, NameProfilesThatDoNotFit) {
  using Type = Action::Type;
  const Pose start{0.5, 0.5, 0.0};
  const auto places_with = [&](const std::optional<Profile>& profile, double x, double seconds = 7.5) {
    Problem problem = corridor_swap();
    problem.robots[0].linear_acceleration = 1.0;
    problem.robots[0].linear_deceleration = 0.5;
    const Action action{Type::translate, 0.0, seconds, start, {x, 0.5, 0.0}, {}, false, profile};
    problem.robots[0].committed = {action};
    problem.robots[1].start = {8.5, 1.5, 0.0};
    problem.robots[1].goals.clear();
    problem.map = Map::from_rows({".........", "........."}, 1.0);
    return places(problem);
  };
  EXPECT_THAT(places_with(Profile{0.0, 1.0, 0.0}, 6.5), IsEmpty());
  EXPECT_THAT(places_with(std::nullopt, 6.5), IsEmpty()) << "measured";
  for (const Profile& profile : {Profile{0.0, 0.9, 0.0}, Profile{0.0, 1.1, 0.0}, Profile{0.5, 0.2, 0.0},
                                 Profile{0.0, 0.0, 0.0}, Profile{-0.1, 1.0, 0.0}}) {
    EXPECT_THAT(places_with(profile, 6.5), ElementsAre("robots[0].committed[0]")) << profile.cruise;
  }
  EXPECT_THAT(places_with(Profile{0.0, 1.0, 1.0}, 6.5, 6.5), ElementsAre("robots[0].committed[0]"))
      << "ends at a speed";
  Problem problem = corridor_swap();
  problem.robots[0].linear_acceleration = 0.0;
  problem.robots[0].linear_deceleration = -1.0;
  problem.robots[1].angular_acceleration = 1e7;
  EXPECT_THAT(places(problem), ElementsAre("robots[0].linear_acceleration", "robots[0].linear_deceleration",
                                           "robots[1].angular_acceleration"));
}

TEST(PublicFaults, OfARobotMayLeaveTheOthersToBePlanned) {
  Problem problem = corridor_swap();
  problem.robots[0].goals = {{1.5, 0.5}};
  problem.robots.push_back(robot_from({4.5, 1.5, 0.0}, {{4.5, 9.5}}));
  problem.robots.push_back(robot_from({8.7, 0.5, 0.0}, {}));
  Goal goal;
  goal.any_of = {{2.5, 1.5}, {3.5, 1.5}};
  problem.robots.push_back(robot_from({2.5, 0.5, 0.0}, {goal}));
  EXPECT_FALSE(places(problem).empty());
  Options options;
  options.invalid_robots = Options::InvalidRobots::report;
  EXPECT_THAT(places(problem, options), IsEmpty());
  const Plan made = plan(problem, options);
  std::vector<std::size_t> invalid;
  for (const Unplanned& robot : made.unplanned) {
    if (robot.reason != Unplanned::Reason::invalid) continue;
    invalid.push_back(robot.robot);
    ASSERT_FALSE(robot.faults.empty());
  }
  EXPECT_THAT(invalid, ElementsAre(1U, 2U, 3U, 4U));
  ASSERT_EQ(made.plans.size(), 1U) << "the first robot";
  EXPECT_EQ(made.unplanned[1].faults[0].place, "robots[2].goals[0]");
  EXPECT_EQ(made.unplanned[3].faults[0].place, "robots[4].goals[0].any_of");
  EXPECT_TRUE(made.verified);
  EXPECT_TRUE(verify(problem, made, options).valid());
  problem.robots[0].radius = -1.0;
  EXPECT_THAT(places(problem, options), ElementsAre("robots[0].radius")) << "other faults are refused";
}

TEST(PublicFaults, AreThrownByThePlanner) {
  Problem problem = corridor_swap();
  problem.robots[1].radius = -1.0;
  try {
    plan(problem);
    FAIL() << "planned";
  } catch (const InvalidProblem& invalid) {
    ASSERT_EQ(invalid.faults().size(), 1U);
    EXPECT_EQ(invalid.faults()[0].place, "robots[1].radius");
    EXPECT_EQ(std::string(invalid.what()),
              "robots[1].radius: The value is -1; it must be from 1e-04 to 1e+06 m.");
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan
