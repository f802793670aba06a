#include <fleetplan/fleetplan.h>

#include <string>

std::string plan_one_robot() {
  fleetplan::Problem problem{fleetplan::Map(10, 10, 1.0)};
  fleetplan::Robot robot;
  robot.radius = 0.4;
  robot.linear_speed = 1.0;
  robot.angular_speed = 1.0;
  robot.start = {0.5, 0.5, 0.0};
  robot.goals = {{9.5, 0.5}};
  problem.robots = {robot};
  const bool verified = fleetplan::plan(problem).verified;
  problem.robots[0].radius = 0.0;
  try {
    fleetplan::plan(problem);
  } catch (const fleetplan::InvalidProblem& invalid) {
    return std::string(fleetplan::version()) + (verified ? " verified, " : ", ") +
           invalid.faults().at(0).place;
  }
  return "not refused";
}
