#pragma once

// Which nodes of orders vehicles may pass: dependencies become releases.

#include <cstddef>
#include <optional>
#include <vector>

#include "api/vda5050/route.h"
#include "core/execution/dependency.h"
#include "core/execution/executed_actions.h"

namespace fleetplan::api {

/// A robot may not pass a place before another one has reached its own.
struct Gate {
  std::size_t robot = 0;
  core::ActionPlace place;
  std::size_t other = 0;
  core::ActionPlace until;
};

/// Returns the gates of dependencies. Those within translations are a little earlier, and the places that
/// open them a little later, so that robots that stand at such places are a little further from each other
/// than dependencies ask: by a quarter of the slack each, which keeps their order in time, and by a
/// centimetre at most.
std::vector<Gate> gates_of(const std::vector<core::Dependency>& dependencies,
                           const std::vector<core::Actions>& actions);

/// Returns the places of gates, and those that open them, by robot, ascending and each once.
std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<Gate>& gates, std::size_t robots);

/// Returns by robot the first gate that is closed when every robot has reached the place of its progress; a
/// place that no robot reaches, if all are open.
std::vector<core::ActionPlace> closed_gates(const std::vector<Gate>& gates,
                                            const std::vector<core::ActionPlace>& progress);

/// Returns how many nodes of a route, the first ones, come before or at the gate that is `closed`. At least
/// the first node is released.
///
/// No robots wait for each other for ever, although they report nodes only: there is a node at each gate and
/// each `until` within a translation; standing robots occupy the same place, so a gate within a stand acts
/// where it ends, and an `until` there is reported with the next node, which is no later than the next gate.
std::size_t released_nodes(const Route& route, const core::ActionPlace& closed);

/// Returns how many nodes of a route, the first ones, the plan reaches within so many seconds from the
/// progress on, and the next one in any case.
std::size_t nodes_within(double seconds, const Route& route, core::Actions actions,
                         const core::ActionPlace& progress);

}  // namespace fleetplan::api
