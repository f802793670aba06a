// Budgets that end at every moment. Each endpoint gets a small request with all members together. Time ends
// after the n-th question of a stop condition, for every n until the answer is whole. The answer is never a
// 500, and comes soon.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "core/runtime/stop_condition.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/motion_requests.h"
#include "tests/support/sanitized.h"
#include "tests/support/step_limit.h"

namespace fleetplan::api {
namespace TEST_FILE {

using Endpoint = Reply (*)(std::string_view body, const RequestContext& context);

/// So many moments are tried where there are more.
constexpr std::int64_t kMoments = support::kSanitized ? 40 : 160;

/// Robots with loads, services, reverse and vicinity, one of them in a wall, among zones and people.
Json everything() {
  return Json::parse(R"({
    "map": {"rows": ["............", "............", "....##......", "....##......", "............",
                     "........#...", "............", "............"]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
    "robots": [
      {"id": "a", "start": {"x": 0.5, "y": 0.5}, "vicinity": 0.05, "may_reverse": true, "goals": [
        {"x": 3.5, "y": 1.5, "service": 1, "radius_after": 0.4, "linear_speed_after": 0.5, "metadata": {"order": 7}},
        {"x": 9.5, "y": 6.5, "not_before": 5, "radius_after": 0.3}]},
      {"id": "b", "start": {"x": 9.5, "y": 6.5, "theta": 3}, "goal": {"x": 1.5, "y": 6.5, "theta": 1}},
      {"id": "c", "start": {"x": 1.5, "y": 6.5}, "goal": {"x": 0.5, "y": 0.5}},
      {"id": "d", "start": {"x": 6.5, "y": 0.55}, "goal": {"x": 6.5, "y": 7.5}},
      {"id": "parked", "start": {"x": 7.12, "y": 0.5}},
      {"id": "invalid", "start": {"x": 5.0, "y": 5.0}, "goal": {"x": 11.5, "y": 0.5}}],
    "obstacles": [
      {"id": "person", "radius": 0.2, "motion": [{"t": 0, "x": 11.5, "y": 3.5}, {"t": 14, "x": 0.5, "y": 3.5}]},
      {"id": "box", "radius": 0.2, "motion": [{"t": 3, "x": 8.5, "y": 4.5}], "after": "stays"}],
    "zones": [
      {"id": "closed", "type": "blocked",
       "polygon": [{"x": 10, "y": 0}, {"x": 11, "y": 0}, {"x": 11, "y": 1}]},
      {"id": "slow", "type": "speed", "linear_speed": 0.5,
       "polygon": [{"x": 2, "y": 0}, {"x": 3, "y": 0}, {"x": 3, "y": 3}, {"x": 2, "y": 3}]},
      {"id": "north", "type": "one_way", "heading": 1.57, "half_angle": 1.6, "robots": ["d"],
       "polygon": [{"x": 6, "y": 3}, {"x": 8, "y": 3}, {"x": 8, "y": 5}, {"x": 6, "y": 5}]}],
    "options": {"time_budget_ms": 100000, "mode": "anytime", "max_iterations": 4, "inflation": 0.02,
                "interval_margin": 0.2, "wait_before_move": 0.2, "start_overlap": 0.2,
                "invalid_robots": "report", "dependencies": true, "seed": 3},
    "metadata": {"shift": 2}})");
}

Json planned() {
  static const Json answer = answer_of(plan_endpoint, everything());
  return answer;
}

/// All that may happen until two seconds later.
Json two_seconds_later() {
  Json body{{"request", everything()}, {"plans", planned()["plans"]}, {"at", 2.0}, {"commit", 3.0}};
  body["holds"] = Json::parse(R"([{"robot": "b", "until": 1.5}])");
  body["goals"] = Json::parse(R"([{"robot": "c", "goals": [{"x": 11.5, "y": 7.5, "radius_after": 0.35}]}])");
  Json pose = answer_of(advance_endpoint, body)["robots"][0]["start"];
  pose["robot"] = "a";
  body["poses"] = Json::array({pose});
  body["states"] = Json::parse(R"([{"robot": "d", "action": 0, "progress": 0.25}])");
  return body;
}

/// One robot cannot be stopped any more.
Json with_released() {
  Json body = two_seconds_later();
  body["states"][0]["released"] = {{"action", 0}, {"progress", 0.75}};
  return body;
}

/// The fleet in motion, to be planned again.
Json in_motion(const char* replan, bool has_horizon) {
  Json request = answer_of(advance_endpoint, two_seconds_later());
  request["options"]["replan"] = replan;
  if (has_horizon) request["options"]["horizon"] = 8.0;
  return request;
}

Json with_plans() {
  Json body = everything();
  body["plans"] = planned()["plans"];
  body["unplanned"] = planned()["unplanned"];
  return body;
}

Json to_simulate() {
  Json body = with_plans();
  for (const char* member : {"obstacles", "zones", "unplanned"}) body.erase(member);
  body["options"] = {{"time_budget_ms", 100000}, {"wait_before_move", 0.2}, {"inflation", 0.02}};
  body["dependencies"] = planned()["dependencies"];
  body["policy"] = "dependencies";
  body["runs"] = 4;
  body["trace"] = 1;
  body["disturbance"] = Json::parse(R"({"speed": {"min": 0.5, "max": 1}, "turn": {"min": 0.6, "max": 1},
    "stops": {"rate_per_hour": 360, "mean_s": 2}, "start_delay": {"min": 0, "max": 0.2}})");
  return body;
}

Json to_retime() {
  Json body{{"robots", everything()["robots"]},
            {"robot_defaults", everything()["robot_defaults"]},
            {"plans", planned()["plans"]},
            {"dependencies", planned()["dependencies"]},
            {"at", 1.0}};
  body["states"] = Json::parse(R"([{"robot": "b", "action": 0, "progress": 0.25, "held_s": 4}])");
  return body;
}

Json to_export() {
  Json body = to_retime();
  for (const char* member : {"at", "states"}) body.erase(member);
  body["map"] = everything()["map"];
  body["map_id"] = "hall";
  body["version"] = "2.1.0";
  body["manufacturer"] = "acme";
  body["timestamp"] = "2026-01-31T12:00:00.000Z";
  return body;
}

/// An answer in time, or a refusal because of the time.
void expect_answer(const Reply& reply) {
  EXPECT_TRUE(Json::accept(reply.body)) << reply.body;
  if (reply.status == 200) return;
  EXPECT_EQ(reply.status, 422) << reply.body;
  EXPECT_TRUE(reply.problem == "check_unfinished" || reply.problem == "parse_unfinished") << reply.body;
}

/// Questions after the last one of the time: each loop ends, and each robot may be asked about a few times.
constexpr std::int64_t kMaxLate = 200;
/// The checks of previous plans and of the answer outlast the budget of a plan by at most so many questions.
/// Here, they may take as many as they like.
constexpr std::int64_t kMaxOfChecks = 2000;
constexpr std::int64_t kPatience = 1'000'000;

/// With patience, plans are checked whenever the budget ends.
void expect_answers_at_every_moment(Endpoint endpoint, const Json& request, std::int64_t patience = 0) {
  // Spaces, so that reading looks at the clock some times.
  const std::string body = std::string(3 * core::Work::kStride, ' ') + request.dump();
  std::int64_t all = 0;
  {
    support::StepLimit limit;
    EXPECT_EQ(endpoint(body, ended_by(limit)).status, 200);
    all = limit.steps();
  }
  for (std::int64_t steps = 0; steps <= all; steps += 1 + all / kMoments) {
    SCOPED_TRACE(testing::Message() << steps << " of " << all << " steps");
    support::StepLimit limit(steps, patience);
    const Reply reply = endpoint(body, ended_by(limit));
    expect_answer(reply);
    EXPECT_LE(limit.late(), kMaxLate + (patience > 0 ? kMaxOfChecks : 0));
    if (patience > 0) {
      EXPECT_NE(reply.problem, "check_unfinished");
    }
  }
}

TEST(EveryMoment, OfAPlan) {
  for (const std::int64_t patience : {std::int64_t{0}, kPatience}) {
    expect_answers_at_every_moment(plan_endpoint, everything(), patience);
    for (const bool has_horizon : {false, true}) {
      for (const char* replan : {"all", "where_needed"}) {
        SCOPED_TRACE(replan);
        expect_answers_at_every_moment(plan_endpoint, in_motion(replan, has_horizon), patience);
      }
    }
  }
}

TEST(EveryMoment, OfAPlanWithALoadPickedUpWithinTheVicinityOfAnother) {
  expect_answers_at_every_moment(plan_endpoint, Json::parse(R"({
    "map": {"rows": ["........", "........", "........", "........"]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [
      {"id": "a", "start": {"x": 1.5, "y": 1.5},
       "goals": [{"x": 4.5, "y": 1.5, "radius_after": 0.5}, {"x": 1.5, "y": 1.5}],
       "committed": [{"type": "translate", "t_start": 0, "t_end": 3, "from": {"x": 1.5, "y": 1.5, "theta": 0},
                      "to": {"x": 4.5, "y": 1.5, "theta": 0}}]},
      {"id": "b", "start": {"x": 4.5, "y": 2.42}, "vicinity": 0.15, "goal": {"x": 7.5, "y": 2.5}}]})"),
                                 kPatience);
}

TEST(EveryMoment, OfAnAdvance) {
  expect_answers_at_every_moment(advance_endpoint, two_seconds_later());
  expect_answers_at_every_moment(advance_endpoint, with_released());
}

TEST(EveryMoment, OfACheck) { expect_answers_at_every_moment(validate_endpoint, with_plans()); }

TEST(EveryMoment, OfDependencies) { expect_answers_at_every_moment(dependencies_endpoint, with_plans()); }

TEST(EveryMoment, OfASimulation) { expect_answers_at_every_moment(simulate_endpoint, to_simulate()); }

TEST(EveryMoment, OfNewTimes) { expect_answers_at_every_moment(retime_endpoint, to_retime()); }

/// An order that goes on, and the state of its vehicle.
Json to_import() {
  Json body = to_export();
  const Json order = answer_of(vda5050_endpoint, body)["orders"][0]["order"];
  body["messages"] = {{{"serialNumber", "a"},
                       {"orderId", order["orderId"]},
                       {"orderUpdateId", 0},
                       {"lastNodeId", "n"},
                       {"lastNodeSequenceId", 0},
                       {"agvPosition", {{"x", 0.5}, {"y", 0.5}, {"theta", 0.0}}}}};
  body["base"] = {{{"robot", "a"}, {"order", order}, {"state", body["messages"][0]}}};
  body["release_ahead"] = 1.0;
  return body;
}

TEST(EveryMoment, OfAnExportThatGoesOn) {
  Json body = to_import();
  body.erase("messages");
  expect_answers_at_every_moment(vda5050_endpoint, body);
}

/// A large map with pillars, so that searches ask several times.
Json wide_hall() {
  Json hall{{"rows", Json::array()}};
  for (int row = 0; row < 80; ++row) {
    hall["rows"].push_back(row % 4 == 1 ? std::string(60, '#') + std::string(20, '.') : std::string(80, '.'));
  }
  return hall;
}

Json robot_of_the_hall() {
  return {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 1.0}, {"may_reverse", true}};
}

TEST(EveryMoment, OfAMatrix) {
  const Json places =
      Json::parse(R"([{"x": 0.5, "y": 0.5}, {"x": 30.5, "y": 41.5, "theta": 1}, {"x": 5.5, "y": 76.5}])");
  expect_answers_at_every_moment(
      matrix_endpoint,
      {{"map", wide_hall()}, {"robot", robot_of_the_hall()}, {"from", places}, {"to", places}});
}

TEST(EveryMoment, OfAnAssignment) {
  Json request{{"map", wide_hall()}, {"robot_defaults", robot_of_the_hall()}};
  request["robots"] = Json::parse(R"([{"id": "a", "start": {"x": 0.5, "y": 0.5}},
    {"id": "b", "start": {"x": 5.5, "y": 76.5}, "goal": {"x": 30.5, "y": 41.5}}])");
  const Json tasks = Json::parse(R"([{"id": "1", "goals": [{"x": 0.5, "y": 40.5}, {"x": 70.5, "y": 3.5}]},
    {"id": "2", "goals": [{"x": 3.5, "y": 60.5, "service": 1}]}])");
  expect_answers_at_every_moment(assign_endpoint, {{"request", request}, {"tasks", tasks}});
}

TEST(EveryMoment, OfAnImport) { expect_answers_at_every_moment(import_vda5050_endpoint, to_import()); }

TEST(EveryMoment, OfAnExport) { expect_answers_at_every_moment(vda5050_endpoint, to_export()); }

}  // namespace TEST_FILE
}  // namespace fleetplan::api
