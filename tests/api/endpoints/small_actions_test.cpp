// Places that are hardly apart, and waits of hardly anything: no action in an answer is that small.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/expect_actions.h"
#include "tests/api/support/fleet_json.h"
#include "tests/api/support/lives.h"
#include "tests/support/random_problem.h"
#include "tests/support/sanitized.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::Dice;

/// Metres, radians or seconds: from far below what is the same to far above.
double tiny(Dice& dice) {
  return std::pow(10.0, dice.between(-13.0, -7.0)) * (dice.chance(0.5) ? 1.0 : -1.0);
}

/// Robots whose starts and goals are hardly beside vertices of the lattice, or each other.
Json fleet_beside_vertices(Dice& dice) {
  const double resolution = dice.chance(0.5) ? 1.0 : 0.3;
  const int cells = 8;
  core::OccupancyGrid grid(cells, cells, resolution);
  for (int walls = dice.below(6); walls > 0; --walls) grid.block({dice.below(cells), 1 + 2 * dice.below(3)});
  Json request{{"map", json_of(grid)}, {"options", {{"time_budget_ms", 100'000}}}};
  if (dice.chance(0.5))
    request["options"]["lattice_spacing"] = resolution * (dice.chance(0.5) ? 1.0 / 3.0 : 0.5);
  if (dice.chance(0.3)) request["options"]["wait_before_move"] = std::abs(tiny(dice));
  if (dice.chance(0.4)) request["options"]["horizon"] = dice.between(2.0, 20.0);
  if (dice.chance(0.3)) request["options"].update({{"mode", "anytime"}, {"max_iterations", 20}});
  if (dice.chance(0.3)) request["options"]["replan"] = "where_needed";
  const auto place = [&](int column, int row) {
    const core::Position centre = grid.center({column, row});
    const core::Position beside(dice.chance(0.7) ? tiny(dice) : 0.0, dice.chance(0.7) ? tiny(dice) : 0.0);
    Json json = json_of(core::Position(centre + beside));
    if (dice.chance(0.5)) json["theta"] = 0.5 * std::numbers::pi * dice.below(4) + tiny(dice);
    return json;
  };
  for (int k = 0; k < 4; ++k) {  // in free rows
    Json robot{{"id", std::string(1, static_cast<char>('a' + k))},
               {"radius", 0.35 * resolution},
               {"linear_speed", resolution},
               {"angular_speed", 2.0}};
    if (dice.chance(0.4)) robot["linear_acceleration"] = resolution * dice.between(0.3, 3.0);
    if (dice.chance(0.3)) robot["angular_acceleration"] = dice.between(0.5, 4.0);
    robot["start"] = place(dice.below(cells), 2 * k);
    robot["goals"] = Json::array();
    for (int goals = dice.below(3); goals > 0; --goals) {
      Json goal = dice.chance(0.3) ? robot["start"] : place(dice.below(cells), 2 * dice.below(4));
      if (dice.chance(0.3)) goal["x"] = goal["x"].get<double>() + tiny(dice);
      if (dice.chance(0.6))
        goal["service"] = dice.chance(0.5) ? std::abs(tiny(dice)) : dice.between(0.0, 2.0);
      if (dice.chance(0.2)) goal["not_before"] = dice.between(0.0, 10.0);
      robot["goals"].push_back(std::move(goal));
    }
    robot["goals"].push_back(place(dice.below(cells), 2 * k));
    request["robots"].push_back(std::move(robot));
  }
  return request;
}

TEST(SmallActions, AreInNoAnswer) {
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t lives = from_environment("FLEETPLAN_LIVES", support::kSanitized ? 20 : 100);
  for (std::uint64_t seed = first; seed < first + lives; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    Json request = fleet_beside_vertices(dice);
    for (int round = 0; round < 4; ++round) {
      const Reply reply = planned_in(5'000, request);
      if (reply.status == 422 && round == 0) break;  // a start in a wall
      ASSERT_EQ(reply.status, 200) << reply.body << request;
      const Json answer = json_of(reply);
      for (const Json& plan : answer.at("plans")) {
        SCOPED_TRACE(testing::Message() << request);
        expect_no_small_actions(plan.at("actions"));
      }
      double at = dice.between(0.0, 6.0);
      Json more = Json::object();
      if (dice.chance(0.6)) more["commit"] = dice.chance(0.3) ? std::abs(tiny(dice)) : dice.between(0.0, 4.0);
      for (const Json& plan : answer.at("plans")) {  // hardly before or after an action ends
        for (const Json& action : plan.at("actions")) {
          if (dice.chance(0.15)) at = std::max(0.0, action.at("t_end").get<double>() + tiny(dice));
        }
      }
      SCOPED_TRACE(testing::Message() << "at " << at << ", " << more << " of " << request << answer);
      request = advanced(request, answer, at, more);
      for (const Json& robot : request.at("robots")) {
        expect_no_small_actions(robot.value("committed", Json::array()));
        expect_no_small_actions(robot.value("previous", Json::array()));
      }
      if (testing::Test::HasFailure()) return;
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
