// The outcome of a plan for metrics and the log.

#include "api/response/plan_outcome.h"

#include <gtest/gtest.h>

#include <chrono>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

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
