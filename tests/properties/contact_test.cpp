// Poses in contact: every pose of a plan, and every start and goal that a request may have, can be planned
// from and to. And inflated disks that overlap at their starts leave without coming nearer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/map/occupancy_grid.h"
#include "core/plan/planner.h"
#include "core/verify/execution.h"
#include "core/verify/pairs/fleet_clearance.h"
#include "core/verify/verify.h"
#include "tests/support/expect_safe.h"
#include "tests/support/moving_fleet.h"
#include "tests/support/plain_check.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"
#include "tests/support/summary.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Dice;

constexpr double kPi = std::numbers::pi;
/// Metres; the rounding of snapped starts.
constexpr double kRounding = 4e-9;
/// Questions to the stop condition: five times what any plan of these tests takes. Not seconds, because some
/// take ten with sanitizers on a busy machine, and whether a way is found must not depend on the machine.
constexpr std::int64_t kMaxSteps = 40'000;

Plan planned(const Problem& problem, const PlanOptions& options) {
  support::StepLimit limit(kMaxSteps);
  Plan plan = core::plan(problem, options, support::counted(limit));
  const auto tolerances = plan_tolerances(problem.grid(), problem.robots(), plan.plans);
  const auto report =
      verify(problem.grid(), problem.robots(), plan.plans, tolerances, StopCondition::never());
  EXPECT_TRUE(report->valid()) << support::text(*report);
  return plan;
}

std::optional<Problem> problem_of(const OccupancyGrid& grid, std::vector<Robot> robots) {
  auto created = Problem::create(grid, std::move(robots), StopCondition::never());
  auto* valid = std::get_if<Problem>(&created);
  return valid != nullptr ? std::optional<Problem>(std::move(*valid)) : std::nullopt;
}

Pose pose_at(const Robot& robot, const RobotPlan& plan, double t) {
  if (plan.actions.empty()) return robot.start;
  for (const Action& action : plan.actions) {
    if (t >= action.t_end) continue;
    const double part = (t - action.t_start) / (action.t_end - action.t_start);
    const double turn = rotation_between(action.from.theta, action.to.theta);
    return {action.from.position + part * (action.to.position - action.from.position),
            normalize_angle(action.from.theta + part * turn)};
  }
  return plan.actions.back().to;
}

/// As a client sees it: in world coordinates, as doubles.
Position in_world(const Position& position, const Position& origin) {
  const Position world = position + origin;
  return world - origin;
}

/// Moments at which inflated robots are in contact with each other or with walls.
std::vector<double> contact_moments(const Problem& problem, const PlanOptions& options, const Plan& plan) {
  std::vector<Robot> larger = problem.robots();
  for (Robot& robot : larger) robot.radius += options.inflation + 1e-7;
  std::vector<double> moments;
  const VerifyReport report = *verify(problem.grid(), larger, plan.plans, 0.0, StopCondition::never());
  for (const Violation& contact : report.violations) {
    const bool of_robots = contact.kind == Violation::Kind::robot_collision;
    if (of_robots || contact.kind == Violation::Kind::obstacle_collision) moments.push_back(contact.t);
  }
  return moments;
}

/// A moment of contact, if there is any, or any other.
double random_moment(Dice& dice, const Problem& problem, const PlanOptions& options, const Plan& plan) {
  const std::vector<double> contacts = contact_moments(problem, options, plan);
  if (contacts.empty() || dice.chance(0.3)) return dice.between(0.0, plan.objectives.makespan);
  return contacts[static_cast<std::size_t>(dice.below(static_cast<int>(contacts.size())))];
}

std::vector<Robot> robots_at(const Problem& problem, const Plan& plan, double t, const Position& origin) {
  std::vector<Robot> robots = problem.robots();
  for (const RobotPlan& robot : plan.plans) {
    Robot& moved = robots[robot.robot];
    moved.start = pose_at(moved, robot, t);
    moved.start.position = in_world(moved.start.position, origin);
  }
  for (Robot& robot : robots) {
    if (robot.goal) robot.goal->position = in_world(robot.goal->position, origin);
  }
  return robots;
}

std::string reasons(const Plan& plan) {
  std::string text;
  for (const Unplanned& robot : plan.unplanned) {
    text += std::to_string(robot.robot) + ": " + robot.detail + "\n";
  }
  return text;
}

/// A fleet with a plan for every robot.
struct PlannedFleet {
  Problem problem;
  PlanOptions options;
  Plan plan;
};

PlannedFleet random_planned_fleet(Dice& dice) {
  while (true) {
    Problem problem = support::random_problem(dice, 2 + dice.below(6));
    PlanOptions options = support::random_options(dice, problem);
    options.reordering = PlanOptions::Reordering::raise_failed;
    options.any_angle = true;
    Plan plan = planned(problem, options);
    if (plan.unplanned.empty()) return {std::move(problem), options, std::move(plan)};
  }
}

class Replanning : public testing::TestWithParam<int> {};

TEST_P(Replanning, FromAnyMomentOfAPlanGivesAPlanAgainAndAgain) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  PlannedFleet fleet = random_planned_fleet(dice);
  const Position origin = dice.chance(0.5) ? Position(0.0, 0.0) : Position(691'234.567, 5'334'999.789);
  for (int k = 0; k < 6; ++k) {
    const double t = random_moment(dice, fleet.problem, fleet.options, fleet.plan);
    const std::vector<Robot> robots = robots_at(fleet.problem, fleet.plan, t, origin);
    const auto problem = problem_of(fleet.problem.grid(), robots);
    ASSERT_TRUE(problem) << "at t = " << t << " the poses of the plan are not accepted";
    Plan plan = planned(*problem, fleet.options);
    if (plan.unplanned.empty()) {
      fleet = {*problem, fleet.options, std::move(plan)};
      continue;
    }
    // Robots that are a micrometre smaller are not in contact: what they cannot do has other reasons.
    std::vector<Robot> smaller = robots;
    for (Robot& robot : smaller) robot.radius -= 1e-6;
    const Plan apart = planned(*problem_of(fleet.problem.grid(), smaller), fleet.options);
    EXPECT_LE(plan.unplanned.size(), apart.unplanned.size()) << "at t = " << t << ":\n" << reasons(plan);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Replanning, testing::Range(0, 150));

/// A hall of 12 m x 12 m with a pillar.
OccupancyGrid hall(double resolution) {
  const int cells = static_cast<int>(std::lround(12.0 / resolution));
  OccupancyGrid grid(cells, cells, resolution);
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const Position center = grid.center({column, row});
      if (std::max(std::abs(center.x() - 6.0), std::abs(center.y() - 6.0)) < 1.0) grid.block({column, row});
    }
  }
  return grid;
}

/// Places robots in contact with walls and with each other: gaps are from `least` to `max` metres.
class ContactFleet {
 public:
  ContactFleet(Dice& dice, const OccupancyGrid& grid, double least, double max)
      : dice_(dice), grid_(grid), least_(least), max_(max) {}

  std::vector<Position> places(const std::vector<double>& radii) {
    std::vector<Position> all;
    while (all.size() < radii.size()) {
      const double radius = radii[all.size()];
      const Position p = all.empty() || dice_.chance(0.4)
                             ? at_wall(radius)
                             : beside(all.back(), radii[all.size() - 1] + radius);
      if (fits(p, radius, all, radii)) all.push_back(p);
      if (++attempts_ % 200 == 0) all.clear();
    }
    return all;
  }

 private:
  double gap() { return dice_.between(least_, max_); }
  Position at_wall(double radius) {
    const double along = dice_.between(1.5, 10.5);
    switch (dice_.below(3)) {
      case 0:
        return {radius + gap(), along};
      case 1:
        return {along, 12.0 - radius - gap()};
      default:
        return {5.0 - radius - gap(), dice_.between(5.2, 6.8)};  // at the pillar
    }
  }
  Position beside(const Position& other, double distance) {
    const double direction = dice_.between(-kPi, kPi);
    return other + (distance + gap()) * Position(std::cos(direction), std::sin(direction));
  }
  bool fits(const Position& p, double radius, const std::vector<Position>& all,
            const std::vector<double>& radii) const {
    if (obstacle_distance(grid_, p, radius + 1.0) < radius + least_ - 1e-12) return false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((p - all[i]).norm() < radius + radii[i] + least_ - 1e-12) return false;
    }
    return true;
  }

  Dice& dice_;
  const OccupancyGrid& grid_;
  double least_;
  double max_;
  int attempts_ = 0;
};

/// Robots with starts at these gaps, and goals at others.
Problem contact_problem(Dice& dice, double least_start, double max_start, double goal_margin) {
  const OccupancyGrid grid = hall(dice.chance(0.5) ? 0.5 : 0.125);
  std::vector<double> radii;
  for (int i = 2 + dice.below(3); i > 0; --i)
    radii.push_back(dice.chance(0.5) ? 0.25 : dice.between(0.1, 0.4));
  const auto starts = ContactFleet(dice, grid, least_start, max_start).places(radii);
  const auto goals = ContactFleet(dice, grid, goal_margin - 4.9e-7, goal_margin).places(radii);
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    Robot robot{std::to_string(i), radii[i], 1.0, 3.0, {starts[i], dice.between(-kPi, kPi)},
                Goal{goals[i], {}}};
    if (dice.chance(0.5)) robot.goal->theta = dice.between(-kPi, kPi);
    robots.push_back(robot);
  }
  return *problem_of(grid, std::move(robots));
}

class Contact : public testing::TestWithParam<int> {};

TEST_P(Contact, WithWallsStartsAndGoalsCanBeLeftAndReached) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  const Problem problem = contact_problem(dice, -4.9e-7, 0.0, 0.0);
  PlanOptions options;
  options.mode = dice.chance(0.5) ? PlanOptions::Mode::anytime : PlanOptions::Mode::first;
  options.max_iterations = 5;
  const Plan plan = planned(problem, options);
  EXPECT_TRUE(plan.unplanned.empty()) << reasons(plan);
}

TEST_P(Contact, OfInflatedDisksCanBeLeftAndReached) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  PlanOptions options;
  options.inflation = 0.05;
  // Two robots keep twice the inflation, a robot and a wall once. All gaps are gaps between two robots.
  const Problem problem = contact_problem(dice, 0.1 - 4.9e-7, 0.1, 0.1);
  const Plan plan = planned(problem, options);
  EXPECT_TRUE(plan.unplanned.empty()) << reasons(plan);
}

/// The least distance of two robots from a time on.
double least_distance(const std::vector<Leg>& a, const std::vector<Leg>& b, double from) {
  const auto later = [&](const std::vector<Leg>& legs) {
    std::vector<Leg> rest;
    for (Leg leg : legs) {
      if (leg.t_end <= from) continue;
      leg.from = position_at(leg, from);
      leg.t_begin = std::max(leg.t_begin, from);
      rest.push_back(leg);
    }
    for (Leg& leg : rest) {
      leg.t_begin -= from;
      leg.t_end -= from;
    }
    return rest;
  };
  const std::vector<double> point{0.0, 0.0};
  return *fleet_clearance({later(a), later(b)}, {point, point}, {0.0, 0.0}, 0, StopCondition::never())->least;
}

/// When a robot has made its first translation.
double left_start(const RobotPlan& plan) {
  for (const Action& action : plan.actions) {
    if (action.type == Action::Type::translate) return action.t_end;
  }
  return std::numeric_limits<double>::infinity();
}

void expect_no_nearer_than_at_start(const Problem& problem, const Plan& plan, double inflation) {
  for (const RobotPlan& a : plan.plans) {
    for (const RobotPlan& b : plan.plans) {
      if (a.robot >= b.robot) continue;
      const Robot& one = problem.robots()[a.robot];
      const Robot& other = problem.robots()[b.robot];
      const auto legs = execute(one, &a);
      const auto other_legs = execute(other, &b);
      const double kept = one.radius + other.radius + 2.0 * inflation;
      const double at_start = (one.start.position - other.start.position).norm();
      EXPECT_GE(least_distance(legs, other_legs, 0.0), std::min(kept, at_start) - kRounding);
      const double left = std::max(left_start(a), left_start(b));
      if (std::isfinite(left)) {
        EXPECT_GE(least_distance(legs, other_legs, left), kept - kContactTolerance);
      }
    }
  }
}

TEST_P(Contact, OverlapsOfInflatedDisksAreLeftWithoutComingNearer) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  PlanOptions options;
  options.inflation = dice.chance(0.5) ? 0.01 : 0.2;
  const Problem problem = contact_problem(dice, 0.0, 2.0 * options.inflation, 2.0 * options.inflation + 0.01);
  const Plan plan = planned(problem, options);
  EXPECT_TRUE(plan.unplanned.empty()) << reasons(plan);
  expect_no_nearer_than_at_start(problem, plan, options.inflation);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Contact, testing::Range(0, 150));

/// Robots on few cells, where they have to make way, most of them with starts up to 4 cm in walls.
std::optional<Problem> crowd_with_starts_in_walls(Dice& dice) {
  OccupancyGrid grid(8, 3, 0.5);
  for (int k = 0; k < 6; ++k) grid.block({dice.below(8), dice.below(3)});
  const auto is_at_wall = [&](const Position& start, double radius) {
    const double gap = obstacle_distance(grid, start, 1.0) - radius;
    return gap >= -0.04 && (gap < 0.0 || dice.chance(0.2));
  };
  std::vector<Robot> robots;
  for (int attempts = 0; robots.size() < 5 && attempts < 500; ++attempts) {
    const double radius = dice.between(0.12, 0.22);
    const Position start(dice.between(0.1, 3.9), dice.between(0.1, 1.4));
    const Position goal = grid.center({dice.below(8), dice.below(3)});
    if (!is_at_wall(start, radius) || obstacle_distance(grid, goal, 1.0) < radius) continue;
    const bool is_apart = std::all_of(robots.begin(), robots.end(), [&](const Robot& other) {
      const double kept = other.radius + radius;
      return (other.start.position - start).norm() > kept && (other.goal->position - goal).norm() > kept;
    });
    if (!is_apart) continue;
    Robot robot{std::to_string(robots.size()),    radius,
                dice.between(0.2, 3.0),           dice.between(0.5, 3.0),
                {start, dice.between(-kPi, kPi)}, Goal{goal, {}}};
    robot.may_reverse = dice.chance(0.3);
    robots.push_back(robot);
  }
  ProblemConditions conditions;
  conditions.wall_overlap = 0.05;
  auto created = Problem::create(grid, std::move(robots), conditions, StopCondition::never());
  auto* valid = std::get_if<Problem>(&created);
  return valid != nullptr ? std::optional<Problem>(std::move(*valid)) : std::nullopt;
}

class StartsInWalls : public testing::TestWithParam<int> {};

TEST_P(StartsInWalls, AreLeftForGood) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (int k = 0; k < 20; ++k) {
    const auto problem = crowd_with_starts_in_walls(dice);
    ASSERT_TRUE(problem);
    PlanOptions options;
    options.start_overlap = 0.05;
    options.mode = dice.chance(0.3) ? PlanOptions::Mode::anytime : PlanOptions::Mode::first;
    options.max_iterations = 5;
    support::StepLimit limit(kMaxSteps);
    const Plan plan = core::plan(*problem, options, support::counted(limit));
    support::expect_safe(*problem, plan, options);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, StartsInWalls, testing::Range(0, 20));

/// Robots on few cells, with goals and starts in walls by up to so many metres. They come from goals before
/// and return to their starts, with loads.
support::FleetRequest crowd_with_goals_in_walls(Dice& dice, double depth) {
  OccupancyGrid grid(9, 4, 0.5);
  for (int k = 0; k < 6; ++k) grid.block({dice.below(9), dice.below(4)});
  const auto at_wall = [&](double radius) {
    Position place(dice.between(0.1, 4.4), dice.between(0.1, 1.9));
    for (int k = 0; k < 200; ++k) {
      const double gap = obstacle_distance(grid, place, 1.0) - radius;
      if (gap >= -depth && gap < 0.02) break;
      place = Position(dice.between(0.1, 4.4), dice.between(0.1, 1.9));
    }
    return place;
  };
  std::vector<Robot> robots;
  for (int k = 0; k < 5; ++k) {
    const double radius = dice.between(0.12, 0.22);
    Robot robot{std::to_string(k),
                radius,
                dice.between(0.2, 3.0),
                dice.between(0.5, 3.0),
                {at_wall(radius), dice.between(-kPi, kPi)},
                Goal{at_wall(radius), {}}};
    if (dice.chance(0.3)) robot.goal->theta = dice.between(-kPi, kPi);
    if (dice.chance(0.3)) robot.goal->radius_after = radius * dice.between(0.8, 1.05);
    if (dice.chance(0.4)) robot.via.push_back(Goal{grid.center({dice.below(9), dice.below(4)}), {}});
    if (!robot.via.empty() && dice.chance(0.3))
      robot.via.back().radius_after = radius * dice.between(0.8, 1.2);
    if (dice.chance(0.3)) robot.goal = Goal{robot.start.position, {}};
    robot.may_reverse = dice.chance(0.3);
    robots.push_back(robot);
  }
  return {grid, std::move(robots), {}, {}};
}

class GoalsInWalls : public testing::TestWithParam<int> {};

TEST_P(GoalsInWalls, AreEnteredAtLast) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  Dice dice(static_cast<std::uint64_t>(GetParam()));
  int entered = 0;
  for (int made = 0, tries = 0; made < 15 && tries < 20'000; ++tries) {
    support::FleetRequest request = crowd_with_goals_in_walls(dice, 0.05);
    PlanOptions& options = request.options;
    options.inflation = dice.chance(0.3) ? dice.between(0.0, 0.03) : 0.0;
    options.goal_overlap = 0.05 + options.inflation;
    if (dice.chance(0.2)) options.interval_margin = dice.between(0.0, 1.0);
    if (dice.chance(0.3)) options.horizon = dice.between(0.5, 10.0);
    if (dice.chance(0.2)) options.connectivity = 16;
    options.any_angle = dice.chance(0.8);
    options.mode = dice.chance(0.3) ? PlanOptions::Mode::anytime : PlanOptions::Mode::first;
    options.max_iterations = 5;
    const auto whole = support::problem_of(request);
    // The robots that can start together.
    while (!whole && request.robots.size() > 2 && !support::problem_of(request)) request.robots.pop_back();
    const auto problem = support::problem_of(request);
    if (!problem) continue;
    ++made;
    support::StepLimit limit(kMaxSteps);
    const Plan plan = core::plan(*problem, options, support::counted(limit));
    const auto report = check_plan(*problem, options, plan, StopCondition::never());
    EXPECT_TRUE(report->valid()) << support::text(*report);
    for (const RobotPlan& one : plan.plans) {
      EXPECT_GE(one.cost, one.lower_bound - 1e-6) << "robot " << one.robot;
      const Robot& robot = problem->robots()[one.robot];
      const double gap = obstacle_distance(problem->grid(), robot.goal->position, 1.0);
      const bool ends_there =
          !one.actions.empty() && (one.actions.back().to.position - robot.goal->position).norm() < 1e-6;
      if (ends_there && gap < robot.radius - 0.01) ++entered;
    }
  }
  EXPECT_GT(entered, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GoalsInWalls, testing::Range(0, 20));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
