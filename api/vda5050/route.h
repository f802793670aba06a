#pragma once

// The actions of a robot as the nodes and edges of a VDA 5050 order, and which of these nodes it may pass.

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
  double not_before = 0.0;          // seconds since the begin of the plan, for a goal
};

struct RouteNode {
  core::Position position{0.0, 0.0};
  std::optional<double> theta;  // radians: the heading to assume at the node before its stops
  core::ActionPlace at;         // place at which the robot arrives, see place_of
  std::vector<Stop> stops;
};

/// An edge from one node to the next: straight ahead (or back), or, with no length, a rotation in place.
struct RouteEdge {
  double length = 0.0;          // metres
  double speed = 0.0;           // metres per second, of the plan; 0 if there is no length
  double rotation_speed = 0.0;  // radians per second, for the rotation before it
  bool reverse = false;
};

/// The route of a robot: `edges[k]` leads from `nodes[k]` to `nodes[k + 1]`. Empty without actions.
struct Route {
  std::vector<RouteNode> nodes;
  std::vector<RouteEdge> edges;
};

/// Returns the route of a robot. There is a node wherever the robot stops or turns, and at each of the `cuts`
/// (ascending, see place_of) within a translation. Waits that only give way are left out: passage is by
/// release. A robot that has to assume two headings in one place, for two goals, has two nodes there.
Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move);

/// Returns the points of routes that dependencies name, by robot, ascending and each once.
std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<core::Dependency>& dependencies,
                                                      std::size_t robots);

/// Returns how many nodes of each route, the first ones, are released when every robot has reached the point
/// of its progress: those that come before or at the first gate whose `until` is not reached. At least the
/// first node is released.
///
/// No robots wait for each other for ever, although they report nodes only: there is a node at each gate and
/// each `until` within a translation; standing robots occupy the same place, so a gate within a stand acts
/// where it ends, and an `until` there is reported with the next node, which is no later than the next gate.
std::vector<std::size_t> released_nodes(const std::vector<Route>& routes,
                                        const std::vector<core::Dependency>& dependencies,
                                        const std::vector<core::ActionPlace>& progress);

}  // namespace fleetplan::api
