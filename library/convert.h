#pragma once

// Converts values of the public headers to values of core, and back (convert.cpp). Makes valid problems of
// them (make_problem.cpp). Core has positions relative to the lower left corner of the map.

#include <fleetplan/action.h>
#include <fleetplan/map.h>
#include <fleetplan/options.h>
#include <fleetplan/plan.h>
#include <fleetplan/planner.h>
#include <fleetplan/problem.h>
#include <fleetplan/verify.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/open_goal.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/progress.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/plan/make_plan.h"
#include "core/travel/goal_choice.h"
#include "core/verify/verify.h"

namespace fleetplan::library {

/// The position of the map's lower left corner, and conversions with it.
class Frame {
 public:
  Frame() = default;  // the frame of core
  explicit Frame(const Map& map) : origin_(map.origin().x, map.origin().y) {}

  core::Position to_core(double x, double y) const { return core::Position(x, y) - origin_; }
  core::Pose to_core(const Pose& pose) const;
  core::Action to_core(const Action& action) const;
  Pose from_core(const core::Pose& pose) const;
  Action from_core(const core::Action& action) const;

 private:
  core::Position origin_{0.0, 0.0};
};

core::OccupancyGrid grid_of(const Map& map);
/// Converts a robot without its committed and previous actions. A goal with several poses gets the pose that
/// is told, or the first.
core::Robot robot_of(const Robot& robot, const Frame& frame);
/// Returns the robot's goals that have several poses.
std::vector<core::OpenGoal> open_goals_of(const Robot& robot, const Frame& frame);
core::MovingObstacle obstacle_of(const MovingObstacle& obstacle, const Frame& frame);
core::Zone zone_of(const Zone& zone, const Frame& frame);
/// Converts options. `in_motion`: whether any robot has committed actions or a previous plan.
core::PlanOptions options_of(const Options& options, bool in_motion);

core::RobotPlan plan_of(const RobotPlan& plan, const Frame& frame);
std::vector<core::UnavoidableCollision> unavoidable_of(const std::vector<UnavoidableCollision>& collisions);

/// Converts a plan, except whether it is verified and how long it took. `open` has the chosen poses, by
/// robot; empty if no goal has several.
Plan plan_of(const core::Plan& plan, const Problem& problem, const core::OpenGoals& open);
/// Converts a plan with what the check says of it. `invalid` has the faults of each robot that is invalid.
/// Throws std::logic_error if the check rejects it.
Plan plan_of(const core::MadePlan& made, const Problem& problem,
             const std::vector<std::vector<Fault>>& invalid);
/// Throws std::logic_error: a plan of the planner is rejected.
[[noreturn]] void throw_rejected(const core::VerifyReport& report);
/// Returns the end of a time budget that may be very long.
core::StopCondition::Clock::time_point end_of(std::chrono::nanoseconds budget,
                                              core::StopCondition::Clock::time_point begin);
Verification verification_of(core::VerifyReport report);
Progress progress_of(const core::Progress& progress);

/// The parts that are read from a problem. Faults of its numbers and lists are added to `faults`.
struct ReadFleet {
  std::vector<core::Robot> robots;
  core::OpenGoals open;  // by robot
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;
  std::vector<Fault> faults;  // only the first ones of many
};

ReadFleet read_fleet(const Problem& problem);

/// Whether any robot has committed actions or a previous plan.
bool in_motion(const Problem& problem);

/// The problem that the planner is to plan, or its faults. Neither if a stop was requested first.
struct MadeProblem {
  std::optional<core::PlanTask> task;
  std::vector<Fault> faults;
  std::vector<std::vector<Fault>> invalid = {};  // the faults of each robot that is invalid; may be empty
};

MadeProblem make_problem(const Problem& problem, const Options& options, const std::stop_token& stop);

}  // namespace fleetplan::library
