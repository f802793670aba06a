#pragma once

// The actions of a robot as the nodes and edges of a VDA 5050 order, and the nodes that the vehicle may pass.
// Dependencies become releases of nodes.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

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
  std::size_t action = 0;  // the first action of the route; actions before it belong to an earlier order
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
/// (ascending, see place_of) within a translation. Waits that only give way are left out: releases decide who
/// passes first.
///
/// A place has two nodes if the robot has to assume two headings in it, for two goals. It also has two nodes
/// if the robot is served where its first node is known.
Route route_of(const core::Robot& robot, core::Actions actions, const std::vector<core::ActionPlace>& cuts,
               double wait_before_move, const RouteStart& start = {});

/// Adds points to the points of a robot, so that a translation never takes longer than so many seconds from
/// point to point. Ends early when `work` is met.
std::vector<core::ActionPlace> with_points_within(double seconds, std::vector<core::ActionPlace> points,
                                                  core::Actions actions, core::Work& work);

/// A robot may not pass a place before another robot has reached a place of its own.
struct Gate {
  std::size_t robot = 0;
  core::ActionPlace place;
  std::size_t other = 0;
  core::ActionPlace until;
};

/// Returns the gates of dependencies. Gates within translations are a little earlier, and the places that
/// open them a little later. So robots that stand at such places are a little farther from each other than
/// dependencies require. Each is moved by a quarter of the slack, which keeps their order in time, and by at
/// most a centimetre.
std::vector<Gate> gates_of(const std::vector<core::Dependency>& dependencies,
                           const std::vector<core::Actions>& actions);

/// Returns the places of gates, and the places that open them, by robot; ascending and each once.
std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<Gate>& gates, std::size_t robots);

/// Returns, by robot, the first gate that is closed when every robot has reached the place of its progress.
/// If all gates are open, returns a place that no robot reaches.
std::vector<core::ActionPlace> closed_gates(const std::vector<Gate>& gates,
                                            const std::vector<core::ActionPlace>& progress);

/// Returns how many of the first nodes of a route come before or at the gate that is `closed`. At least the
/// first node is released.
///
/// Robots never wait for each other for ever, although they report only nodes:
///
/// - There is a node at each gate and each `until` within a translation.
/// - Standing robots occupy the same place, so a gate within a stand acts where the stand ends.
/// - An `until` within a stand is reported with the next node, which is no later than the next gate.
std::size_t released_nodes(const Route& route, const core::ActionPlace& closed);

/// Returns how many of the first nodes of a route the plan reaches within so many seconds after the progress.
/// The next node is always included.
std::size_t nodes_within(double seconds, const Route& route, core::Actions actions,
                         const core::ActionPlace& progress);

}  // namespace fleetplan::api
