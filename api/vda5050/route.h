#pragma once

// The actions of a robot as the nodes and edges of a VDA 5050 order.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependency.h"
#include "core/execution/executed_actions.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// What a robot does at a node: it serves a goal, or makes the added wait (PlanOptions::wait_before_move).
struct Stop {
  std::optional<std::size_t> goal;  // none: an added wait
  double duration = 0.0;            // seconds
  double not_before = 0.0;          // seconds since the begin of the plan; of a goal
};

struct RouteNode {
  core::Position position{0.0, 0.0};
  std::optional<double> theta;  // radians: the heading to assume at the node before its stops
  core::ActionPlace at;         // when the robot arrives, see place_of
  std::vector<Stop> stops;
};

/// From one node to the next: straight ahead (or back), or, with no length, a rotation in place.
struct RouteEdge {
  double length = 0.0;          // metres
  double speed = 0.0;           // metres per second, of the plan; 0 if there is no length
  double rotation_speed = 0.0;  // radians per second, for the rotation before it
  bool reverse = false;
};

/// `edges[k]` leads from `nodes[k]` to `nodes[k + 1]`. Empty without actions.
struct Route {
  std::vector<RouteNode> nodes;
  std::vector<RouteEdge> edges;
};

/// There is a node wherever the robot stops or turns, and at each of the `cuts` (ascending, see place_of)
/// within a translation. Waits that only give way are left out: passage is by release. A robot that has to
/// assume two headings in one place, for two goals, has two nodes there.
Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move);

}  // namespace fleetplan::api
