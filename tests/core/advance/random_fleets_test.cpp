// Random fleets in random moments of their plans, with robots that are held, late or have new goals. Whatever
// happens, no robot is committed to drive into another robot, or stands in the way of another robot.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/advance/advance.h"
#include "core/geometry/tolerance.h"
#include "core/plan/planner.h"
#include "core/verify/check_rules.h"
#include "core/verify/verify.h"
#include "tests/support/moments.h"
#include "tests/support/random_problem.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;

StopCondition a_moment() {
  return StopCondition(StopCondition::Clock::now() + std::chrono::milliseconds(200));
}

/// The fleet from round to round.
class Fleet {
 public:
  explicit Fleet(Dice& dice) : dice_(dice), problem_(random_problem(dice)) {
    options_ = support::random_options(dice, problem_);
    options_.start_safe_interval = 0.0;
    if (dice.chance(0.5)) options_.replan = PlanOptions::Replan::where_needed;
    commits_ = dice.chance(0.5);
  }

  /// Plans, and returns what everybody executes.
  std::vector<Execution> plan() {
    const Plan plan = core::plan(problem_, options_, a_moment());
    EXPECT_TRUE(plan.unavoidable.empty())
        << "robot " << plan.unavoidable.front().robot << " at " << plan.unavoidable.front().t;
    expect_safe(plan);
    std::vector<Execution> executions;
    for (const Robot& robot : problem_.robots()) executions.push_back({robot.committed});
    for (const RobotPlan& robot : plan.plans) executions[robot.robot] = {robot.actions, true};
    makespan_ = plan.objectives.makespan;
    return executions;
  }

  /// Something happens to some robots. Goals are the goals of other robots, so that only the way there is
  /// new.
  std::vector<Robot> at_a_later_moment(std::vector<Execution> executions) {
    Moment moment;
    moment.pose_tolerance = 1e-6;
    moment.at = dice_.between(0.0, 0.3 * makespan_);
    if (commits_) moment.commit = dice_.between(0.0, 3.0);
    moment.wait_before_move = options_.wait_before_move;
    moment.inflation = options_.inflation;
    for (std::size_t k = 0; k < executions.size(); ++k) {
      Execution& execution = executions[k];
      if (dice_.chance(0.2)) execution.hold = dice_.between(0.1, 20.0);
      if (dice_.chance(0.2)) fall_behind(execution, moment.at);
      const auto& goal = problem_.robots()[k].goal;
      if (goal && dice_.chance(0.2)) execution.goals = {*goal};
    }
    Work stop = Work::unbounded();
    Motions motions{braking_of(problem_.robots(), executions, moment, stop)};
    return advanced(problem_.robots(), executions, moment, motions, stop);
  }

  /// Returns whether the fleet can be planned for. A late robot may be where another robot is.
  bool go_on(std::vector<Robot> robots) {
    auto created = Problem::create(problem_.grid(), std::move(robots), StopCondition::never());
    if (const auto* faults = std::get_if<ProblemFaults>(&created)) {
      for (const ProblemFault& fault : faults->listed) {
        EXPECT_NE(fault.kind, ProblemFault::Kind::committed_collision)
            << fault.robot << " and " << fault.other << " at " << fault.t;
      }
      return false;
    }
    problem_ = std::move(std::get<Problem>(created));
    return true;
  }

  const Problem& problem() const { return problem_; }

 private:
  static Problem random_problem(Dice& dice) {
    const Problem problem = support::random_problem(dice, 12);
    std::vector<Robot> robots = problem.robots();
    if (dice.chance(0.3)) {
      for (Robot& robot : robots) robot.vicinity = problem.grid().resolution() * dice.between(0.0, 0.5);
    }
    return std::get<Problem>(Problem::create(problem.grid(), std::move(robots), StopCondition::never()));
  }

  void expect_safe(const Plan& plan) const {
    CheckRules rules;
    rules.tolerances = plan_tolerances(problem_.grid(), problem_.robots(), plan.plans);
    rules.wait_before_move = options_.wait_before_move;
    const auto report =
        verify({problem_.grid(), problem_.robots(), {}}, plan.plans, rules, StopCondition::never());
    EXPECT_TRUE(report->valid()) << support::text(*report);
  }

  void fall_behind(Execution& execution, double at) {
    const double then = std::max(0.0, at - dice_.between(0.0, 1.0));
    for (const Action& action : execution.actions) {
      if (action.t_start <= then && then < action.t_end)
        execution.measured = support::pose_within(action, then);
    }
  }

  Dice& dice_;
  Problem problem_;
  PlanOptions options_;
  bool commits_ = false;
  double makespan_ = 0.0;
};

/// All robots execute what is committed, and stay.
void expect_that_all_may_stop(const Problem& problem) {
  std::vector<Robot> robots = problem.robots();
  std::vector<RobotPlan> stops;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    robots[k].goal.reset();
    robots[k].via.clear();
    robots[k].previous.reset();
    stops.push_back({k, robots[k].committed_until(), robots[k].committed});
  }
  CheckRules rules;
  rules.tolerances.assign(robots.size(), Tolerance::of_all(kContactTolerance));
  const auto report = verify({problem.grid(), robots, {}}, stops, rules, StopCondition::never());
  EXPECT_TRUE(report->valid()) << support::text(*report);
}

void go_through(Fleet& fleet) {
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    if (!fleet.go_on(fleet.at_a_later_moment(fleet.plan()))) return;
    expect_that_all_may_stop(fleet.problem());
  }
}

TEST(RandomFleets, MayStopWhereTheirCommitmentsEndWhateverHappens) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    Fleet fleet(dice);
    go_through(fleet);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
