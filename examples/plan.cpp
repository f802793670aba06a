// Plans two robots that swap the ends of a corridor, with the library, and prints what they execute.
//
//   cmake -S examples -B build/examples && cmake --build build/examples && build/examples/plan

#include <fleetplan/fleetplan.h>

#include <cstdio>

namespace {

fleetplan::Robot robot(const char* id, fleetplan::Pose start, fleetplan::Goal goal) {
  fleetplan::Robot made;
  made.id = id;
  made.radius = 0.3;         // metres
  made.linear_speed = 1.0;   // metres per second
  made.angular_speed = 3.0;  // radians per second
  made.start = start;
  made.goals = {goal};
  return made;
}

const char* name_of(fleetplan::Action::Type type) {
  switch (type) {
    case fleetplan::Action::Type::rotate:
      return "rotate";
    case fleetplan::Action::Type::translate:
      return "translate";
    case fleetplan::Action::Type::wait:
      break;
  }
  return "wait";
}

}  // namespace

int main() {
  // A corridor with a passing bay; cells of 1 m, the top row first.
  fleetplan::Problem problem{fleetplan::Map::from_rows({"####.####",  //
                                                        "........."},
                                                       1.0)};
  problem.robots = {robot("east-bound", {0.5, 0.5, 0.0}, {8.5, 0.5}),
                    robot("west-bound", {8.5, 0.5, 3.14159265}, {0.5, 0.5})};

  fleetplan::Options options;
  options.time_budget = std::chrono::seconds(2);
  try {
    const fleetplan::Plan plan = fleetplan::plan(problem, options);
    for (const fleetplan::RobotPlan& each : plan.plans) {
      std::printf("%s arrives after %.2f s\n", problem.robots[each.robot].id.c_str(), each.cost);
      for (const fleetplan::Action& action : each.actions) {
        std::printf("  %6.2f s  %-9s to (%.2f, %.2f) heading %.2f\n", action.t_start, name_of(action.type),
                    action.to.x, action.to.y, action.to.theta);
      }
    }
    for (const fleetplan::Unplanned& each : plan.unplanned) {
      std::printf("%s has no plan: %s\n", problem.robots[each.robot].id.c_str(), each.detail.c_str());
    }
    const bool is_safe = fleetplan::verify(problem, plan).valid();
    std::printf("flowtime %.2f s, %s\n", plan.objectives.flowtime, is_safe ? "no collisions" : "not valid");
    return is_safe && plan.status == fleetplan::Plan::Status::solved ? 0 : 1;
  } catch (const fleetplan::InvalidProblem& invalid) {
    for (const fleetplan::Fault& fault : invalid.faults()) {
      std::printf("%s: %s\n", fault.place.c_str(), fault.detail.c_str());
    }
    return 2;
  }
}
