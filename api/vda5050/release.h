#pragma once

// Which nodes of its route a robot may pass.

#include <cstddef>
#include <vector>

#include "api/vda5050/route.h"
#include "core/execution/dependency.h"

namespace fleetplan::api {

/// The points of routes that dependencies name, by robot, ascending and each once.
std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<core::Dependency>& dependencies,
                                                      std::size_t robots);

/// How many nodes of each route, the first ones, are released when every robot has reached the point of its
/// progress: those that come before or at the first gate whose `until` is not reached. At least the first.
///
/// No robots wait for each other for ever, although they report nodes only: there is a node at each gate and
/// each `until` within a translation; standing robots occupy the same place, so a gate within a stand acts
/// where it ends, and an `until` there is reported with the next node, which is no later than the next gate.
std::vector<std::size_t> released_nodes(const std::vector<Route>& routes,
                                        const std::vector<core::Dependency>& dependencies,
                                        const std::vector<core::ActionPlace>& progress);

}  // namespace fleetplan::api
