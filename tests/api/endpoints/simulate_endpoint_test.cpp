#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"
#include "tests/support/step_limit.h"
#include "tests/support/threaded_executor.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two robots whose ways cross: "b" passes 2 s before "a".
Json crossing_request() {
  return Json::parse(R"({
    "map": {"rows": [".........", ".........", ".........", "........."]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
    "robots": [
      {"id": "a", "start": {"x": 0.5, "y": 1.5, "theta": 0.0}, "goal": {"x": 8.5, "y": 3.5}},
      {"id": "b", "start": {"x": 4.5, "y": 3.5, "theta": -1.5}, "goal": {"x": 4.5, "y": 0.5, "theta": 0.25}}
    ]})");
}

/// The crossing with its plan, to be executed by a policy.
Json simulate_request(const char* policy = "open_loop") {
  Json request = crossing_request();
  const Json answer = json_of(plan_endpoint(request.dump(), {}));
  request["plans"] = answer["plans"];
  request["disturbance"] = Json::parse(R"({"speed": {"min": 0.5, "max": 1}, "turn": {"min": 0.6, "max": 1},
    "stops": {"rate_per_hour": 360, "mean_s": 2}, "start_delay": {"min": 0, "max": 0.2}})");
  request["policy"] = policy;
  request["runs"] = 40;
  return request;
}

Reply reply_to(const Json& request, const RequestContext& context = {}) {
  return simulate_endpoint(request.dump(), context);
}

Json simulated(const Json& request, const RequestContext& context = {}) {
  const Reply reply = reply_to(request, context);
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults_of_simulation(const Json& request) {
  const Reply reply = reply_to(request);
  EXPECT_EQ(reply.status, 422) << reply.body;
  return faults_in(reply);
}

TEST(SimulateEndpoint, HasThePlannedFiguresWithoutDisturbance) {
  for (const char* policy : {"open_loop", "absorb_waits", "clock_stop"}) {
    Json request = simulate_request(policy);
    request.erase("disturbance");
    if (std::string(policy) == "clock_stop") request["max_delay"] = 1;
    const Json answer = simulated(request);
    EXPECT_EQ(answer["runs"], 40);
    EXPECT_EQ(answer["collision_share"], 0.0);
    EXPECT_EQ(answer["deadlock_share"], 0.0);
    EXPECT_NEAR(answer["flowtime"]["p50"].get<double>(), answer["planned"]["flowtime"].get<double>(), 1e-6);
    EXPECT_NEAR(answer["makespan"]["max"].get<double>(), answer["planned"]["makespan"].get<double>(), 1e-6);
    EXPECT_NEAR(answer["robots"][1]["delay"]["max"].get<double>(), 0.0, 1e-6);
    EXPECT_EQ(answer["warnings"], Json::array());
  }
}

TEST(SimulateEndpoint, HasOrderedQuantilesAndTheCollisions) {
  const Json answer = simulated(simulate_request());
  for (const Json& values : {answer["flowtime"], answer["makespan"], answer["robots"][0]["delay"]}) {
    EXPECT_LE(values["min"], values["p10"]);
    EXPECT_LE(values["p10"], values["p50"]);
    EXPECT_LE(values["p50"], values["p90"]);
    EXPECT_LE(values["p90"], values["p99"]);
    EXPECT_LE(values["p99"], values["max"]);
  }
  EXPECT_GT(answer["flowtime"]["min"], answer["planned"]["flowtime"]);
  EXPECT_GT(answer["collision_share"], 0.0);
  const Json& first = answer["first_collisions"][0];
  EXPECT_EQ(first["with"], "robot");
  EXPECT_EQ(first["robots"], (Json{"a", "b"}));
  EXPECT_GT(first["depth"], 0.0);
  EXPECT_LE(first["depth"], 0.6);
  EXPECT_EQ(answer["pairs"][0]["robots"], (Json{"a", "b"}));
  EXPECT_EQ(answer["pairs"][0]["share"], answer["collision_share"]);
}

TEST(SimulateEndpoint, GivesTheSameAnswerWithAnyNumberOfThreads) {
  const Json request = simulate_request("absorb_waits");
  support::ThreadedExecutor executor(3);
  RequestContext context;
  context.executor = &executor;
  EXPECT_EQ(simulated(request), simulated(request, context));
  Json other = request;
  other["seed"] = 1;
  EXPECT_NE(simulated(request)["flowtime"], simulated(other)["flowtime"]);
}

TEST(SimulateEndpoint, HasNoCollisionsWhenRobotsObeyTheDependenciesOfThePlan) {
  Json request = simulate_request("dependencies");
  request["options"] = {{"interval_margin", 0.5}, {"dependencies", true}};
  Json planned = crossing_request();
  planned["options"] = request["options"];
  request.update(json_of(plan_endpoint(planned.dump(), {})));
  const Json figures = simulated(request);
  EXPECT_EQ(figures["deadlock_share"], 0.0);
  EXPECT_EQ(figures["collision_share"], 0.0);
  request["dependencies"] = Json::array();
  EXPECT_GT(simulated(request)["collision_share"], 0.0);
}

TEST(SimulateEndpoint, HasNoCollisionsByTheClockWithinTheIntervalMargin) {
  Json planned = crossing_request();
  planned["options"] = {{"interval_margin", 0.8}};
  Json request = simulate_request("clock_stop");
  request["options"] = planned["options"];
  request["plans"] = json_of(plan_endpoint(planned.dump(), {}))["plans"];
  request["max_delay"] = 0.8;
  request["runs"] = 300;
  EXPECT_EQ(simulated(request)["collision_share"], 0.0);
  request["max_delay"] = 20;
  EXPECT_GT(simulated(request)["collision_share"], 0.0);
}

TEST(SimulateEndpoint, LetsAddedWaitsAbsorbDelaysByAClockOnly) {
  Json planned = crossing_request();
  planned["options"] = {{"wait_before_move", 4.0}};
  Json request = simulate_request("absorb_waits");
  request["options"] = planned["options"];
  request["plans"] = json_of(plan_endpoint(planned.dump(), {}))["plans"];
  request["disturbance"] = Json::parse(R"({"start_delay": {"min": 1, "max": 1}})");
  request["runs"] = 1;
  const double absorbed = simulated(request)["flowtime"]["max"];
  request["policy"] = "open_loop";
  const double kept = simulated(request)["flowtime"]["max"];
  EXPECT_GT(kept, absorbed + 1.0);
  request["policy"] = "dependencies";
  request["dependencies"] = Json::array();
  const double waited = simulated(request)["flowtime"]["max"];
  request["options"]["wait_before_move"] = 0;
  const double skipped = simulated(request)["flowtime"]["max"];
  EXPECT_GT(waited, skipped + 4.0);
}

TEST(SimulateEndpoint, CollidesWithTheRadiusOfTheBody) {
  Json request = simulate_request();
  request.erase("disturbance");
  request["robots"][1]["body_radius"] = 0.6;  // it reaches the edge of the map
  const Json wide = simulated(request);
  EXPECT_EQ(wide["collision_share"], 1.0);
  request["robots"][1].erase("body_radius");
  request["robot_defaults"]["body_radius"] = 0.1;
  EXPECT_EQ(simulated(request)["collision_share"], 0.0);
}

TEST(SimulateEndpoint, ReturnsTheTraceOfARunInTheWorld) {
  Json request = simulate_request();
  request["trace"] = 3;
  const Json trace = simulated(request)["trace"];
  EXPECT_EQ(trace["run"], 3);
  ASSERT_EQ(trace["plans"].size(), 2U);
  const Json& actions = trace["plans"][0]["actions"];
  EXPECT_EQ(actions.front()["from"]["x"], 0.5);
  EXPECT_EQ(actions.front()["t_start"], 0.0);
  EXPECT_EQ(actions.back()["t_end"], trace["plans"][0]["cost"]);
  EXPECT_NEAR(actions.back()["to"]["x"].get<double>(), 8.5, 1e-9);
}

/// A small request of one action with 300,000 bends and 30,000 stops.
Json rough_way_request() {
  Json request = Json::parse(R"({
    "map": {"rows": ["......"], "resolution": 1000}, "runs": 1, "policy": "open_loop",
    "robots": [{"id": "a", "radius": 0.3, "linear_speed": 1, "angular_speed": 1,
                "start": {"x": 500, "y": 500, "theta": 0}}],
    "disturbance": {"stops": {"rate_per_hour": 36000, "mean_s": 0.001},
                    "cross_track": {"sigma": 0.01, "correlation_length": 0.01}},
    "plans": [{"robot": "a", "actions": [{"type": "translate", "t_start": 0, "t_end": 3000,
      "from": {"x": 500, "y": 500, "theta": 0}, "to": {"x": 3500, "y": 500, "theta": 0}}]}]})");
  return request;
}

TEST(SimulateEndpoint, LeavesOutATraceThatIsTooLongForItsRequest) {
  Json request = rough_way_request();
  request["trace"] = 0;
  Json answer = simulated(request);
  EXPECT_FALSE(answer.contains("trace"));
  ASSERT_EQ(answer["warnings"].size(), 1U);
  EXPECT_THAT(answer["warnings"][0].get<std::string>(), HasSubstr("The trace is left out"));
  EXPECT_EQ(answer["runs"], 1);

  request["disturbance"]["cross_track"]["correlation_length"] = 1;
  request["disturbance"]["stops"]["rate_per_hour"] = 360;
  answer = simulated(request);
  EXPECT_GT(answer["trace"]["plans"][0]["actions"].size(), 3000U);
  EXPECT_TRUE(answer["warnings"].empty());
}

TEST(SimulateEndpoint, EndsSoonAfterItsStopWheneverThatIs) {
  Json request = rough_way_request();
  request["disturbance"]["cross_track"]["correlation_length"] = 1;
  request["disturbance"]["stops"]["rate_per_hour"] = 3600;
  request["trace"] = 0;
  request["runs"] = 3;
  int finished = 0;
  for (std::int64_t steps = 0; steps < 8000; steps += 200) {
    support::StepLimit limit(steps);
    const Reply reply = reply_to(request, ended_by(limit));
    if (reply.status != 200) {
      EXPECT_EQ(reply.problem, "check_unfinished");
    } else {
      ++finished;
    }
    EXPECT_LE(limit.late(), 8) << steps;
  }
  EXPECT_GT(finished, 0);
  EXPECT_LT(finished, 40);
}

TEST(SimulateEndpoint, ReportsFaultsWithPointers) {
  struct Case {
    const char* name;
    std::function<void(Json&)> modify;
    const char* pointer;
    const char* code;
  };
  const std::vector<Case> cases{
      {"no policy", [](Json& r) { r.erase("policy"); }, "/policy", "missing"},
      {"policy", [](Json& r) { r["policy"] = "hope"; }, "/policy", "unknown_value"},
      {"no plans", [](Json& r) { r.erase("plans"); }, "/plans", "missing"},
      {"runs", [](Json& r) { r["runs"] = 0; }, "/runs", "out_of_range"},
      {"most runs", [](Json& r) { r["runs"] = 100'001; }, "/runs", "out_of_range"},
      {"trace", [](Json& r) { r["trace"] = 40; }, "/trace", "out_of_range"},
      {"seed", [](Json& r) { r["seed"] = -1; }, "/seed", "out_of_range"},
      {"no delay", [](Json& r) { r["policy"] = "clock_stop"; }, "/max_delay", "missing"},
      {"no dependencies", [](Json& r) { r["policy"] = "dependencies"; }, "/dependencies", "missing"},
      {"null", [](Json& r) { r["policy"] = "dependencies", r["dependencies"] = nullptr; }, "/dependencies",
       "wrong_type"},
      {"range", [](Json& r) { r["disturbance"]["speed"]["max"] = 0.4; }, "/disturbance/speed/max",
       "out_of_range"},
      {"half a range", [](Json& r) { r["disturbance"]["turn"].erase("min"); }, "/disturbance/turn/min",
       "missing"},
      {"factor", [](Json& r) { r["disturbance"]["speed"]["min"] = 0; }, "/disturbance/speed/min",
       "out_of_range"},
      {"sigma",
       [](Json& r) {
         r["disturbance"]["cross_track"] = {{"sigma", -1}, {"correlation_length", 1}};
       },
       "/disturbance/cross_track/sigma", "out_of_range"},
      {"unknown", [](Json& r) { r["disturbance"]["wind"] = 1; }, "/disturbance/wind", "unknown_key"},
      {"body", [](Json& r) { r["robots"][1]["body_radius"] = 0; }, "/robots/1/body_radius", "out_of_range"},
      {"gap", [](Json& r) { r["plans"][0]["actions"][0]["t_start"] = 0.05; }, "/plans/0/actions/0/t_start",
       "discontinuity"},
      {"jump", [](Json& r) { r["plans"][1]["actions"][1]["from"]["x"] = 3; }, "/plans/1/actions/1/from",
       "discontinuity"},
  };
  const Json valid = simulate_request();
  for (const Case& invalid : cases) {
    SCOPED_TRACE(invalid.name);
    Json request = valid;
    invalid.modify(request);
    EXPECT_THAT(faults_of_simulation(request), ElementsAre(testing::Pair(invalid.pointer, invalid.code)));
  }
}

TEST(SimulateEndpoint, ReturnsTheRunsOfItsBudget) {
  Json request = simulate_request();
  request["runs"] = 100'000;
  request["options"] = {{"time_budget_ms", 100}};
  const Json answer = simulated(request);
  EXPECT_GE(answer["runs"], 1);
  EXPECT_LT(answer["runs"], 100'000);
  ASSERT_EQ(answer["warnings"].size(), 1U);
  EXPECT_THAT(answer["warnings"][0].get<std::string>(), HasSubstr("runs were finished"));
}

TEST(SimulateEndpoint, ReportsThatNoRunWasFinished) {
  const Json request = simulate_request();
  RequestContext context;
  context.received_at -= std::chrono::hours(1);
  const Reply late = reply_to(request, context);
  EXPECT_EQ(late.status, 422);
  EXPECT_EQ(late.problem, "check_unfinished");
  TestTurn turn;
  RequestContext queued;
  queued.turn = &turn;
  queued.received_at -= std::chrono::milliseconds(4960);
  const Reply unfinished = reply_to(request, queued);
  EXPECT_EQ(unfinished.status, 422);
  EXPECT_EQ(unfinished.problem, "check_unfinished");
}

TEST(SimulateEndpoint, TakesItsTurn) {
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  EXPECT_EQ(simulated(simulate_request(), context)["runs"], 40);
  EXPECT_EQ(turn.requests, 1);
  EXPECT_EQ(turn.need->kind, TurnNeed::Kind::simulation);
  turn.refuses = true;
  EXPECT_EQ(reply_to(simulate_request(), context).problem, "overloaded");
  std::stop_source stop;
  stop.request_stop();
  TestTurn late;
  late.comes = false;
  context.turn = &late;
  EXPECT_EQ(reply_to(simulate_request(), context).problem, "overloaded");
}

TEST(SimulateEndpoint, LetsOthersHaveTheirTurnAndSaysWhatThatCost) {
  Json request = simulate_request();
  request["runs"] = 1000;
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  int shared = 0;
  turn.on_share = [&] { return ++shared > 0; };
  EXPECT_EQ(simulated(request, context)["runs"], 1000);
  EXPECT_GT(shared, 5);
  turn.on_share = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return false;  // the turn did not come back in time
  };
  const Json cut = simulated(request, context);
  EXPECT_LT(cut["runs"], 1000);
  EXPECT_THAT(cut["warnings"][0].get<std::string>(),
              testing::ContainsRegex("Only the first [0-9]+ of 1000 runs .* time budget of 5000 ms, of which "
                                     "[0-9]+ ms went to other requests"));
}

TEST(SimulateEndpoint, RunsWithinTheMemoryOfItsFigures) {
  Json request = simulate_request();
  request["runs"] = 1000;
  RequestContext context;
  context.limits.max_plan_memory = 64 * 1024;
  const Json answer = simulated(request, context);
  EXPECT_EQ(answer["runs"], 64 * 1024 / 4 / (4 * 8));
  EXPECT_THAT(answer["warnings"][0].get<std::string>(), HasSubstr("max_plan_memory"));
}

class Events final : public PlanEvents {
 public:
  void begin(const PlanProgress& progress) override { begun.push_back(progress); }
  void progress(const PlanProgress& progress) override { received.push_back(progress); }
  void incumbent(std::string) override { ADD_FAILURE() << "a simulation has no incumbents"; }

  std::vector<PlanProgress> begun;
  std::vector<PlanProgress> received;
};

TEST(SimulateEndpoint, ReportsProgress) {
  Events events;
  RequestContext context;
  context.events = &events;
  Json request = simulate_request();
  request["runs"] = 200;
  simulated(request, context);
  ASSERT_EQ(events.begun.size(), 1U);
  ASSERT_GE(events.received.size(), 3U);
  std::size_t done = 0;
  for (const PlanProgress& progress : events.received) {
    ASSERT_TRUE(progress.simulation);
    EXPECT_EQ(progress.simulation->runs, 200U);
    EXPECT_GE(progress.simulation->done, done);
    done = progress.simulation->done;
  }
  EXPECT_GT(done, 0U);
  EXPECT_EQ(write_progress({2, {}, core::SimulationProgress{10, 20, 3, 1}}, 1.5),
            R"({"elapsed_ms":1.5,"runs":20,"done":10,"collided":3,"deadlocked":1})");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
