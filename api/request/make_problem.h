#pragma once

#include <optional>
#include <vector>

#include "api/json/faults.h"
#include "api/request/parse_body.h"
#include "core/map/map_cache.h"
#include "core/model/problem.h"

namespace fleetplan::api {

struct MadeProblem {
  core::Problem problem;
  /// Of each robot, why it is invalid; empty lists for the others, or no lists at all.
  std::vector<std::vector<Fault>> errors;
};

/// The problem of a fleet with a map, and of its robots whose radius and start could be read; the faults of
/// other robots hide none of these. Takes the map, the actions, the goals and the obstacles out of the fleet.
/// Poses in obstacles, overlapping starts or last goals and committed motion that collides are faults; then
/// there is no problem, nor if the stop is met. If invalid robots are to be reported, there is one: these
/// robots are in it as invalid ones, which stand at their starts. `maps` has those of earlier requests; may
/// be null.
std::optional<MadeProblem> make_problem(Fleet& fleet, const JsonReader& root, core::Work& stop,
                                        core::MapCache* maps);

}  // namespace fleetplan::api
