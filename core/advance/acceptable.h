#pragma once

// Whether the next request can be planned wherever robots were measured: which parts of commitments to leave
// out for this, and which problems remain.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/advance/commitment_collisions.h"
#include "core/advance/committed_motion.h"
#include "core/advance/moment.h"
#include "core/geometry/position.h"
#include "core/map/static_map.h"
#include "core/model/plan_options.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The facts by which the next request is judged when it is planned. Refers to the request.
struct Judgement {
  const PlanOptions& options;
  const std::vector<Zone>& zones;
  bool reports_invalid;  // robots in walls are reported, the others are planned
  /// Returns a position as the planner of the next request reads it: rounded in the frame of the client.
  std::function<Position(const Position&)> read_back;
  /// The map, if it is needed. Null if there is no time or memory for it.
  std::function<std::shared_ptr<const StaticMap>()> map;
};

/// Problems with the positions of robots that cannot be mended.
struct Circumstances {
  std::optional<double> start_overlap = {};  // metres that starts may overlap; none: as the options allow
  bool some_in_walls = false;                // robots whose centres are, which have to be reported as invalid
  Collisions unavoidable = {};
};

/// Ends committed actions early, where Problem would not accept them:
///
/// 1. For robots that were measured, or have reported where they are: before they meet walls or zones, or
///    break the rules of zones.
/// 2. For other robots: before they would drive into these robots, see clear_commitments.
///
/// `next`: the robots of the next request, which follow from the fleet. Ends early when `work` is met.
Circumstances make_acceptable(const FleetInMotion& fleet, const Judgement& judgement,
                              std::vector<Robot>& next, Motions& motions, Work& work);

}  // namespace fleetplan::core
