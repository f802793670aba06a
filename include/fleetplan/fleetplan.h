#pragma once

/// Fleetplan as a library: collision-free, timed motions for fleets of differential-drive robots.
///
/// This header includes all others except service.h, which belongs to a separate library. Read them in this
/// order:
///
/// 1. pose.h, map.h, robot.h: the map, the robots and their goals.
/// 2. action.h: what robots execute.
/// 3. surroundings.h: moving obstacles and zones.
/// 4. problem.h: all of these together, and the faults of a problem.
/// 5. options.h: how to plan.
/// 6. planner.h, plan.h: the call, and what it returns.
/// 7. margins.h: which margins a plan needs, and the plan that has them.
/// 8. verify.h: the independent check of plans from any source.
/// 9. limits.h: the ranges of numbers.
///
/// The conventions of all headers:
///
/// - Units are metres, seconds and radians, and their quotients for speeds. x points right and y up. Headings
///   are counter-clockwise from +x. Times begin with 0 at the start of the plan.
/// - All types are values: copies share nothing. Members with a default need not be set.
/// - Robots, goals, obstacles and zones are numbered from 0 in the order of their lists.
/// - faults_of() (problem.h) lists what is wrong with a problem. Functions that need a valid problem throw
///   these faults as InvalidProblem. std::bad_alloc passes through. Nothing else is thrown, unless a function
///   says so.
/// - Functions keep no state between calls. Several threads may call them at the same time. They write no
///   output, and read neither files nor the environment.
///
/// A program that plans:
///
///     fleetplan::Problem problem{fleetplan::Map::from_rows({"....", ".##.", "...."}, 1.0)};
///     fleetplan::Robot robot;
///     robot.radius = 0.4;
///     robot.linear_speed = 1.0;
///     robot.angular_speed = 2.0;
///     robot.start = {0.5, 0.5, 0.0};
///     robot.goals = {{3.5, 2.5}};
///     problem.robots.push_back(robot);
///     const fleetplan::Plan plan = fleetplan::plan(problem);

#include <fleetplan/action.h>
#include <fleetplan/fault.h>
#include <fleetplan/limits.h>
#include <fleetplan/map.h>
#include <fleetplan/margins.h>
#include <fleetplan/options.h>
#include <fleetplan/plan.h>
#include <fleetplan/planner.h>
#include <fleetplan/pose.h>
#include <fleetplan/problem.h>
#include <fleetplan/robot.h>
#include <fleetplan/surroundings.h>
#include <fleetplan/verify.h>

namespace fleetplan {

/// The version of the library that the program is linked with, such as "0.1.0".
const char* version();

}  // namespace fleetplan
