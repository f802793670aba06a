#pragma once

// The request of a later moment is one that POST /v1/plan accepts, wherever robots were measured.

#include <optional>
#include <vector>

#include "api/advance/advance_request.h"
#include "api/advance/committed_motion.h"
#include "core/map/static_map.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// What is wrong with where robots are, and cannot be mended.
struct Circumstances {
  std::optional<double> start_overlap = {};  // metres that starts may overlap; none: as the request allows
  bool some_in_walls = false;                // robots whose centres are, which have to be reported as invalid
  std::vector<Collision> unavoidable = {};   // the first ones
};

/// Ends committed actions of robots that were measured, or have reported where they are, before they meet
/// walls or zones, or break the rules of zones, as /v1/plan judges it; then those of others that would drive
/// into them, see clear_commitments. `request`: that the robots follow from, whose map is taken. `braking`:
/// by robot, see braking_of. `maps`: those of earlier requests; may be null. Ends early when the stop is met.
Circumstances make_acceptable(AdvanceRequest& request, std::vector<core::Robot>& robots,
                              const std::vector<std::vector<core::Action>>& braking, core::MapCache* maps,
                              core::Work& stop);

}  // namespace fleetplan::api
