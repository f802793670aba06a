// The events that are sent during planning.

#include <gtest/gtest.h>

#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/request_context.h"
#include "core/plan/planner.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

class Events : public PlanEvents {
 public:
  void begin(const PlanProgress& progress) override { begun.push_back(progress); }
  void progress(const PlanProgress& progress) override { received.push_back(progress); }
  void incumbent(std::string answer) override { incumbents.push_back(Json::parse(answer)); }

  std::vector<PlanProgress> begun;
  std::vector<PlanProgress> received;
  std::vector<Json> incumbents;
};

RequestContext context_with(Events& events) {
  RequestContext context;
  context.request_id = "test-8";
  context.events = &events;
  return context;
}

Json anytime_request() {
  Json request = swap_request();
  request["options"] = {{"mode", "anytime"}, {"max_iterations", 50}, {"time_budget_ms", 60'000}};
  return request;
}

/// The members of an answer that are the same for every run.
Json without_timings(Json answer) {
  answer.erase("timings_ms");
  answer.erase("request_id");
  return answer;
}

TEST(WriteProgress, WritesTheDocumentedMembers) {
  EXPECT_EQ(write_progress({3}, 0.5), R"({"elapsed_ms":0.5,"attempt":0,"planned":0,"robots":3,"best":null})");
  EXPECT_EQ(write_progress({12, {4, 11, core::Objectives{80.5, 20.0}}}, 1250.0),
            R"({"elapsed_ms":1250.0,"attempt":4,"planned":11,"robots":12,)"
            R"("best":{"flowtime":80.5,"makespan":20.0}})");
}

TEST(PlanEvents, DoNotBeginForARequestWithFaults) {
  Json no_way = swap_request();
  no_way["robots"][0]["start"]["x"] = -1.0;
  for (const std::string& body : {std::string("{"), std::string("[]"), no_way.dump()}) {
    Events events;
    EXPECT_GE(plan_endpoint(body, context_with(events)).status, 400);
    EXPECT_TRUE(events.begun.empty());
    EXPECT_TRUE(events.received.empty());
  }
}

TEST(PlanEvents, BeginOnceAndEndWithTheNumbersOfTheAnswer) {
  Events events;
  const Json answer = json_of(plan_endpoint(anytime_request().dump(), context_with(events)));
  ASSERT_EQ(events.begun.size(), 1U);
  EXPECT_EQ(events.begun[0].robots, 2U);
  ASSERT_FALSE(events.received.empty());
  for (const PlanProgress& progress : events.received) EXPECT_EQ(progress.robots, 2U);
  const core::Progress& last = events.received.back().planner;
  EXPECT_EQ(last.planned, 2U);
  EXPECT_EQ(last.attempts, answer["search"]["attempts"].get<std::int64_t>());
  ASSERT_TRUE(last.best);
  EXPECT_EQ(last.best->flowtime, answer["flowtime"].get<double>());
  EXPECT_EQ(last.best->makespan, answer["makespan"].get<double>());
}

TEST(PlanEvents, DoNotChangeTheAnswer) {
  for (const Json& request : {swap_request(), anytime_request()}) {
    Events events;
    const Json answer = json_of(plan_endpoint(request.dump(), context_with(events)));
    EXPECT_EQ(answer["deterministic"], true);
    EXPECT_EQ(without_timings(answer), without_timings(json_of(plan_endpoint(request.dump(), {}))));
  }
}

TEST(PlanEvents, HaveIncumbentsThatAreCompleteAnswers) {
  Events events;
  const Json request = anytime_request();
  const Json answer = json_of(plan_endpoint(request.dump(), context_with(events)));
  ASSERT_FALSE(events.incumbents.empty());
  for (const Json& incumbent : events.incumbents) {
    EXPECT_EQ(incumbent["status"], "solved");
    EXPECT_EQ(incumbent["verified"], true);
    EXPECT_EQ(incumbent["deterministic"], false) << "the clock decided when it was shown";
    EXPECT_EQ(incumbent["request_id"], "test-8");
    EXPECT_GE(incumbent["flowtime"].get<double>(), answer["flowtime"].get<double>());
    for (std::size_t robot = 0; robot < 2; ++robot) {
      EXPECT_NEAR(incumbent["plans"][robot]["lower_bound"].get<double>(),
                  answer["plans"][robot]["lower_bound"].get<double>(), 1e-9);
    }
    for (const auto& member : answer.items()) EXPECT_TRUE(incumbent.contains(member.key())) << member.key();
    Json both = request;
    both.update(incumbent);
    EXPECT_EQ(json_of(validate_endpoint(both.dump(), {}))["valid"], true);
  }
}

TEST(PlanEvents, HaveNoIncumbentWhenTheFirstSolutionIsTheAnswer) {
  Events events;
  EXPECT_EQ(plan_endpoint(swap_request().dump(), context_with(events)).status, 200);
  EXPECT_TRUE(events.incumbents.empty());
}

TEST(PlanEvents, HaveNoIncumbentForReceiversThatWantNone) {
  class OnlyProgress final : public Events {
    bool wants_incumbents() const override { return false; }
  };
  OnlyProgress events;
  EXPECT_EQ(plan_endpoint(anytime_request().dump(), context_with(events)).status, 200);
  EXPECT_FALSE(events.received.empty());
  EXPECT_TRUE(events.incumbents.empty());
}

TEST(PlanEvents, BeginEvenWhenTheBudgetIsSpent) {
  Events events;
  RequestContext late = context_with(events);
  late.received_at -= std::chrono::minutes(2);
  EXPECT_EQ(json_of(plan_endpoint(anytime_request().dump(), late))["status"], "none");
  EXPECT_EQ(events.begun.size(), 1U);
  EXPECT_TRUE(events.incumbents.empty());
}

TEST(PlanEvents, NeverHaveAnIncumbentThatTheCheckerRejects) {
  const Planner shows_a_collision = [](const core::Problem& problem, const core::PlanOptions& options,
                                       const core::StopCondition& stop, core::Observer* observer) {
    core::Plan through_the_wall;
    const core::Pose goal{problem.robots()[0].goal->position, 0.0};
    through_the_wall.plans.push_back(
        {0, 8.0, {{core::Action::Type::translate, 0.0, 8.0, problem.robots()[0].start, goal}}});
    through_the_wall.unplanned.push_back({1, core::Unplanned::Reason::blocked_by_robots, "", {0}});
    EXPECT_TRUE(observer->wants_plan());
    observer->show(through_the_wall);
    EXPECT_FALSE(observer->wants_plan());
    return core::plan(problem, options, stop);
  };
  Events events;
  const Reply reply = plan_with(shows_a_collision, anytime_request().dump(), context_with(events));
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(json_of(reply)["code"], "internal_error");
  EXPECT_TRUE(events.incumbents.empty());
}

TEST(PlanEvents, HaveIncumbentsWithThePosesTheyAreMadeFor) {
  // A parked robot fills the door of the first dock, so the second one is tried.
  const Json request = Json::parse(R"({
    "map": {"rows": ["..........", "......####", "..........", "......####", ".........."]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1, "angular_speed": 2},
    "robots": [
      {"id": "a", "start": {"x": 0.5, "y": 2.5},
       "goal": {"any_of": [{"x": 8.5, "y": 2.5}, {"x": 8.5, "y": 0.5}]}},
      {"id": "parked", "start": {"x": 6.5, "y": 2.5}}]})");
  const Planner shows_every_plan = [](const core::Problem& problem, const core::PlanOptions& options,
                                      const core::StopCondition& stop, core::Observer* observer) {
    core::Plan plan = core::plan(problem, options, stop);
    observer->show(plan);
    return plan;
  };
  Events events;
  const Reply reply = plan_with(shows_every_plan, request.dump(), context_with(events));
  ASSERT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(json_of(reply)["plans"][0]["visits"][0]["choice"], 1);
  ASSERT_EQ(events.incumbents.size(), 2U);
  EXPECT_EQ(events.incumbents[0]["status"], "partial");
  EXPECT_EQ(events.incumbents[1]["plans"], json_of(reply)["plans"]);
}

/// A plan that is shown to an observer.
class Shown {
 public:
  core::CheckedPlan plan() const { return {task_, plan_, report_, times_, planning_}; }

 private:
  const core::PlanTask task_{std::get<core::Problem>(core::Problem::create(core::OccupancyGrid(1, 1, 1.0), {},
                                                                           {}, core::StopCondition::never())),
                             {}};
  const core::Plan plan_ = {};
  const std::optional<core::VerifyReport> report_ = std::nullopt;
  const core::PlanTimes times_{core::StopCondition::Clock::now()};
  const core::StopCondition planning_ = core::StopCondition::never();
};

TEST(ProgressReporter, RequestsPlansAtMostOnceASecond) {
  Events events;
  const auto answer = [](const core::CheckedPlan&) { return Reply{200, kJson, "{}"}; };
  ProgressReporter reporter(events, 1, ProgressReporter::Clock::time_point::max(), answer);
  ASSERT_TRUE(reporter.wants_plan());
  const auto begin = ProgressReporter::Clock::now();
  reporter.show(Shown().plan());
  EXPECT_EQ(events.incumbents.size(), 1U);
  while (!reporter.wants_plan()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GE(ProgressReporter::Clock::now() - begin, std::chrono::seconds(1));
}

TEST(ProgressReporter, RequestsNoPlanShortlyBeforeTheDeadline) {
  Events events;
  const auto answer = [](const core::CheckedPlan&) { return Reply{}; };
  const auto soon = ProgressReporter::Clock::now() + ProgressReporter::kQuietEnd;
  EXPECT_FALSE(ProgressReporter(events, 1, soon, answer).wants_plan());
  EXPECT_TRUE(ProgressReporter(events, 1, soon + std::chrono::minutes(1), answer).wants_plan());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
