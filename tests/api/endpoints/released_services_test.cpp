// Robots that are released to their goals, or beyond. What they serve is said once, by the visits and by the
// waits of their plans alike, and done once.

#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/expect_actions.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

/// A robot with a service on its way, and a robot that drives beside it for longer.
Json request_with(const Json& goal) {
  Json request = Json::parse(R"({
    "map": {"rows": ["........................", "........................", "........................",
                     "........................", "........................"]},
    "robot_defaults": {"radius": 0.4, "linear_speed": 1, "angular_speed": 2},
    "robots": [{"id": "a", "start": {"x": 0.5, "y": 0.5}, "goals": []},
               {"id": "b", "start": {"x": 0.5, "y": 3.5}, "goal": {"x": 22.5, "y": 3.5}}]})");
  request["robots"][0]["goals"] = {goal, {{"x", 10.5}, {"y", 0.5}}};
  return request;
}

/// The next plan of the first robot, which is so far in its first action and released to a place.
Json next_plan(const Json& request, double progress, int action, double released) {
  const Json answer = plan_of(request);
  const Json next = advanced(request, answer, 1.0,
                             {{"states",
                               {{{"robot", "a"},
                                 {"action", 0},
                                 {"progress", progress},
                                 {"released", {{"action", action}, {"progress", released}}}},
                                {{"robot", "b"},
                                 {"action", 0},
                                 {"progress", 0.05},
                                 {"released", {{"action", 0}, {"progress", 1.0}}}}}}});
  const Json plan = plan_of(next)["plans"][0];
  expect_that_marks_follow_visits(next["robots"][0], plan);
  return plan;
}

int waits_for_goal(const Json& plan) {
  int waits = 0;
  for (const Json& action : plan["actions"]) waits += action.value("goal", -1) == 0 ? 1 : 0;
  return waits;
}

TEST(ReleasedServices, AreMarkedWhereverTheRobotIsReleasedTo) {
  const Json request = request_with({{"x", 4.5}, {"y", 0.5}, {"service", 3.0}});
  for (const auto& [action, released] : {std::pair{0, 1.0}, {1, 0.0}, {1, 0.5}, {1, 1.0}, {2, 1.0}}) {
    SCOPED_TRACE(testing::Message() << action << " " << released);
    const Json plan = next_plan(request, 0.25, action, released);
    EXPECT_EQ(plan["visits"][0]["goal"], 0);
    EXPECT_GE(waits_for_goal(plan), 1) << plan;
  }
}

TEST(ReleasedServices, BeginInTimeHoweverEarlyTheRobotIs) {
  const Json request = request_with({{"x", 4.5}, {"y", 0.5}, {"service", 2.0}, {"not_before", 10.0}});
  for (const double progress : {0.1, 0.25, 0.5, 0.99, 1.0}) {
    for (const auto& [action, released] : {std::pair{0, 1.0}, {1, 0.7}, {1, 1.0}, {2, 0.5}, {2, 1.0}}) {
      SCOPED_TRACE(testing::Message() << progress << " " << action << " " << released);
      const Json plan = next_plan(request, progress, action, released);
      EXPECT_NEAR(plan["visits"][0]["t_leave"], 11.0, 1e-9) << plan;
    }
  }
}

/// Two goals at one place, both served while the robot stands where it is released to.
TEST(ReleasedServices, AreMarkedApart) {
  Json request = request_with({{"x", 4.5}, {"y", 0.5}, {"service", 3.0}});
  request["robots"][0]["goals"] = {{{"x", 4.5}, {"y", 0.5}, {"service", 3.0}},
                                   {{"x", 4.5}, {"y", 0.5}, {"service", 2.0}},
                                   {{"x", 10.5}, {"y", 0.5}}};
  const Json plan = next_plan(request, 0.25, 0, 1.0);
  EXPECT_EQ(plan["visits"].size(), 3U);
  EXPECT_EQ(plan["actions"][1]["goal"], 0);
  EXPECT_EQ(plan["actions"][2]["goal"], 1);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
