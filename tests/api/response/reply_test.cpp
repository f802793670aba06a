// The outcome of a plan for metrics and the log.

#include "api/response/reply.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <tuple>

#include "api/endpoints/endpoints.h"
#include "api/json/errors.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {

namespace TEST_FILE {

constexpr ErrorCode kLast = ErrorCode::draining;

TEST(Errors, HaveACompleteRowForEachCode) {
  std::set<std::string> names;
  for (int code = 0; code <= static_cast<int>(kLast); ++code) {
    const Json body = json_of(problem_reply(static_cast<ErrorCode>(code), "Because.", "id-1"));
    const std::string name(name_of(static_cast<ErrorCode>(code)));
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(body["type"], "urn:fleetplan:problem:" + name);
    EXPECT_EQ(body["code"], name);
    EXPECT_GT(body["title"].get<std::string>().size(), 5U);
    EXPECT_EQ(body["detail"], "Because.");
    EXPECT_EQ(body["request_id"], "id-1");
    EXPECT_EQ(body["errors"], Json::array());
  }
}

TEST(Errors, HaveTheDocumentedStatus) {
  const std::vector<std::tuple<ErrorCode, int, std::string>> rows{
      {ErrorCode::malformed_json, 400, "malformed_json"},
      {ErrorCode::too_deep, 400, "too_deep"},
      {ErrorCode::malformed_request, 400, "malformed_request"},
      {ErrorCode::unauthorized, 401, "unauthorized"},
      {ErrorCode::foreign_origin, 403, "foreign_origin"},
      {ErrorCode::not_found, 404, "not_found"},
      {ErrorCode::method_not_allowed, 405, "method_not_allowed"},
      {ErrorCode::not_acceptable, 406, "not_acceptable"},
      {ErrorCode::request_timeout, 408, "request_timeout"},
      {ErrorCode::body_too_large, 413, "body_too_large"},
      {ErrorCode::target_too_long, 414, "target_too_long"},
      {ErrorCode::unsupported_media_type, 415, "unsupported_media_type"},
      {ErrorCode::wrong_host, 421, "wrong_host"},
      {ErrorCode::invalid_request, 422, "invalid_request"},
      {ErrorCode::check_unfinished, 422, "check_unfinished"},
      {ErrorCode::memory_exceeded, 422, "memory_exceeded"},
      {ErrorCode::parse_unfinished, 422, "parse_unfinished"},
      {ErrorCode::head_too_large, 431, "head_too_large"},
      {ErrorCode::internal_error, 500, "internal_error"},
      {ErrorCode::overloaded, 503, "overloaded"},
      {ErrorCode::draining, 503, "draining"},
  };
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(kLast) + 1);
  for (const auto& [code, status, name] : rows) {
    const Reply reply = problem_reply(code, "x", "y");
    EXPECT_EQ(status_of(code), status);
    EXPECT_EQ(reply.status, status);
    EXPECT_EQ(json_of(reply)["status"], status);
    EXPECT_EQ(name_of(code), name);
    EXPECT_EQ(reply.content_type, "application/problem+json");
  }
}

TEST(Errors, ListEveryFault) {
  const Json body = json_of(problem_reply(
      {ErrorCode::invalid_request, "Two.", {{"/a", "missing", "A \"quoted\" word."}, {"/b~1c", "x", "y"}}, 7},
      "i"));
  EXPECT_EQ(body["errors_total"], 7);
  EXPECT_EQ(body["errors"], Json::parse(R"([
    {"pointer": "/a", "code": "missing", "detail": "A \"quoted\" word."},
    {"pointer": "/b~1c", "code": "x", "detail": "y"}])"));
}

using Status = PlanOutcome::Status;

TEST(PlanOutcome, MatchesTheAnswer) {
  const Reply reply = plan_endpoint(swap_request().dump(), {});
  const Json answer = json_of(reply);
  ASSERT_TRUE(reply.outcome);
  EXPECT_EQ(reply.outcome->status, Status::solved);
  EXPECT_EQ(reply.outcome->planned, 2U);
  EXPECT_EQ(reply.outcome->unplanned, 0U);
  EXPECT_EQ(reply.outcome->expansions, answer["search"]["expansions"]);
  EXPECT_EQ(reply.outcome->flowtime, answer["flowtime"]);
  ASSERT_TRUE(reply.outcome->plan_seconds);
  EXPECT_NEAR(*reply.outcome->plan_seconds * 1000.0, answer["timings_ms"]["plan"].get<double>(), 1e-6);
  EXPECT_TRUE(reply.problem.empty());
}

TEST(PlanOutcome, HasNoPlanningTimeWhenTheBudgetWasSpentInTheQueue) {
  RequestContext late;
  late.received_at = RequestContext::Clock::now() - std::chrono::hours(1);
  const Reply reply = plan_endpoint(swap_request().dump(), late);
  ASSERT_TRUE(reply.outcome);
  EXPECT_EQ(reply.outcome->status, Status::none);
  EXPECT_EQ(reply.outcome->unplanned, 2U);
  EXPECT_FALSE(reply.outcome->plan_seconds);
}

TEST(PlanOutcome, IsRefusedWhenTheCheckerRejectsThePlan) {
  const Planner without_motion = [](const core::Problem&, const auto&, const auto&, auto*) {
    core::Plan plan;
    plan.plans = {{0, 0.0, {}}, {1, 0.0, {}}};  // both stay at their starts, away from their goals
    return plan;
  };
  const Reply reply = plan_with(without_motion, swap_request().dump(), {});
  EXPECT_EQ(reply.problem, "internal_error");
  ASSERT_TRUE(reply.outcome);
  EXPECT_EQ(reply.outcome->status, Status::refused);
}

TEST(PlanOutcome, IsAbsentForAnInvalidRequest) {
  const Reply reply = plan_endpoint("{}", {});
  EXPECT_EQ(reply.problem, "invalid_request");
  EXPECT_FALSE(reply.outcome);
}

TEST(PlanOutcome, IsPartialWhenSomeRobotsHaveAPlanAndNoneWhenNoRobotHas) {
  core::Plan plan;
  plan.unplanned.emplace_back();
  EXPECT_EQ(status_of(plan), Status::none);
  plan.plans.emplace_back();
  EXPECT_EQ(status_of(plan), Status::partial);
  plan.unplanned.clear();
  EXPECT_EQ(status_of(plan), Status::solved);
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
