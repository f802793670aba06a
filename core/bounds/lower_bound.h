#pragma once

// Lower bounds of costs, obstacles ignored.

#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/model/body.h"
#include "core/model/itinerary.h"
#include "core/model/plan_options.h"

namespace fleetplan::core {

/// The cost from a pose to the goal without obstacles, seconds: the straight line, and the rotations before
/// and after it, to the goal heading. The wait before moves is not included. No path costs less
/// (docs/proofs.md, Lemma 1). For a robot that may reverse: a lower bound of the cost of all paths. Paths may
/// go forwards and backwards beside the line (see reverse_bound).
double straight_cost(const Pose& from, const Goal& goal, const Body& body);

/// The way to a goal, from the goal before or from where the robot's plan begins.
struct GoalLeg {
  Position from{0.0, 0.0};
  std::optional<double> heading;  // none: the robot may begin with any
  Goal to;
};

/// The legs of a robot, in their order.
std::vector<GoalLeg> legs_of(const Itinerary& itinerary);

/// The straight cost of a leg. If the leg has no initial heading, any heading is assumed.
double straight_cost(const GoalLeg& leg, const Body& body);
/// A lower bound of the duration of a leg, seconds, without obstacles: the straight cost and one wait before
/// a move. Exact if the goal is in sight. Otherwise, TautPathSearch is tighter.
double lower_bound(const GoalLeg& leg, const Body& body);

/// When a robot ends its last service if each leg takes so many seconds.
double end_after(const Itinerary& itinerary, const std::vector<double>& seconds);

/// A lower bound of the cost of a robot with a goal, seconds, without obstacles. `bodies`: the robot's body
/// on each leg.
double lower_bound(const Itinerary& itinerary, const std::vector<Body>& bodies);

/// A lower bound of the cost, seconds, of a robot that may reverse. It gets `distance` metres (> 0) in a
/// direction, from one heading to another (none: any). Obstacles and waits are left out. The robot need not
/// turn into the direction: it may go forwards and backwards beside it, on a longer way. docs/proofs.md,
/// Lemma 4.
double reverse_bound(double distance, double direction, std::optional<double> from_heading,
                     std::optional<double> to_heading, const Body& body);

}  // namespace fleetplan::core
