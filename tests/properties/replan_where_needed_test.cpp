// Moments at which only some previous plans hold: robots with new goals, held robots, people who cross the
// drives, robots whose poses are at fault. What holds stays, and changes only where it must.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/plan/kept_plans.h"
#include "core/plan/planner.h"
#include "tests/support/expect_replanned.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;
using support::FleetRequest;
using support::planned;
using support::problem_of;

/// Metres. The search keeps more distance than the check: by the contact tolerance, and the rounding of plans
/// that went through moments.
constexpr double kStricter = 2e-6;

CheckRules rules_of(const PlanOptions& options) {
  CheckRules rules;
  rules.inflation = options.inflation;
  rules.interval_margin = options.interval_margin;
  rules.wait_before_move = options.wait_before_move;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  return rules;
}

/// The robots whose previous plans hold if all others stay where they are. Beginning with all kept plans,
/// robots that cross a robot that stays do not remain.
std::vector<bool> certain_robots(const Problem& problem, const PlanOptions& options,
                                 std::vector<bool> certain) {
  while (std::count(certain.begin(), certain.end(), true) > 0) {
    std::vector<RobotPlan> plans;
    for (std::size_t i = 0; i < certain.size(); ++i) {
      if (certain[i]) plans.push_back(previous_plan(i, problem.robots()[i]));
    }
    const auto before = plans.size();
    for (const Violation& violation : support::safety_report(problem, plans, rules_of(options)).violations) {
      for (const std::size_t robot : violation.robots) certain[robot] = false;
    }
    if (static_cast<std::size_t>(std::count(certain.begin(), certain.end(), true)) == before) break;
  }
  return certain;
}

const RobotPlan* plan_of(const Plan& plan, std::size_t robot) {
  for (const RobotPlan& found : plan.plans) {
    if (found.robot == robot) return &found;
  }
  return nullptr;
}

bool meets(const Plan& plan, std::size_t robot) {
  return std::any_of(plan.unavoidable.begin(), plan.unavoidable.end(),
                     [robot](const UnavoidableCollision& collision) {
                       return collision.robot == robot || collision.other == robot;
                     });
}

bool follows_previous(const Robot& robot, const RobotPlan& plan) {
  const std::vector<Action>& given = previous_actions(robot);
  return std::equal(given.begin(), given.end(), plan.actions.begin(), plan.actions.end(), support::same);
}

/// Robots that can follow their plans whatever the others do are planned. With enough time, a plan that holds
/// has changed only if it would collide with the plans of the answer.
void expect_kept(const Problem& problem, const PlanOptions& options, const Plan& plan, bool has_time) {
  const KeptPlans kept = keep_previous_plans(problem, options, StopCondition::never());
  if (kept.kept.empty()) return;
  const std::vector<bool> certain = certain_robots(problem, options, kept.kept);
  for (std::size_t i = 0; i < problem.robots().size(); ++i) {
    const RobotPlan* now = plan_of(plan, i);
    EXPECT_TRUE(now != nullptr || !certain[i]) << "robot " << i << " is unplanned, although its plan holds";
    if (!has_time || !kept.kept[i] || now == nullptr || follows_previous(problem.robots()[i], *now)) continue;
    if (meets(plan, i)) continue;  // all of a collision is exempt, also what can be avoided
    std::vector<RobotPlan> plans = plan.plans;
    for (RobotPlan& other : plans) {
      if (other.robot == i) other = previous_plan(i, problem.robots()[i]);
    }
    CheckRules rules = rules_of(options);
    rules.inflation += kStricter;
    rules.exempt = plan.unavoidable;
    EXPECT_FALSE(support::safety_report(problem, plans, rules).valid())
        << "robot " << i << " changes, although its plan holds among those of the others";
  }
}

bool overlaps_a_goal(const std::vector<Robot>& robots, std::size_t robot, const Position& place) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (i == robot || !robots[i].goal) continue;
    const double contact = robots[i].radius + robots[robot].radius;
    if ((robots[i].goal->position - place).norm() < contact) return true;
  }
  return false;
}

/// Some robots go elsewhere. Most of them no longer tell their previous plans.
void give_new_goals(Dice& dice, FleetRequest& request) {
  for (std::size_t i = 0; i < request.robots.size(); ++i) {
    Robot& robot = request.robots[i];
    if (!robot.goal || robot.invalid || !dice.chance(0.3)) continue;
    for (int attempt = 0; attempt < 20; ++attempt) {
      const Position place = support::random_place(dice, request.grid);
      if (obstacle_distance(request.grid, place, robot.radius) < robot.radius) continue;
      if (overlaps_a_goal(request.robots, i, place)) continue;
      robot.goal = Goal{place, {}};
      robot.via.clear();
      if (dice.chance(0.7)) robot.previous.reset();
      break;
    }
  }
}

/// Where the robot is at `t` of its previous plan.
Position place_at(const Robot& robot, double t) {
  const std::vector<Action>& actions = previous_actions(robot);
  for (const Action& action : actions) {
    if (t < action.t_end) return support::pose_within(action, std::max(t, action.t_start)).position;
  }
  return actions.empty() ? robot.start.position : actions.back().to.position;
}

/// People who walk straight through the places where robots will be at some time, moving or held.
void cross_drives(Dice& dice, FleetRequest& request) {
  for (int k = 1 + dice.below(4); k > 0; --k) {
    const auto whose = static_cast<std::size_t>(dice.below(static_cast<int>(request.robots.size())));
    const double t = dice.between(0.0, 20.0);
    const Position place = place_at(request.robots[whose], t);
    const double direction = dice.between(-std::numbers::pi, std::numbers::pi);
    const double speed = request.grid.resolution() * dice.between(0.3, 3.0);
    const double before = dice.between(0.5, 10.0);
    const double after = dice.between(0.5, 10.0);
    const Position step = speed * Position(std::cos(direction), std::sin(direction));
    MovingObstacle person{"crossing " + std::to_string(k),
                          request.grid.resolution() * dice.between(0.1, 0.6),
                          {},
                          MovingObstacle::After::leaves};
    person.motion = {{std::max(0.0, t - before), place - std::min(t, before) * step},
                     {t + after, place + after * step}};
    request.obstacles.push_back(person);
  }
}

class ReplanWhereNeeded : public testing::TestWithParam<int> {
 protected:
  /// A fleet in a random moment of its plans. Nullopt where the first plan is no plan for such a moment.
  static std::optional<FleetRequest> fleet_under_way(Dice& dice) {
    FleetRequest request = support::random_request(dice);
    request.options.replan = PlanOptions::Replan::where_needed;
    const Plan plan = planned(*problem_of(request), request.options, 1000);
    if (!plan.unavoidable.empty()) return std::nullopt;
    return support::moment_of(dice, request, plan, dice.between(0.0, 0.8 * plan.objectives.makespan));
  }

  /// Plans with enough time and with hardly any.
  static void expect_replanned(Dice& dice, const FleetRequest& request) {
    const std::optional<Problem> problem = problem_of(request);
    if (!problem) return;  // a robot that is held stands in the way of what others are committed to
    const bool is_first = request.options.mode == PlanOptions::Mode::first;
    expect_kept(*problem, request.options, planned(*problem, request.options, 1000), is_first);
    expect_kept(*problem, request.options, planned(*problem, request.options, 10 * dice.below(2)), false);
  }
};

TEST_P(ReplanWhereNeeded, ChangesOnlyWhatNewGoalsAsk) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 200'000);
  std::optional<FleetRequest> request = fleet_under_way(dice);
  if (!request) return;
  give_new_goals(dice, *request);
  expect_replanned(dice, *request);
}

TEST_P(ReplanWhereNeeded, ChangesOnlyWhatHeldRobotsAndPeopleAsk) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 300'000);
  std::optional<FleetRequest> request = fleet_under_way(dice);
  if (!request) return;
  for (Robot& robot : request->robots) {
    if (dice.chance(0.2)) support::hold_back(dice, robot);
  }
  cross_drives(dice, *request);
  if (dice.chance(0.3)) give_new_goals(dice, *request);
  expect_replanned(dice, *request);
}

/// The request with invalid robots marked as such.
Problem reported_problem(FleetRequest& request) {
  while (true) {
    ProblemConditions conditions;
    conditions.obstacles = request.obstacles;
    conditions.list_faults_of_every_robot = true;
    auto created =
        Problem::create(request.grid, request.robots, std::move(conditions), StopCondition::never());
    if (auto* valid = std::get_if<Problem>(&created)) return std::move(*valid);
    const auto& faults = std::get<ProblemFaults>(created).listed;
    bool any = false;
    const auto mark = [&](std::size_t index) {
      const Robot& sound = request.robots[index];
      any = any || !sound.invalid;
      Robot robot{sound.id, sound.radius, sound.linear_speed, sound.angular_speed, sound.start, {}};
      robot.invalid = true;
      request.robots[index] = robot;
    };
    for (const ProblemFault& fault : faults) {
      mark(fault.robot);
      if (fault.kind == ProblemFault::Kind::starts_overlap ||
          fault.kind == ProblemFault::Kind::goals_overlap ||
          fault.kind == ProblemFault::Kind::committed_collision)
        mark(fault.other);
    }
    if (!any) throw std::logic_error("a fault of robots that are invalid");
  }
}

TEST_P(ReplanWhereNeeded, PlansAroundInvalidRobots) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()) + 400'000);
  std::optional<FleetRequest> request = fleet_under_way(dice);
  if (!request) return;
  request->options.start_overlap = 0.0;
  for (Robot& robot : request->robots) {
    if (!dice.chance(0.2)) continue;
    // Moved by hand: into a wall, another robot, off the map, or just elsewhere.
    robot.start.position += request->grid.resolution() * Position(dice.between(-2, 2), dice.between(-2, 2));
    robot.committed.clear();
    if (dice.chance(0.5)) robot.previous.reset();
  }
  if (dice.chance(0.3)) cross_drives(dice, *request);
  const Problem problem = reported_problem(*request);
  for (const int budget : {1000, 10 * dice.below(2)}) {
    const Plan plan = planned(problem, request->options, budget);
    for (std::size_t i = 0; i < problem.robots().size(); ++i) {
      const bool listed =
          std::any_of(plan.unplanned.begin(), plan.unplanned.end(), [i](const Unplanned& robot) {
            return robot.robot == i && robot.reason == Unplanned::Reason::invalid;
          });
      EXPECT_EQ(listed, problem.robots()[i].invalid) << "robot " << i;
    }
    const bool has_time = budget > 10 && request->options.mode == PlanOptions::Mode::first;
    expect_kept(problem, request->options, plan, has_time);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ReplanWhereNeeded, testing::Range(0, 150));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
