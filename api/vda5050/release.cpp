#include "api/vda5050/release.h"

#include <algorithm>
#include <limits>

namespace fleetplan::api {

std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<core::Dependency>& dependencies,
                                                      std::size_t robots) {
  std::vector<std::vector<core::ActionPlace>> points(robots);
  // Bounded: two places of each dependency.
  for (const core::Dependency& dependency : dependencies) {
    for (const core::ActionProgress& progress : {dependency.gate, dependency.until}) {
      points[progress.robot].push_back(core::place_of(progress));
    }
  }
  for (auto& of_robot : points) {
    std::sort(of_robot.begin(), of_robot.end());
    of_robot.erase(std::unique(of_robot.begin(), of_robot.end()), of_robot.end());
  }
  return points;
}

std::vector<std::size_t> released_nodes(const std::vector<Route>& routes,
                                        const std::vector<core::Dependency>& dependencies,
                                        const std::vector<core::ActionPlace>& progress) {
  constexpr core::ActionPlace kNever{std::numeric_limits<std::size_t>::max(), 0.0};
  std::vector<core::ActionPlace> closed(routes.size(), kNever);  // the first gate that is not open
  for (const core::Dependency& dependency : dependencies) {
    if (core::place_of(dependency.until) <= progress[dependency.until.robot]) continue;
    core::ActionPlace& first = closed[dependency.gate.robot];
    first = std::min(first, core::place_of(dependency.gate));
  }
  std::vector<std::size_t> released;
  released.reserve(routes.size());
  for (std::size_t robot = 0; robot < routes.size(); ++robot) {
    const auto& nodes = routes[robot].nodes;
    const auto is_open = [&](const RouteNode& node) { return node.at <= closed[robot]; };
    const auto end = std::partition_point(nodes.begin(), nodes.end(), is_open);
    released.push_back(static_cast<std::size_t>(end - nodes.begin()));
  }
  return released;
}

}  // namespace fleetplan::api
