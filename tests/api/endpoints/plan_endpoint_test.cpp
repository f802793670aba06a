#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <new>
#include <numbers>
#include <stop_token>
#include <thread>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/json/errors.h"
#include "core/plan/planner.h"
#include "core/runtime/stop_condition.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"
#include "tests/support/step_limit.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

RequestContext context() {
  RequestContext context;
  context.request_id = "test-7";
  return context;
}

Json planned(const Json& request) {
  const Reply reply = plan_endpoint(request.dump(), context());
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(reply.content_type, "application/json");
  return json_of(reply);
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

TEST(PlanEndpoint, PlansTinyMovesFarFromTheOrigin) {
  const Json answer = planned(Json::parse(R"({
    "map": {"rows": ["......", "......", "......"], "resolution": 0.05, "origin": {"x": 10000, "y": 3}},
    "robots": [{"id": "a", "radius": 0.0025, "linear_speed": 1e-3, "angular_speed": 0.5,
                "start": {"x": 10000.225, "y": 3.025}, "goal": {"x": 10000.025, "y": 3.125}}]})"));
  EXPECT_EQ(answer["status"], "solved");
}

/// Two robots of 0.3 m that swap places through a door of 0.7 m, on cells of 5 cm.
Json door_request() {
  Json rows = Json::array();
  for (int row = 0; row < 60; ++row) {
    std::string cells(120, '.');
    if (row < 23 || row >= 37) cells[60] = '#';
    rows.push_back(cells);
  }
  Json request = Json::parse(R"({
    "map": {"resolution": 0.05},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
    "robots": [{"id": "a", "start": {"x": 1.02, "y": 1.51}, "goal": {"x": 5.01, "y": 1.5}},
               {"id": "b", "start": {"x": 5.0, "y": 0.53}, "goal": {"x": 1.0, "y": 0.5}}]})");
  request["map"]["rows"] = rows;
  return request;
}

TEST(PlanEndpoint, PlansDoNotDependOnTheMapsThatAreKept) {
  const auto answer_with = [](core::MapCache* maps, const Json& request) {
    RequestContext with_maps = context();
    with_maps.maps = maps;
    Json answer = json_of(plan_endpoint(request.dump(), with_maps));
    answer.erase("timings_ms");
    return answer;
  };
  core::MapCache maps(std::size_t{64} << 20);
  for (const double radius : {0.3, 0.33, 0.3}) {
    Json request = door_request();
    request["robots"][0]["radius"] = radius;
    const Json answer = answer_with(nullptr, request);
    EXPECT_EQ(answer["status"], "solved") << answer;
    EXPECT_EQ(answer_with(&maps, request), answer) << "cold, or with another radius before";
    EXPECT_EQ(answer_with(&maps, request), answer) << "warm";
  }
  EXPECT_EQ(maps.stats().misses, 1u);
  EXPECT_EQ(maps.stats().hits, 5u);
}

TEST(PlanEndpoint, SwapsTwoRobotsAroundAWall) {
  const Json answer = planned(swap_request());
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["request_id"], "test-7");
  EXPECT_EQ(answer["verified"], true);
  EXPECT_EQ(answer["deterministic"], true);
  EXPECT_GE(answer["min_clearance"].get<double>(), 0.0) << "contact is reported as 0";
  ASSERT_EQ(answer["plans"].size(), 2U);
  EXPECT_EQ(answer["plans"][0]["robot"], "a");
  EXPECT_EQ(answer["plans"][1]["robot"], "b");
  const Json& last = answer["plans"][1]["actions"].back();
  EXPECT_NEAR(last["to"]["x"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(last["to"]["theta"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(last["t_end"], answer["plans"][1]["cost"]);
}

TEST(PlanEndpoint, ReturnsTheLowerBoundOfEachRobotAndTheirSumAndMaximum) {
  Json request = swap_request();
  request["robots"].push_back(Json::parse(R"({"id": "parked", "start": {"x": 4.5, "y": 0.5}})"));
  const Json answer = planned(request);
  ASSERT_EQ(answer["plans"].size(), 3U);
  double sum = 0.0;
  double most = 0.0;
  for (const Json& plan : answer["plans"]) {
    const double bound = plan["lower_bound"].get<double>();
    EXPECT_LE(bound, plan["cost"].get<double>()) << plan["robot"];
    sum += bound;
    most = std::max(most, bound);
  }
  EXPECT_GT(answer["plans"][0]["lower_bound"].get<double>(), 8.0) << "8 m, around a wall";
  EXPECT_EQ(answer["plans"][2]["lower_bound"], 0.0);
  EXPECT_EQ(answer["lower_bound"]["flowtime"], sum);
  EXPECT_EQ(answer["lower_bound"]["makespan"], most);
}

TEST(PlanEndpoint, TellsWhichMethodsPlannedWhom) {
  Json request = swap_request();
  Json moves = planned(request)["search"]["moves"];
  EXPECT_EQ(moves["priorities"], Json({{"tried", 2}, {"served", 2}, {"could_not_serve", 0}}));
  EXPECT_EQ(moves["smoothing"]["served"], 2);
  EXPECT_FALSE(moves.contains("steps")) << moves;
  request["robots"][0]["goals"] = {{{"x", 4.5}, {"y", 0.5}, {"radius_after", 0.35}},
                                   request["robots"][0]["goal"]};
  request["robots"][0].erase("goal");
  moves = planned(request)["search"]["moves"];
  EXPECT_EQ(moves["smoothing"], Json({{"tried", 2}, {"served", 1}, {"could_not_serve", 1}})) << "a load";
  request = swap_request();
  request["robots"][0]["goal"]["x"] = request["robots"][1]["start"]["x"] = 5.5;
  request["robots"][1]["goal"]["x"] = request["robots"][0]["start"]["x"] = 3.5;
  request["map"]["rows"] = {"#.#######", ".........", "#########"};
  moves = planned(request)["search"]["moves"];
  EXPECT_EQ(moves["steps"], Json({{"tried", 2}, {"served", 2}, {"could_not_serve", 0}})) << moves;
}

TEST(PlanEndpoint, ReturnsTheDocumentedMembersInOrder) {
  const Json answer = planned(swap_request());
  EXPECT_THAT(keys_of(answer),
              ElementsAre("status", "request_id", "plans", "unplanned", "flowtime", "makespan", "lower_bound",
                          "verified", "min_clearance", "deterministic", "search", "timings_ms", "warnings"));
  EXPECT_THAT(keys_of(answer["plans"][0]), ElementsAre("robot", "cost", "lower_bound", "actions"));
  EXPECT_THAT(keys_of(answer["plans"][0]["actions"][0]),
              ElementsAre("type", "t_start", "t_end", "from", "to"));
  EXPECT_THAT(keys_of(answer["plans"][0]["actions"][0]["to"]), ElementsAre("x", "y", "theta"));
  EXPECT_THAT(keys_of(answer["lower_bound"]), ElementsAre("flowtime", "makespan"));
  EXPECT_THAT(keys_of(answer["search"]), ElementsAre("attempts", "expansions", "improvements", "moves"));
  EXPECT_THAT(keys_of(answer["timings_ms"]),
              ElementsAre("queue", "parse", "plan", "choose", "first_plan", "bounds", "improve", "verify",
                          "serialize", "total"));
}

TEST(PlanEndpoint, ReturnsPositionsInTheClientsWorld) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", -100.0}, {"y", 1000.0}};
  for (auto& robot : request["robots"]) {
    for (const char* pose : {"start", "goal"}) {
      robot[pose]["x"] = robot[pose]["x"].get<double>() - 100.0;
      robot[pose]["y"] = robot[pose]["y"].get<double>() + 1000.0;
    }
  }
  const Json answer = planned(request);
  const Json& actions = answer["plans"][0]["actions"];
  EXPECT_NEAR(actions.front()["from"]["x"].get<double>(), -99.5, 1e-9);
  EXPECT_NEAR(actions.front()["from"]["y"].get<double>(), 1001.5, 1e-9);
  EXPECT_NEAR(actions.back()["to"]["x"].get<double>(), -91.5, 1e-9);
}

TEST(PlanEndpoint, ReturnsParkedRobotsAndNoClearanceForASingleRobot) {
  Json request = swap_request();
  request["robots"].erase(1);
  request["robots"][0].erase("goal");
  const Json answer = planned(request);
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["plans"],
            Json::parse(R"([{"robot": "a", "cost": 0.0, "lower_bound": 0.0, "actions": []}])"));
  EXPECT_TRUE(answer["min_clearance"].is_null());
  EXPECT_EQ(answer["flowtime"], 0.0);
}

TEST(PlanEndpoint, ReturnsTheReasonOfAnUnplannedRobot) {
  Json request = swap_request();
  request["map"]["rows"] = {"....#....", "....#....", "....#....", "....#...."};
  const Json answer = planned(request);
  EXPECT_EQ(answer["status"], "none");
  ASSERT_EQ(answer["unplanned"].size(), 2U);
  EXPECT_THAT(keys_of(answer["unplanned"][0]),
              ElementsAre("robot", "reason", "detail", "blocked_by", "blocked_by_total"));
  EXPECT_EQ(answer["unplanned"][0]["robot"], "a");
  EXPECT_EQ(answer["unplanned"][0]["reason"], "goal_unreachable");
}

TEST(PlanEndpoint, TellsWhereAWayIsTooNarrow) {
  Json request = Json::parse(R"({
    "map": {"rows": ["....#....", ".........", "....#...."], "origin": {"x": 100, "y": -7}},
    "robots": [{"id": "a", "radius": 0.6, "linear_speed": 1, "angular_speed": 1,
                "start": {"x": 101, "y": -6}, "goal": {"x": 108, "y": -6}}]})");
  const std::string detail = planned(request)["unplanned"][0]["detail"];
  EXPECT_THAT(detail, HasSubstr("It needs 1.2 m; the narrowest place of the widest way there is "));
  EXPECT_THAT(detail, testing::AnyOf(HasSubstr("0.999 m wide"), HasSubstr("1 m wide")));
  EXPECT_THAT(detail, testing::AnyOf(HasSubstr("at (104, -5.5)"), HasSubstr("at (105, -5.5)")));
  request["map"]["rows"] = {".........", ".........", "....#...."};  // as wide as it would have to be
  EXPECT_EQ(planned(request)["status"], "solved");
}

TEST(PlanEndpoint, ReturnsTimingsWhoseTotalIsAtLeastTheirSum) {
  RequestContext late = context();
  TestTurn turn;
  turn.on_await = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  late.turn = &turn;
  const Json timings = json_of(plan_endpoint(swap_request().dump(), late))["timings_ms"];
  double sum = 0.0;
  for (const char* part : {"queue", "parse", "plan", "verify", "serialize"}) {
    EXPECT_GE(timings[part].get<double>(), 0.0) << part;
    sum += timings[part].get<double>();
  }
  EXPECT_GE(timings["queue"].get<double>(), 20.0);
  EXPECT_GE(timings["total"].get<double>(), sum - 1e-6);
}

TEST(PlanEndpoint, ShowsTheTimesOfThePartsOfPlanning) {
  Json request = swap_request();
  const auto timings_of = [](const Json& one) {
    const Json timings = planned(one)["timings_ms"];
    double sum = 0.0;
    for (const char* part : {"choose", "first_plan", "bounds", "improve"}) sum += timings[part].get<double>();
    EXPECT_LE(sum, timings["plan"].get<double>() + 1e-6);
    return timings;
  };
  const Json first = timings_of(request);
  EXPECT_EQ(first["choose"], 0.0) << "no goal has several poses";
  EXPECT_GT(first["first_plan"], 0.0);
  EXPECT_GT(first["bounds"], 0.0);
  const Json goal = request["robots"][0]["goal"];
  request["robots"][0]["goal"] = {{"any_of", {goal, goal}}};
  request["options"] = {{"mode", "anytime"}, {"max_iterations", 50}};
  const Json improved = timings_of(request);
  EXPECT_GT(improved["choose"], 0.0);
  EXPECT_GT(improved["improve"], 0.0);
}

TEST(PlanEndpoint, DoesNotPlanWhenTheBudgetIsSpentInTheQueue) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 10}};
  request["robots"].push_back(Json::parse(R"({"id": "parked", "start": {"x": 4.5, "y": 0.5}})"));
  RequestContext late = context();
  late.received_at -= std::chrono::milliseconds(11);
  const Planner never = [](const auto&, const auto&, const auto&, auto*) -> core::Plan {
    ADD_FAILURE() << "the planner was called";
    return {};
  };
  const Json answer = json_of(plan_with(never, request.dump(), late));
  EXPECT_EQ(answer["status"], "partial");
  EXPECT_EQ(answer["plans"][0]["robot"], "parked");
  ASSERT_EQ(answer["unplanned"].size(), 2U);
  EXPECT_EQ(answer["unplanned"][1]["reason"], "budget_exhausted");
  EXPECT_EQ(answer["deterministic"], false);
  request["robots"].erase(2);
  EXPECT_EQ(json_of(plan_with(never, request.dump(), late))["status"], "none");
}

TEST(PlanEndpoint, ReturnsPreviousPlansThatHoldWhateverTheBudget) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", 448123.137}, {"y", 5411999.731}};
  for (Json& robot : request["robots"]) {
    for (const char* pose : {"start", "goal"}) {
      robot[pose]["x"] = robot[pose]["x"].get<double>() + 448123.137;
      robot[pose]["y"] = robot[pose]["y"].get<double>() + 5411999.731;
    }
  }
  const Json first = planned(request);
  ASSERT_EQ(first["status"], "solved");
  for (std::size_t i = 0; i < 2; ++i) request["robots"][i]["previous"] = first["plans"][i]["actions"];
  for (const int budget : {1, 10, 1000}) {
    request["options"] = {{"time_budget_ms", budget}};
    RequestContext late = context();
    late.received_at -= std::chrono::milliseconds(budget == 1000 ? 0 : budget + 1);
    const Json answer = json_of(plan_endpoint(request.dump(), late));
    EXPECT_EQ(answer["status"], "solved");
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(answer["plans"][i]["actions"], first["plans"][i]["actions"]);
    }
  }
}

TEST(PlanEndpoint, ReturnsPreviousPlansThatHoldIfTheMemoryIsSpent) {
  Json request = swap_request();
  const Json first = planned(request);
  for (std::size_t i = 0; i < 2; ++i) request["robots"][i]["previous"] = first["plans"][i]["actions"];
  const Planner out_of_memory = [](const auto&, const auto&, const auto&, auto*) -> core::Plan {
    throw std::bad_alloc();
  };
  EXPECT_EQ(json_of(plan_with(out_of_memory, request.dump(), context()))["status"], "solved");
}

TEST(PlanEndpoint, WaitsForItsTurnUntilThePlanningDeadline) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 60'000}};
  RequestContext busy = context();
  TestTurn turn;
  busy.turn = &turn;
  EXPECT_EQ(json_of(plan_endpoint(request.dump(), busy))["status"], "solved");
  EXPECT_EQ(turn.need->stop.deadline(), busy.received_at + std::chrono::milliseconds(60'000 - 25));
  EXPECT_EQ(turn.need->answer_by, busy.received_at + std::chrono::milliseconds(60'000));
}

TEST(PlanEndpoint, ReportsDrainingWhenTheServiceStopsBeforePlanning) {
  std::stop_source end;
  RequestContext waiting = context();
  waiting.stop = end.get_token();
  TestTurn turn;
  turn.on_await = [&] { end.request_stop(); };
  waiting.turn = &turn;
  const Reply reply = plan_endpoint(swap_request().dump(), waiting);
  EXPECT_EQ(reply.status, 503);
  EXPECT_EQ(json_of(reply)["code"], "draining");
}

TEST(PlanEndpoint, IsOverloadedBeforeItsEventsBeginWhenItGetsNoTurn) {
  struct NoEvents final : PlanEvents {
    void begin(const PlanProgress&) override { ADD_FAILURE() << "the stream has begun"; }
    void progress(const PlanProgress&) override {}
    void incumbent(std::string) override {}
  };
  NoEvents events;
  TestTurn turn;
  RequestContext busy = context();
  busy.events = &events;
  busy.turn = &turn;
  turn.refuses = true;
  const Reply refused = plan_endpoint(swap_request().dump(), busy);
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(json_of(refused)["code"], "overloaded");
}

TEST(PlanEndpoint, IsOverloadedWhenItsTurnDoesNotCome) {
  TestTurn turn;
  turn.comes = false;
  RequestContext busy = context();
  busy.turn = &turn;
  const Reply reply = plan_endpoint(swap_request().dump(), busy);
  EXPECT_EQ(reply.status, 503);
  EXPECT_EQ(json_of(reply)["code"], "overloaded");
}

TEST(PlanEndpoint, CallsAFewRobotsOnASmallMapShort) {
  TestTurn turn;
  RequestContext waiting = context();
  waiting.turn = &turn;
  Json request = swap_request();
  plan_endpoint(request.dump(), waiting);
  EXPECT_EQ(turn.need->kind, TurnNeed::Kind::plan);
  EXPECT_EQ(turn.need->work, 2.0) << "robots with goals";
  EXPECT_TRUE(turn.need->is_short);
  request["map"]["rows"] = std::vector<std::string>(400, std::string(400, '.'));
  turn.need.reset();
  plan_endpoint(request.dump(), waiting);
  ASSERT_TRUE(turn.need);
  EXPECT_FALSE(turn.need->is_short);
}

TEST(PlanEndpoint, ReportsFaultsWithoutWaitingForATurn) {
  RequestContext busy = context();
  TestTurn turn;
  busy.turn = &turn;
  EXPECT_EQ(plan_endpoint("{}", busy).status, 422);
  EXPECT_EQ(turn.requests, 0);
}

TEST(PlanEndpoint, LetsOthersHaveItsTurnWhileItPlans) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 60'000}};
  TestTurn turn;
  int asked = 0;
  turn.on_share = [&] { return ++asked < 3; };
  RequestContext busy = context();
  busy.turn = &turn;
  const Planner slow = [](const auto& problem, const auto& options, const auto& stop, auto*) {
    while (!stop.met()) std::this_thread::yield();
    return core::plan(problem, options, stop);
  };
  const Json answer = json_of(plan_with(slow, request.dump(), busy));
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(answer["status"], "none") << "the turn did not come back in time";
  EXPECT_EQ(answer["unplanned"][0]["reason"], "budget_exhausted");
  EXPECT_EQ(answer["verified"], true);
}

TEST(PlanEndpoint, GivesThePlannerTheRestOfTheBudget) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 60'000}, {"seed", 42}};
  const RequestContext now = context();
  const Planner planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                              const core::StopCondition& stop, auto*) {
    EXPECT_EQ(stop.deadline(), now.received_at + std::chrono::milliseconds(60'000 - 25))
        << "25 ms are left for the answer";
    EXPECT_EQ(options.seed, 42U);
    return core::plan(problem, options, stop);
  };
  EXPECT_EQ(plan_with(planner, request.dump(), now).status, 200);
}

TEST(PlanEndpoint, WarnsOfAClampedBudget) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 500'000}};
  EXPECT_THAT(planned(request)["warnings"][0].get<std::string>(), HasSubstr("clamped"));
}

TEST(PlanEndpoint, NeverReturnsAPlanThatTheCheckerRejects) {
  const Planner through_the_wall = [](const core::Problem& problem, const auto&, const auto&, auto*) {
    const core::Pose start = problem.robots()[0].start;
    const core::Pose goal{problem.robots()[0].goal->position, 0.0};
    core::Plan plan;
    plan.plans.push_back({0, 8.0, {{core::Action::Type::translate, 0.0, 8.0, start, goal}}});
    plan.unplanned.push_back({1, core::Unplanned::Reason::blocked_by_robots, "", {0}});
    return plan;
  };
  const Reply reply = plan_with(through_the_wall, swap_request().dump(), context());
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(reply.content_type, "application/problem+json");
  EXPECT_EQ(json_of(reply)["code"], "internal_error");
  EXPECT_EQ(json_of(reply)["request_id"], "test-7");
}

TEST(PlanEndpoint, RejectsAPlanThatCrossesAnUnplannedRobot) {
  Json request = swap_request();
  request["map"]["rows"] = {"........."};
  request["robots"][0]["start"]["y"] = 0.5;
  request["robots"][0]["goal"]["y"] = 0.5;
  request["robots"][1]["start"] = {{"x", 4.5}, {"y", 0.5}};
  request["robots"][1]["goal"] = {{"x", 0.5}, {"y", 0.5}};
  const Planner across = [](const core::Problem& problem, const auto&, const auto&, auto*) {
    const core::Pose goal{problem.robots()[0].goal->position, 0.0};
    core::Plan plan;
    plan.plans.push_back(
        {0, 8.0, {{core::Action::Type::translate, 0.0, 8.0, problem.robots()[0].start, goal}}});
    plan.unplanned.push_back({1, core::Unplanned::Reason::blocked_by_robots, "", {0}});
    return plan;
  };
  EXPECT_EQ(plan_with(across, request.dump(), context()).status, 500);
}

TEST(PlanEndpoint, ReturnsErrorsAsProblems) {
  const auto code = [](const std::string& body) {
    const Reply reply = plan_endpoint(body, context());
    EXPECT_EQ(reply.content_type, "application/problem+json");
    EXPECT_EQ(json_of(reply)["request_id"], "test-7");
    return std::to_string(reply.status) + ' ' + json_of(reply)["code"].get<std::string>();
  };
  EXPECT_EQ(code(""), "400 malformed_json");
  EXPECT_EQ(code("{"), "400 malformed_json");
  EXPECT_EQ(code(std::string(1'000'000, '[')), "400 too_deep");
  EXPECT_EQ(code("[]"), "422 invalid_request");
  EXPECT_EQ(code("null"), "422 invalid_request");
}

TEST(PlanEndpoint, KeepsIdsInAnyLanguage) {
  Json request = swap_request();
  const std::string id = "\"Wägelchen\" 🚚\n";
  request["robots"][0]["id"] = id;
  EXPECT_EQ(planned(request)["plans"][0]["robot"], id);
}

TEST(PlanEndpoint, KeepsNoPreviousPlanThatOverlapsAgainWithinTheInflation) {
  // They overlap at the start, clear each other, and would overlap again before their inflated disks are
  // clear.
  const Json plan = planned(Json::parse(R"({
    "map": {"rows": ["............", "............", "............", "............",
                     "............", "............", "............", "............"]},
    "robot_defaults": {"radius": 0.5, "linear_speed": 1, "angular_speed": 1},
    "robots": [
      {"id": "a", "start": {"x": 5, "y": 4, "theta": 0.7853981633974483}, "goal": {"x": 8, "y": 7},
       "previous": [{"type": "translate", "t_start": 0, "t_end": 4.242640687119286,
                     "from": {"x": 5, "y": 4, "theta": 0.7853981633974483},
                     "to": {"x": 8, "y": 7, "theta": 0.7853981633974483}}]},
      {"id": "b", "start": {"x": 5.7, "y": 4, "theta": 0},
       "committed": [{"type": "translate", "t_start": 0, "t_end": 0.7,
                      "from": {"x": 5.7, "y": 4, "theta": 0}, "to": {"x": 6.4, "y": 4, "theta": 0}}]}],
    "options": {"inflation": 0.15, "start_overlap": 0.6}})"));
  EXPECT_EQ(plan["status"], "solved");
}

/// Waits until its budget is spent and some more, as on a machine that is busy with other work.
template <class Made>
Reply planned_late(Json request, const Made& made) {
  request["options"] = {{"time_budget_ms", 50}};
  const auto late = [&](const core::Problem& problem, const core::PlanOptions& options,
                        const core::StopCondition& stop, core::Observer*) {
    core::Plan plan = made(problem, options);
    while (core::StopCondition::Clock::now() < stop.deadline() + std::chrono::milliseconds(200)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return plan;
  };
  return plan_with(late, request.dump(), context());
}

TEST(PlanEndpoint, ReturnsAPlanThatIsLateButCheckedQuickly) {
  const Reply reply = planned_late(swap_request(), [](const auto& problem, const auto& options) {
    return core::plan(problem, options, core::StopCondition::never());
  });
  EXPECT_EQ(json_of(reply)["status"], "solved");
}

TEST(PlanEndpoint, PlansNobodyWhenThePlanCannotBeCheckedInTime) {
  Json request = swap_request();
  constexpr int kRobots = 300;
  request["map"]["rows"] = Json(kRobots, "...");
  request["robots"] = Json::array();
  for (int k = 0; k < kRobots; ++k) {
    request["robots"].push_back({{"id", std::to_string(k)},
                                 {"start", {{"x", 0.5}, {"y", k + 0.5}}},
                                 {"goal", {{"x", 0.5}, {"y", k + 0.5}, {"theta", 1.0}}}});
  }
  // Each robot turns so often that the check of all takes more CPU time than it has.
  const Reply reply = planned_late(request, [](const core::Problem& problem, const core::PlanOptions&) {
    constexpr int kTurns = 1001;
    core::Plan plan;
    for (std::size_t k = 0; k < problem.robots().size(); ++k) {
      std::vector<core::Action> actions;
      core::Pose pose = problem.robots()[k].start;
      for (int turn = 0; turn < kTurns; ++turn) {
        const core::Pose turned{pose.position, 1.0 - pose.theta};
        actions.push_back({core::Action::Type::rotate, 0.5 * turn, 0.5 * (turn + 1), pose, turned});
        pose = turned;
      }
      plan.plans.push_back({k, actions.back().t_end, actions});
    }
    return plan;
  });
  const Json answer = json_of(reply);
  EXPECT_EQ(answer["status"], "none") << reply.body;
  EXPECT_EQ(answer["unplanned"][1]["reason"], "budget_exhausted");
  EXPECT_EQ(answer["unplanned"][1]["detail"], "The time budget ended before the plan was checked.");
  EXPECT_EQ(answer["verified"], true);
}

TEST(PlanEndpoint, ListsTwentyOfTheRobotsThatBlockAnother) {
  Json request = swap_request();
  request["map"] = {{"rows", {"...", "...", "..."}}, {"resolution", 1000}};
  request["robots"] = Json::array();
  const int robots = 300;
  for (int k = 0; k < robots; ++k) {
    const Json start{{"x", 1100.0 + 20.0 * (k % 20)}, {"y", 1100.0 + 20.0 * (k / 20)}};
    const Json goal{{"x", 1900.0 - 20.0 * (k % 20)}, {"y", 1100.0 + 20.0 * (k / 20)}};
    request["robots"].push_back(
        {{"id", std::string(252, 'r') + std::to_string(1000 + k)}, {"start", start}, {"goal", goal}});
  }
  request["options"] = {{"inflation", 900}};
  const Reply reply = plan_endpoint(request.dump(), context());
  const Json answer = json_of(reply);
  EXPECT_EQ(answer["unplanned"][0]["reason"], "start_blocked");
  EXPECT_EQ(answer["unplanned"][0]["blocked_by"].size(), 20U);
  EXPECT_EQ(answer["unplanned"][0]["blocked_by_total"], robots - 1);
  EXPECT_LT(reply.body.size(), 20 * request.dump().size());
}

/// Robots that all start in one place, as `start_overlap` allows.
Json stacked_robots(int count) {
  Json request = Json::parse(R"({
    "map": {"rows": []}, "options": {"start_overlap": 1, "time_budget_ms": 20000}, "robots": [],
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}})");
  for (int row = 0; row < 20; ++row) request["map"]["rows"].push_back(std::string(20, '.'));
  for (int i = 0; i < count; ++i) {
    Json robot = {{"id", "r" + std::to_string(i)}};
    robot["start"] = {{"x", 5.0 + 1e-3 * i}, {"y", 5.0}};
    robot["goal"] = {{"x", 0.5 + i % 20}, {"y", 10.5 + i / 20}};
    request["robots"].push_back(robot);
  }
  return request;
}

TEST(PlanEndpoint, ChecksManyRobotsThatStartInOnePlace) {
  const Json answer = planned(stacked_robots(150));
  EXPECT_EQ(answer["status"], "none");
  EXPECT_EQ(answer["verified"], true);
  EXPECT_EQ(answer["unplanned"].size(), 150u);
}

/// The budget ends after each number of questions to the stop condition, up to the last one.
TEST(PlanEndpoint, NamesTheStartsThatTakeTooLongToCheck) {
  const Json request = stacked_robots(100);
  support::StepLimit whole;
  const std::string body = request.dump();
  plan_endpoint(body, ended_by(whole));
  const std::int64_t steps = whole.steps();
  int unfinished = 0;
  for (std::int64_t end = 0; end < steps; ++end) {
    support::StepLimit limit(end);
    const Reply reply = plan_endpoint(body, ended_by(limit));
    const Json answer = json_of(reply);
    if (reply.status == 200 || answer["code"] == "parse_unfinished") continue;
    ++unfinished;
    EXPECT_EQ(answer["code"], "check_unfinished") << answer;
    EXPECT_THAT(answer["detail"].get<std::string>(), HasSubstr("near each other"));
    EXPECT_THAT(answer["detail"].get<std::string>(), Not(HasSubstr("`motion`")));
  }
  EXPECT_GT(unfinished, 0);
}

TEST(PlanEndpoint, NamesTheMotionThatTakesTooLongToCheckIfThereIsAny) {
  Json request = stacked_robots(1);
  request["obstacles"] =
      Json::parse(R"([{"id": "o", "radius": 0.3, "motion": [{"t": 0, "x": 15, "y": 5}]}])");
  const std::string body = request.dump();
  support::StepLimit whole;
  plan_endpoint(body, ended_by(whole));
  int unfinished = 0;
  for (std::int64_t end = whole.steps() - 1; end > 0 && unfinished == 0; --end) {
    support::StepLimit limit(end);
    const Json answer = json_of(plan_endpoint(body, ended_by(limit)));
    if (answer.value("code", "") != "check_unfinished") continue;
    ++unfinished;
    EXPECT_THAT(answer["detail"].get<std::string>(), HasSubstr("`motion`"));
  }
  EXPECT_EQ(unfinished, 1);
}

TEST(PlanEndpoint, APlanThatStopsAtTheHorizonHasNoMoveOfNoLength) {
  // The second robot starts in the place of a vertex, too near to the first one, and lets the third one pass.
  const Json answer = json_of(plan_endpoint(R"({
    "map": {"resolution": 2.5, "rows": [
      "..........", "..........", "..#####..#", "..........", "..........", "..#####..#", "..........",
      "..........", "..#####..#", "..........", "..........", "..#####..#", "..........", "..........",
      "..........", "..........", "..........", ".........."]},
    "robots": [
      {"id": "parked", "radius": 0.7674, "linear_speed": 1.942, "angular_speed": 5.995,
       "start": {"x": 7.890814987978884, "y": 14.01761445394299, "theta": 1.5707963267948966}},
      {"id": "waits", "radius": 0.7674, "linear_speed": 1.942, "angular_speed": 5.995, "vicinity": 0.2928,
       "start": {"x": 6.25, "y": 13.75, "theta": -1.5707963267948966}, "goal": {"x": 23.75, "y": 43.75}},
      {"id": "passes", "radius": 1.25, "linear_speed": 1.628, "angular_speed": 4.332,
       "start": {"x": 7.7325764121198, "y": 11.803139089917982, "theta": 0.2247135375126528},
       "goal": {"x": 3.75, "y": 43.75}}],
    "options": {"wait_before_move": 3, "horizon": 10, "start_safe_interval": 20}})",
                                            context()));
  ASSERT_EQ(answer["status"], "solved") << answer;
  for (const Json& plan : answer["plans"]) {
    for (const Json& action : plan["actions"]) {
      EXPECT_FALSE(action["type"] == "translate" && action["from"] == action["to"]) << action;
    }
  }
}

/// The budget ends after each number of questions to the stop condition: what is not finished by then is
/// never taken for a result.
TEST(PlanEndpoint, NeverCallsAGoalOutOfReachBecauseTheBudgetEnds) {
  Json request = stacked_robots(1);
  for (int k = 0; k < 150; ++k) {
    request["robots"][0]["goals"].push_back({{"x", 1.03 + 0.1 * k}, {"y", 3.02 + 0.05 * (k % 40)}});
  }
  request["robots"][0].erase("goal");
  const std::string body = request.dump();
  support::StepLimit whole;
  EXPECT_EQ(json_of(plan_endpoint(body, ended_by(whole)))["status"], "solved");
  const std::int64_t steps = whole.steps();
  for (std::int64_t end = 0; end < steps; end += 1 + steps / 150) {
    support::StepLimit limit(end);
    const Reply reply = plan_endpoint(body, ended_by(limit));
    if (reply.status != 200) {
      EXPECT_EQ(reply.status, 422) << reply.body;
      continue;
    }
    for (const Json& robot : json_of(reply)["unplanned"]) {
      EXPECT_EQ(robot["reason"], "budget_exhausted") << end << " of " << steps << robot;
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
