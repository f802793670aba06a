#include "core/plan/make_plan.h"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/plan/planner.h"
#include "core/runtime/memory_account.h"
#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr auto kSecond = std::chrono::seconds(1);

/// Docks in two rooms of their own. A parked robot fills the door of the nearer one, unless it is left out.
PlanTask docks(bool is_blocked = true) {
  std::vector<Robot> robots{robot_at(0.5, 2.5).to(8.5, 2.5)};
  if (is_blocked) robots.push_back(robot_at(6.5, 2.5));
  PlanTask task{support::make_problem(support::ascii_map({"..........",  //
                                                          "......####",  //
                                                          "..........",  //
                                                          "......####",  //
                                                          ".........."}),
                                      robots),
                {}};
  const Alternative near{{8.5, 2.5}, {}, 0.0, 0};
  const Alternative far{{8.5, 0.5}, {}, 0.0, 1};
  OpenGoals goals(robots.size());
  goals[0].push_back({.goal = 0, .poses = {near, far}});
  task.open = OpenFleet{task.problem.robots(), std::move(goals)};
  return task;
}

/// Keeps what it is shown.
class Witness final : public PlanObserver {
 public:
  struct Shown {
    std::size_t unplanned;
    std::size_t choice;
    bool is_valid;
  };

  void progressed(const Progress& /*progress*/) override {}
  bool wants_plan() override { return true; }
  void show(const CheckedPlan& plan) override {
    shown.push_back({plan.plan.unplanned.size(), plan.task.open->goals[0][0].choice().number,
                     plan.report && plan.report->valid()});
  }

  std::vector<Shown> shown;
};

class MakePlan : public testing::Test {
 protected:
  PlanMeans means(const StopCondition& stop = StopCondition::never()) {
    return {.stop = stop, .patience = {kSecond, kSecond, kSecond}, .executor = thread_};
  }

 private:
  CallerThread thread_;
};

TEST_F(MakePlan, ChoosesAPoseAndChecksThePlan) {
  const MadePlan made = make_plan(docks(false), means());
  EXPECT_TRUE(made.is_searched);
  EXPECT_TRUE(made.plan.unplanned.empty());
  ASSERT_TRUE(made.report);
  EXPECT_TRUE(made.report->valid());
  EXPECT_EQ(made.task.open->goals[0][0].choice().number, 0U);
  EXPECT_GE(made.times.planned, made.times.begun);
}

TEST_F(MakePlan, GivesARobotThatIsBlockedAnotherPose) {
  const MadePlan made = make_plan(docks(), means());
  EXPECT_TRUE(made.plan.unplanned.empty());
  EXPECT_EQ(made.task.open->goals[0][0].choice().number, 1U);
  EXPECT_EQ(made.task.problem.robots()[0].goal->position, Position(8.5, 0.5));
  ASSERT_TRUE(made.report);
  EXPECT_TRUE(made.report->valid());
}

TEST_F(MakePlan, LeavesPosesAsTheyAreIfThereIsNoOther) {
  PlanTask task = docks();
  task.open->goals[0][0].poses.pop_back();
  const MadePlan made = make_plan(std::move(task), means());
  ASSERT_EQ(made.plan.unplanned.size(), 1U);
  EXPECT_EQ(made.plan.unplanned[0].reason, Unplanned::Reason::blocked_by_robots);
  EXPECT_EQ(made.task.open->goals[0][0].choice().number, 0U);
}

TEST_F(MakePlan, ShowsPlansCheckedWithThePosesTheyAreFor) {
  Witness witness;
  PlanMeans with_witness = means();
  with_witness.observer = &witness;
  with_witness.planner = [](const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                            Observer* observer) {
    const Plan made = plan(problem, options, stop);
    EXPECT_TRUE(observer->wants_plan());
    observer->show(made);
    return made;
  };
  make_plan(docks(), with_witness);
  ASSERT_EQ(witness.shown.size(), 2U);
  for (const Witness::Shown& shown : witness.shown) EXPECT_TRUE(shown.is_valid);
  EXPECT_EQ(witness.shown[0].unplanned, 1U);
  EXPECT_EQ(witness.shown[0].choice, 0U);
  EXPECT_EQ(witness.shown[1].unplanned, 0U);
  EXPECT_EQ(witness.shown[1].choice, 1U);
}

TEST_F(MakePlan, ShowsNoPlanWithOtherPosesThatIsNotBetter) {
  Witness witness;
  PlanMeans with_witness = means();
  with_witness.observer = &witness;
  std::optional<Plan> first;
  with_witness.planner = [&](const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                             Observer* observer) {
    if (!first) first = plan(problem, options, stop);
    observer->show(*first);
    EXPECT_EQ(observer->wants_plan(),
              witness.shown.size() == 1 && problem.robots()[0].goal->position.y() == 2.5);
    return *first;
  };
  const MadePlan made = make_plan(docks(), with_witness);
  EXPECT_EQ(witness.shown.size(), 1U);
  EXPECT_EQ(made.task.open->goals[0][0].choice().number, 0U);
}

TEST_F(MakePlan, DoesNotPlanWhenTheTimeIsOver) {
  std::stop_source source;
  source.request_stop();
  const StopCondition late(StopCondition::Clock::now());
  const StopCondition cancelled(StopCondition::Clock::time_point::max(), source.get_token());
  for (const StopCondition& stop : {late, cancelled}) {
    PlanMeans without_time = means(stop);
    without_time.planner = [](const auto&, const auto&, const auto&, auto*) -> Plan {
      ADD_FAILURE() << "the planner was called";
      return {};
    };
    const MadePlan made = make_plan(docks(), without_time);
    EXPECT_FALSE(made.is_searched);
    ASSERT_EQ(made.plan.unplanned.size(), 1U);
    EXPECT_EQ(made.plan.unplanned[0].reason, Unplanned::Reason::budget_exhausted);
    EXPECT_EQ(made.plan.unplanned[0].detail.find("stopped") != std::string::npos, stop.cancelled());
    ASSERT_TRUE(made.report);
    EXPECT_TRUE(made.report->valid());
  }
}

TEST_F(MakePlan, PlansNobodyIfTheJobIsGrantedTooLittleMemory) {
  PlanMeans without_memory = means();
  without_memory.planner = [](const auto&, const auto&, const auto&, auto*) -> Plan {
    throw std::bad_alloc();
  };
  EXPECT_THROW(make_plan(docks(), without_memory), std::bad_alloc) << "no job: the process lacks it";
  MemoryAccount account(std::size_t{1} << 40);
  const MemoryScope scope(&account);
  const MadePlan made = make_plan(docks(), without_memory);
  ASSERT_EQ(made.plan.unplanned.size(), 1U);
  EXPECT_EQ(made.plan.unplanned[0].detail, kMemorySpent);
  ASSERT_TRUE(made.report);
  EXPECT_TRUE(made.report->valid());
}

TEST_F(MakePlan, EndsWhenItsTurnDoes) {
  PlanMeans shared = means(StopCondition(StopCondition::Clock::time_point::max()));
  int asked = 0;
  shared.go_on = [&] { return ++asked < 3; };
  shared.planner = [](const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                      Observer* observer) {
    EXPECT_EQ(observer, nullptr);
    while (!stop.met()) {
    }
    return plan(problem, options, stop);
  };
  const MadePlan made = make_plan(docks(), shared);
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(made.plan.unplanned.size(), 1U);
  EXPECT_TRUE(made.report);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
