#pragma once

// The actions of a robot as the nodes and edges of a VDA 5050 order.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/execution/dependency.h"
#include "core/execution/executed_actions.h"
#include "core/model/robot.h"
#include "core/runtime/work.h"

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
  core::ActionPlace until = {};  // place at which it has turned to `theta` and made its stops; at least `at`
};

/// An edge from one node to the next: straight ahead (or back), or, with no length, a rotation in place.
struct RouteEdge {
  double length = 0.0;          // metres
  double speed = 0.0;           // metres per second, the greatest of the plan; 0 if there is no length
  double rotation_speed = 0.0;  // radians per second, for the rotation before it
  bool reverse = false;
};

/// Where a route begins, and how its nodes are numbered.
struct RouteStart {
  std::size_t action = 0;         // the first one of the route; those before it are of an earlier order
  std::uint64_t sequence_id = 0;  // of the first node; the others follow in steps of two
  bool is_known = false;          // the vehicle has the first node already: nothing can be added to it
};

/// The route of a robot: `edges[k]` leads from `nodes[k]` to `nodes[k + 1]`. Empty without actions, unless
/// its first node is known.
struct Route {
  std::vector<RouteNode> nodes;
  std::vector<RouteEdge> edges;
  std::uint64_t first_sequence_id = 0;

  std::uint64_t sequence_id(std::size_t node) const { return first_sequence_id + 2 * node; }
  /// Returns the node of a sequence id; none if the route has no such node.
  std::optional<std::size_t> node_of(std::uint64_t sequence_id) const;
};

/// Returns the route of a robot. There is a node wherever the robot stops or turns, and at each of the `cuts`
/// (ascending, see place_of) within a translation. Waits that only give way are left out: passage is by
/// release. A robot that has to assume two headings in one place, for two goals, has two nodes there, and so
/// has one that is served where its first node is known.
Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move, const RouteStart& start = {});

/// Adds points to those of a robot, so that no translation takes longer than so many seconds from one to the
/// next. Ends early when the stop is met.
std::vector<core::ActionPlace> with_points_within(double seconds, std::vector<core::ActionPlace> points,
                                                  core::Actions actions, core::Work& stop);

}  // namespace fleetplan::api
