#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr double kPi = std::numbers::pi;

RequestContext context() {
  RequestContext context;
  context.request_id = "test";
  return context;
}

/// A hall with a wall that goes through at its right end.
Json hall() {
  return Json::parse(R"({
    "map": {"rows": [".......#..", "....#..#..", "....#..#..", "....#..#.."]},
    "robot": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.5707963267948966},
    "from": [{"x": 1.5, "y": 0.5, "theta": 0.0}, {"x": 2.5, "y": 3.5}],
    "to": [{"x": 1.5, "y": 2.5}, {"x": 5.5, "y": 0.5, "theta": 1.0}, {"x": 8.5, "y": 0.5}]})");
}

Reply reply_to(const Json& request) { return matrix_endpoint(request.dump(), context()); }

Json answer_to(const Json& request) {
  const Reply reply = reply_to(request);
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults(const Json& request) { return faults_in(reply_to(request)); }

std::string detail(const Json& request) { return json_of(reply_to(request))["errors"][0]["detail"]; }

/// The plan of the robot alone, from one pose to another, when the planner has nothing left to gain.
Json plan_alone(const Json& request, std::size_t from, std::size_t to) {
  Json robot = request["robot"];
  robot["id"] = robot.value("id", "alone");
  robot["start"] = request["from"][from];
  robot["goal"] = request["to"][to];
  Json plan{{"map", request["map"]}, {"robots", {robot}}};
  if (request.contains("zones")) plan["zones"] = request["zones"];
  plan["options"] = request.value("options", Json::object());
  plan["options"]["mode"] = "anytime";
  plan["options"]["max_iterations"] = 100;
  plan["options"]["smoothing"] = false;
  return json_of(plan_endpoint(plan.dump(), context()));
}

TEST(MatrixEndpoint, ReturnsSecondsAndMetresRowByRow) {
  const Json answer = answer_to(hall());
  ASSERT_EQ(answer["seconds"].size(), 2U);
  ASSERT_EQ(answer["seconds"][0].size(), 3U);
  ASSERT_EQ(answer["metres"][1].size(), 3U);
  EXPECT_NEAR(answer["seconds"][0][0], 1.0 + 2.0, 1e-9) << "a quarter turn";
  EXPECT_NEAR(answer["metres"][0][0], 2.0, 1e-9);
  EXPECT_NEAR(answer["seconds"][1][0], std::sqrt(2.0), 1e-9) << "any headings";
  EXPECT_TRUE(answer["warnings"].empty());
}

TEST(MatrixEndpoint, HasNullWhereThereIsNoWay) {
  const Json answer = answer_to(hall());
  for (const std::size_t row : {0U, 1U}) {
    EXPECT_TRUE(answer["seconds"][row][2].is_null());
    EXPECT_TRUE(answer["metres"][row][2].is_null());
    EXPECT_FALSE(answer["seconds"][row][1].is_null());
  }
}

TEST(MatrixEndpoint, MayHaveWholeNumbers) {
  const Json exact = answer_to(hall());
  Json request = hall();
  request["format"] = "integers";
  const Json answer = answer_to(request);
  const auto unreachable = answer["unreachable"].get<std::int64_t>();
  std::int64_t seconds = 0;
  std::int64_t metres = 0;
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (const char* member : {"seconds", "metres"}) {
        const Json& number = answer[member][row][column];
        EXPECT_TRUE(number.is_number_unsigned()) << number;
        const Json& was = exact[member][row][column];
        if (was.is_null()) {
          EXPECT_EQ(number, unreachable);
        } else {
          EXPECT_GE(number.get<double>(), was.get<double>() - 1e-6);
          EXPECT_LT(number.get<double>(), was.get<double>() + 1.0);
        }
      }
    }
    seconds += std::max(answer["seconds"][row][0].get<std::int64_t>(),
                        answer["seconds"][row][1].get<std::int64_t>());
    metres +=
        std::max(answer["metres"][row][0].get<std::int64_t>(), answer["metres"][row][1].get<std::int64_t>());
  }
  EXPECT_EQ(unreachable, std::max(seconds, metres) + 1);
  EXPECT_EQ(answer["seconds"][0][0], 3) << "exactly 3 s, which rounding leaves";
  request["format"] = "numbers";
  EXPECT_EQ(answer_to(request), exact);
  request["format"] = "csv";
  EXPECT_THAT(faults(request), ElementsAre(Pair("/format", "unknown_value")));
}

TEST(MatrixEndpoint, AgreesWithThePlanOfTheRobotAlone) {
  const Json answer = answer_to(hall());
  const Json plan = plan_alone(hall(), 0, 1);
  EXPECT_NEAR(answer["seconds"][0][1], plan["plans"][0]["cost"].get<double>(), 1e-9);
}

TEST(MatrixEndpoint, IsNearlySymmetricWithoutHeadings) {
  constexpr double kShare = 0.005;  // both are times of ways that exist
  Json request = hall();
  request["from"] = Json::parse(R"([{"x": 0.7, "y": 3.1}, {"x": 6.3, "y": 0.6}, {"x": 3.3, "y": 0.5}])");
  request["to"] = request["from"];
  const Json answer = answer_to(request);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(answer["seconds"][a][a], 0.0);
    for (std::size_t b = 0; b < a; ++b) {
      const double there = answer["seconds"][a][b];
      EXPECT_NEAR(answer["seconds"][b][a], there, kShare * there);
    }
  }
}

TEST(MatrixEndpoint, KnowsTheOptionsOfPlans) {
  Json request = hall();
  const double before = answer_to(request)["seconds"][0][1];
  request["options"] = {{"wait_before_move", 2.0}};
  EXPECT_GE(answer_to(request)["seconds"][0][1].get<double>(), before + 4.0);
  request["options"] = {{"inflation", 0.2}};
  EXPECT_TRUE(answer_to(request)["seconds"][0][1].is_null()) << "too near to the walls";
  request["options"] = {{"time_budget_ms", 1e9}};
  EXPECT_THAT(answer_to(request)["warnings"][0].get<std::string>(), HasSubstr("time_budget_ms"));
}

TEST(MatrixEndpoint, KnowsTheOriginOfTheMap) {
  Json request = hall();
  const Json before = answer_to(request);
  request["map"]["origin"] = {{"x", -20.0}, {"y", 100.0}};
  for (const char* list : {"from", "to"}) {
    for (Json& pose : request[list]) {
      pose["x"] = pose["x"].get<double>() - 20.0;
      pose["y"] = pose["y"].get<double>() + 100.0;
    }
  }
  EXPECT_EQ(answer_to(request)["seconds"], before["seconds"]);
}

TEST(MatrixEndpoint, KeepsToTheZonesOfTheRobot) {
  Json request = hall();
  request["zones"] = Json::parse(R"([{"id": "closed", "type": "blocked", "robots": ["other"],
    "polygon": [{"x": 2, "y": 3}, {"x": 7, "y": 3}, {"x": 7, "y": 4}, {"x": 2, "y": 4}]}])");
  request["from"].erase(1);
  EXPECT_FALSE(answer_to(request)["seconds"][0][1].is_null());
  request["robot"]["id"] = "other";
  EXPECT_TRUE(answer_to(request)["seconds"][0][1].is_null());
  request["zones"][0].erase("robots");
  EXPECT_TRUE(answer_to(request)["seconds"][0][1].is_null());
}

TEST(MatrixEndpoint, LeavesClosedZonesAndDoesNotEnterThem) {
  Json request = hall();
  request["zones"] = Json::parse(R"([{"id": "closed", "type": "blocked", "enter": false,
    "polygon": [{"x": 0, "y": 0}, {"x": 2, "y": 0}, {"x": 2, "y": 2}, {"x": 0, "y": 2}]}])");
  request["to"].push_back({{"x", 0.5}, {"y", 0.5}});
  const Json answer = answer_to(request);
  EXPECT_FALSE(answer["seconds"][0][1].is_null()) << "out";
  EXPECT_TRUE(answer["seconds"][0][3].is_null());
  EXPECT_TRUE(answer["seconds"][1][3].is_null());
}

TEST(MatrixEndpoint, TellsPosesThatTheRobotCannotHave) {
  Json request = hall();
  request["from"].push_back({{"x", 4.5}, {"y", 0.5}});
  request["to"].push_back({{"x", 0.2}, {"y", 1.5}});
  request["to"].push_back({{"x", 52.0}, {"y", 1.5}});
  EXPECT_THAT(faults(request),
              ElementsAre(Pair("/from/2", "start_in_obstacle"), Pair("/to/3", "goal_in_obstacle"),
                          Pair("/to/4", "goal_in_obstacle")));
  EXPECT_THAT(detail(request), HasSubstr("Move it, or"));
}

TEST(MatrixEndpoint, TellsEachFaultWithItsPlace) {
  Json request = hall();
  request["robot"].erase("linear_speed");
  request["robot"]["start"] = {{"x", 1.5}, {"y", 0.5}};
  request["from"][1]["x"] = "a";
  request["to"][0]["service"] = 1.0;
  request["options"] = {{"inflation", -1.0}};
  EXPECT_THAT(faults(request), testing::UnorderedElementsAre(Pair("/robot/linear_speed", "missing"),
                                                             Pair("/robot/start", "unknown_key"),
                                                             Pair("/from/1/x", "wrong_type"),
                                                             Pair("/to/0/service", "unknown_key"),
                                                             Pair("/options/inflation", "out_of_range")));
}

TEST(MatrixEndpoint, NeedsPosesAndNotTooMany) {
  Json request = hall();
  request["from"] = Json::array();
  EXPECT_THAT(faults(request), ElementsAre(Pair("/from", "empty")));
  request.erase("from");
  EXPECT_THAT(faults(request), ElementsAre(Pair("/from", "missing")));
  request = hall();
  request["from"] = Json(501, request["from"][0]);
  request["to"] = Json(500, request["to"][0]);
  EXPECT_THAT(faults(request), ElementsAre(Pair("/to", "out_of_range")));
  EXPECT_THAT(detail(request), HasSubstr("501 x 500"));
}

TEST(MatrixEndpoint, AnswersEachPoseOfAListThatRepeatsSome) {
  const Json once = answer_to(hall());
  Json request = hall();
  const Json from = request["from"];
  const Json to = request["to"];
  request["from"] = Json::array({from[1], from[0], from[1]});
  request["to"] = Json::array({to[2], to[0], to[1], to[0]});
  const Json all = answer_to(request);
  const std::vector<std::size_t> rows{1, 0, 1};
  const std::vector<std::size_t> columns{2, 0, 1, 0};
  for (const char* key : {"seconds", "metres"}) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t column = 0; column < columns.size(); ++column) {
        EXPECT_EQ(all[key][row][column], once[key][rows[row]][columns[column]]);
      }
    }
  }
}

/// A list of different poses in the left half of the hall.
Json many_poses(std::size_t count) {
  Json poses = Json::array();
  for (std::size_t k = 0; k < count; ++k) {
    const auto part = static_cast<double>(k) / static_cast<double>(count);
    poses.push_back({{"x", 0.5 + 3.0 * part}, {"y", 0.5 + static_cast<double>(k % 7) * 0.5}});
  }
  return poses;
}

/// As many poses in one list, and as little memory, as one in ten of the most that a service accepts.
TEST(MatrixEndpoint, AnswersOneLongListWithinItsMemory) {
  RequestContext small = context();
  small.limits.max_plan_memory /= 10;
  for (const char* list : {"from", "to"}) {
    Json request = hall();
    const Json one = Json::array({request["from"][0]});
    request["from"] = one;
    request["to"] = one;
    request[list] = many_poses(25'000);
    request["options"] = {{"time_budget_ms", 120'000}};
    const Reply reply = matrix_endpoint(request.dump(), small);
    ASSERT_EQ(reply.status, 200) << reply.body;
    const Json answer = json_of(reply);
    for (const std::size_t k :
         {std::size_t{0}, std::size_t{9'999}, std::size_t{10'000}, std::size_t{24'999}}) {
      Json single = request;
      single[list] = Json::array({request[list][k]});
      const Json& row = answer["seconds"];
      EXPECT_EQ(list == std::string("from") ? row[k][0] : row[0][k], answer_to(single)["seconds"][0][0]);
    }
    request[list][24'000] = {{"x", 4.5}, {"y", 2.5}};
    const std::string place = "/" + std::string(list) + "/24000";
    const char* code = list == std::string("from") ? "start_in_obstacle" : "goal_in_obstacle";
    EXPECT_THAT(faults_in(matrix_endpoint(request.dump(), small)), ElementsAre(Pair(place, code)));
  }
}

/// However long one column takes, others get the turn meanwhile.
TEST(MatrixEndpoint, SharesItsTurnWithinAColumn) {
  Json request = hall();
  request["map"] = {{"rows", Json(1500, std::string(1500, '.'))}};
  request["from"] = Json::parse(R"([{"x": 1.0, "y": 1.0}])");
  request["to"] = Json::parse(R"([{"x": 1499.0, "y": 1499.0}])");
  request["options"] = {{"time_budget_ms", 100'000}};
  RequestContext shared = context();
  TestTurn turn;
  int asked = 0;
  turn.on_share = [&] { return ++asked < 2; };
  shared.turn = &turn;
  EXPECT_EQ(json_of(matrix_endpoint(request.dump(), shared))["code"], "check_unfinished");
  EXPECT_EQ(asked, 2);
}

TEST(MatrixEndpoint, EndsWithTheBudget) {
  Json request = hall();
  request["map"] = {{"rows", Json(300, std::string(300, '.'))}};
  request["from"] = Json(400, request["from"][0]);
  request["to"] = Json::array();
  for (int k = 0; k < 400; ++k) request["to"].push_back({{"x", 0.6 + 0.7 * k}, {"y", 0.6 + 0.7 * k}});
  request["options"] = {{"time_budget_ms", 5}};
  const Json problem = json_of(reply_to(request));
  EXPECT_THAT(problem["code"], testing::AnyOf("check_unfinished", "parse_unfinished"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
