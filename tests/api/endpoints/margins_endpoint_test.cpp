#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"
#include "tests/support/step_limit.h"
#include "tests/support/threaded_executor.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

/// Two robots whose ways cross, with stops now and then.
Json margins_request(const char* policy = "dependencies") {
  Json body = Json::parse(R"({
    "request": {
      "map": {"rows": [".........", ".........", ".........", "........."]},
      "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
      "robots": [
        {"id": "a", "start": {"x": 0.5, "y": 1.5, "theta": 0.0}, "goal": {"x": 8.5, "y": 1.5}},
        {"id": "b", "start": {"x": 4.5, "y": 3.5, "theta": -1.5}, "goal": {"x": 4.5, "y": 0.5}}
      ],
      "options": {"time_budget_ms": 100000}},
    "disturbance": {"speed": {"min": 0.8, "max": 1}, "stops": {"rate_per_hour": 120, "mean_s": 2}},
    "aim": {"collisions": 0.05}})");
  body["policy"] = policy;
  return body;
}

Reply reply_with_margins(const Json& body, const RequestContext& context = {}) {
  return margins_endpoint(body.dump(), context);
}

Json margins_of(const Json& body, const RequestContext& context = {}) {
  const Reply reply = reply_with_margins(body, context);
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults_of_margins(const Json& body) {
  const Reply reply = reply_with_margins(body);
  EXPECT_EQ(reply.status, 422) << reply.body;
  return faults_in(reply);
}

/// The figures of POST /v1/simulate for the plan that was found, with other disturbances.
Json simulated_again(const Json& body, const Json& answer, int runs) {
  Json request = body["request"];
  for (const auto& [key, value] : answer["plan"].items()) request[key] = value;
  for (const auto& [key, value] : answer["options"].items()) request["options"][key] = value;
  for (const char* member : {"policy", "disturbance", "max_delay"}) {
    if (body.contains(member)) request[member] = body[member];
  }
  request["runs"] = runs;
  request["seed"] = 77;
  return answer_of(simulate_endpoint, request);
}

TEST(MarginsEndpoint, FindsThePlanThatHolds) {
  const Json body = margins_request();
  const Json answer = margins_of(body);
  EXPECT_EQ(answer["met"], true);
  EXPECT_EQ(answer["deterministic"], true);
  EXPECT_EQ(answer["tried"].size(), 6U);
  const Json& best = answer["tried"][answer["best"].get<std::size_t>()];
  EXPECT_EQ(best["status"], "met");
  EXPECT_EQ(best["options"], answer["options"]);
  EXPECT_EQ(best["planned"]["flowtime"], answer["plan"]["flowtime"]);
  EXPECT_EQ(best["tight"], answer["plan"]["tight"].size());
  EXPECT_LE(best["share_high"].get<double>(), 0.05);
  EXPECT_EQ(answer["plan"]["status"], "solved");
  EXPECT_EQ(answer["plan"]["verified"], true);
  EXPECT_LE(simulated_again(body, answer, 1000)["collision_share"].get<double>(), 0.05);
}

TEST(MarginsEndpoint, SaysThatDelaysAddUpInOpenLoop) {
  Json body = margins_request("open_loop");
  body["disturbance"]["stops"]["rate_per_hour"] = 1200;
  body["disturbance"]["stops"]["mean_s"] = 20;
  body["aim"] = {{"collisions", 0.001}};
  body["runs"] = 20'000;
  const Json answer = margins_of(body);
  EXPECT_EQ(answer["met"], false);
  EXPECT_TRUE(answer["best"].is_null());
  EXPECT_TRUE(answer["plan"].is_null());
  EXPECT_EQ(answer["tried"].size(), 12U);
  EXPECT_THAT(answer["advice"].dump(), HasSubstr("dependencies"));
  for (const Json& tried : answer["tried"]) {
    EXPECT_EQ(tried["bad"].get<int>(), tried["collided"].get<int>() + tried["deadlocked"].get<int>());
    EXPECT_LE(tried["share_low"], tried["share"]);
    EXPECT_LE(tried["share"], tried["share_high"]);
  }
}

TEST(MarginsEndpoint, ExecutesThePlanThatItReturns) {
  const Json body = margins_request();
  Json again = body;
  again["aim"] = {{"collisions", 0.5}};
  again["try"] = Json::parse(R"({"interval_margin": [0]})");
  again["runs"] = 100;
  const Json answer = margins_of(again);
  ASSERT_EQ(answer["met"], true) << answer["tried"];
  Json request = again["request"];
  request["options"]["dependencies"] = true;
  Json plan = json_of(plan_endpoint(request.dump(), {}));
  Json returned = answer["plan"];
  for (const char* member : {"timings_ms", "request_id"}) {
    returned.erase(member);
    plan.erase(member);
  }
  EXPECT_EQ(returned, plan);
  const Json figures = simulated_again(again, answer, 50);
  Json same_seed = again["request"];
  for (const auto& [key, value] : answer["plan"].items()) same_seed[key] = value;
  same_seed["policy"] = "dependencies";
  same_seed["disturbance"] = again["disturbance"];
  same_seed["runs"] = answer["tried"][0]["runs"];
  const Json simulated = answer_of(simulate_endpoint, same_seed);
  const double share =
      answer["tried"][0]["collided"].get<double>() / answer["tried"][0]["runs"].get<double>();
  EXPECT_EQ(simulated["collision_share"], share);
  EXPECT_NEAR(simulated["flowtime"]["mean"].get<double>(),
              answer["tried"][0]["executed"]["flowtime"].get<double>(), 1e-9);
}

TEST(MarginsEndpoint, GivesNothingLessThanTheRequestAsksFor) {
  Json body = margins_request();
  body["request"]["options"]["interval_margin"] = 0.5;
  body["request"]["options"]["inflation"] = 0.05;
  const Json answer = margins_of(body);
  ASSERT_EQ(answer["tried"].size(), 4U);  // 0.5, 1, 2, 4
  for (const Json& tried : answer["tried"]) {
    EXPECT_GE(tried["options"]["interval_margin"], 0.5);
    EXPECT_EQ(tried["options"]["inflation"], 0.05);
    EXPECT_EQ(tried["options"]["execution_margin"], 0.05);
  }
}

TEST(MarginsEndpoint, TriesValuesForRobotsThatLeaveTheirWay) {
  Json body = margins_request();
  body["disturbance"]["cross_track"] = {{"sigma", 0.02}, {"correlation_length", 1.0}};
  body["try"]["interval_margin"] = {0.5};
  const Json answer = margins_of(body);
  // The base, and 0.5 s with 0, 2, 3 and 4 times sigma.
  ASSERT_EQ(answer["tried"].size(), 5U);
  EXPECT_EQ(answer["tried"][4]["options"]["inflation"], 0.08);
}

TEST(MarginsEndpoint, AddsTheDelayOfTheClock) {
  Json body = margins_request("clock_stop");
  body["max_delay"] = 1.5;
  const Json answer = margins_of(body);
  ASSERT_EQ(answer["tried"].size(), 6U);
  EXPECT_EQ(answer["tried"][1]["options"]["interval_margin"], 1.75);
  EXPECT_FALSE(answer["tried"][1]["options"].contains("dependencies"));
  EXPECT_TRUE(answer["tried"][1]["tight"].is_null());
}

TEST(MarginsEndpoint, HasTheSameFiguresForAnyNumberOfWorkers) {
  const Json body = margins_request("absorb_waits");
  support::ThreadedExecutor executor(3);
  RequestContext context;
  context.executor = &executor;
  Json alone = margins_of(body);
  Json together = margins_of(body, context);
  for (Json* answer : {&alone, &together}) {
    if (!(*answer)["plan"].is_null()) (*answer)["plan"].erase("timings_ms");
  }
  EXPECT_EQ(alone, together);
}

TEST(MarginsEndpoint, CountsTheBodiesOfRobots) {
  Json body = margins_request();
  body["request"]["robot_defaults"]["body_radius"] = 0.9;
  const Json answer = margins_of(body);
  EXPECT_EQ(answer["met"], false);
  EXPECT_EQ(answer["tried"][0]["bad"], answer["tried"][0]["runs"]);
  EXPECT_EQ(answer["tried"][0]["pairs"][0]["robots"], (Json{"a", "b"}));
}

TEST(MarginsEndpoint, SaysWhatNoMarginChanges) {
  Json body = margins_request();
  body["request"]["robots"][1]["goal"] = {{"x", 7.5}, {"y", 2.5}};
  body["request"]["robot_defaults"]["body_radius"] = 0.8;
  const Json answer = margins_of(body);
  EXPECT_THAT(answer["advice"].dump(), HasSubstr("stand at their starts or last goals"));
}

TEST(MarginsEndpoint, NamesRobotsWithoutAPlan) {
  Json body = margins_request();
  body["request"]["map"]["rows"] = {".........", "........#", ".......#.", "........#"};
  body["request"]["robots"][0]["goal"] = {{"x", 8.5}, {"y", 1.5}};
  const Json answer = margins_of(body);
  EXPECT_THAT(answer["warnings"].dump(), HasSubstr("Robots without a plan"));
  EXPECT_EQ(answer["plan"]["status"], "partial");
}

TEST(MarginsEndpoint, DoesNotPlanCandidatesThatLeaveRobotsUnplanned) {
  Json body = margins_request();
  body["try"] = Json::parse(R"({"inflation": [0, 0.6], "interval_margin": [0.5]})");  // too wide for the map
  const Json answer = margins_of(body);
  ASSERT_EQ(answer["tried"].size(), 3U);
  EXPECT_EQ(answer["tried"][2]["status"], "not_planned");
  EXPECT_TRUE(answer["tried"][2]["planned"].is_null());
  EXPECT_TRUE(answer["tried"][2]["share"].is_null());
}

TEST(MarginsEndpoint, RejectsWhatCannotBeAnswered) {
  const auto faults = [](const char* patch) {
    Json body = margins_request();
    body.merge_patch(Json::parse(patch));
    return faults_of_margins(body);
  };
  EXPECT_THAT(faults(R"({"request": null})"), Contains(Pair("/request", "missing")));
  EXPECT_THAT(faults(R"({"request": {"plans": []}})"), Contains(Pair("/request/plans", "unknown_key")));
  EXPECT_THAT(faults(R"({"request": {"robots": [{"id": "a"}]}})"),
              Contains(Pair("/request/robots/0/start", "missing")));
  EXPECT_THAT(faults(R"({"disturbance": {"speed": {"min": 1, "max": 1}, "stops": null}})"),
              Contains(Pair("/disturbance", "empty")));
  EXPECT_THAT(faults(R"({"policy": "clock_stop"})"), Contains(Pair("/max_delay", "missing")));
  EXPECT_THAT(faults(R"({"aim": {"collisions": 0.00001}})"),
              Contains(Pair("/aim/collisions", "out_of_range")));
  EXPECT_THAT(faults(R"({"runs": 49})"), Contains(Pair("/runs", "out_of_range")));
  EXPECT_THAT(faults(R"({"runs": 100})"), Contains(Pair("/runs", "out_of_range")));
  EXPECT_THAT(faults(R"({"aim": {"collisions": 0.0001, "confidence": 0.9999}})"),
              Contains(Pair("/aim", "out_of_range")));
  EXPECT_THAT(faults(R"({"try": {"wait_before_move": [1]}})"),
              Contains(Pair("/try/wait_before_move", "unknown_key")));
  EXPECT_THAT(faults(R"({"try": {"interval_margin": [1, 1]}})"),
              Contains(Pair("/try/interval_margin/1", "out_of_range")));
  EXPECT_THAT(faults(R"({"try": {"interval_margin": []}})"), Contains(Pair("/try/interval_margin", "empty")));
  EXPECT_THAT(faults(R"({"policy": "open_loop", "try": {"interval_margin": [1,2,3,4,5,6,7,8],
                         "inflation": [0, 0.1, 0.2, 0.3, 0.4], "wait_before_move": [0, 1]}})"),
              Contains(Pair("/try", "out_of_range")));
}

class MarginEvents final : public PlanEvents {
 public:
  void begin(const PlanProgress& progress) override { begun.push_back(progress); }
  void progress(const PlanProgress& progress) override { received.push_back(progress); }
  void incumbent(std::string) override { ADD_FAILURE() << "margins have no incumbents"; }

  std::vector<PlanProgress> begun;
  std::vector<PlanProgress> received;
};

TEST(MarginsEndpoint, ReportsProgressOfMargins) {
  MarginEvents events;
  RequestContext context;
  context.events = &events;
  margins_of(margins_request(), context);
  ASSERT_EQ(events.begun.size(), 1U);
  std::size_t plans = 0;
  for (const PlanProgress& progress : events.received) {
    ASSERT_TRUE(progress.margins);
    EXPECT_EQ(progress.margins->candidates, 6U);
    plans += progress.margins->stage == core::MarginProgress::Stage::plan ? 1 : 0;
  }
  EXPECT_EQ(plans, 6U);
  EXPECT_GT(events.received.size(), 12U);
  PlanProgress progress;
  progress.margins = core::MarginProgress{2, 6, core::MarginProgress::Stage::execute, 64, 3};
  EXPECT_EQ(write_progress(progress, 1.5),
            R"({"elapsed_ms":1.5,"candidate":2,"candidates":6,"stage":"execute","runs":64,"bad":3})");
}

TEST(MarginsEndpoint, SaysWhatTheTimeDidNotAllow) {
  bool any_cut = false;
  for (const std::int64_t steps : {1'000, 20'000, 60'000, 150'000}) {
    support::StepLimit limit(steps, 1'000'000);
    RequestContext context;
    context.early_end = &limit;
    const Reply reply = reply_with_margins(margins_request(), context);
    if (reply.status != 200) {
      EXPECT_EQ(reply.problem, "check_unfinished") << reply.body;
      continue;
    }
    const Json answer = json_of(reply);
    if (answer["deterministic"] == true) continue;
    any_cut = true;
    EXPECT_THAT(answer["warnings"].dump(), HasSubstr("time_budget_ms"));
    EXPECT_GE(answer["tried"][0]["runs"], 50);
  }
  EXPECT_TRUE(any_cut);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
