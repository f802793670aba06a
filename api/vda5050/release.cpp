#include "api/vda5050/release.h"

#include <algorithm>
#include <limits>

#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

constexpr core::ActionPlace kNever{std::numeric_limits<std::size_t>::max(), 0.0};

/// The planned time at which a robot comes to a place.
double time_of(core::Actions actions, const core::ActionPlace& place) {
  if (actions.empty()) return 0.0;
  if (place.fraction > 0.0) return core::planned_time(actions, place.action, place.fraction);
  return place.action == 0 ? actions.front().t_start : actions[place.action - 1].t_end;
}

/// The place of a fraction of a translation. One that is nearer to an end than rounding is that end.
core::ActionPlace place_in(const core::ActionProgress& progress, double length) {
  const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
  if (fraction * length <= core::kSamePosition) return {progress.action, 0.0};
  if ((1.0 - fraction) * length <= core::kSamePosition) return {progress.action + 1, 0.0};
  return {progress.action, fraction};
}

/// The place that is earlier, or later, in a translation by this time (seconds), or by kClearance if that is
/// nearer.
core::ActionPlace moved(const core::ActionProgress& progress, core::Actions actions, double seconds) {
  constexpr double kClearance = 0.01;  // metres
  const core::ActionPlace place = core::place_of(progress);
  if (place.fraction <= 0.0 || actions[place.action].type != core::Action::Type::translate) return place;
  const core::Action& action = actions[place.action];
  const double duration = action.t_end - action.t_start;
  const double length = (action.to.position - action.from.position).norm();
  if (duration <= 0.0 || length <= 0.0) return place;
  const double most = kClearance / length;
  double change = seconds / duration;
  if (action.profile) {
    const double planned = core::planned_time(actions, place.action, place.fraction) - action.t_start;
    const double elapsed = std::clamp((planned + seconds) / duration, 0.0, 1.0);
    change = core::share_covered(action, elapsed) - place.fraction;
  }
  change = std::clamp(change, -most, most);
  return place_in({progress.robot, progress.action, progress.fraction + change}, length);
}

}  // namespace

std::vector<Gate> gates_of(const std::vector<core::Dependency>& dependencies,
                           const std::vector<core::Actions>& actions) {
  constexpr double kShare = 0.25;  // of the slack
  std::vector<Gate> gates;
  gates.reserve(dependencies.size());
  for (const core::Dependency& dependency : dependencies) {
    const core::ActionProgress& gate = dependency.gate;
    const core::ActionProgress& until = dependency.until;
    const double time = kShare * dependency.slack;
    gates.push_back({gate.robot, moved(gate, actions[gate.robot], -time), until.robot,
                     moved(until, actions[until.robot], time)});
  }
  return gates;
}

std::vector<std::vector<core::ActionPlace>> points_of(const std::vector<Gate>& gates, std::size_t robots) {
  std::vector<std::vector<core::ActionPlace>> points(robots);
  for (const Gate& gate : gates) {
    points[gate.robot].push_back(gate.place);
    points[gate.other].push_back(gate.until);
  }
  for (auto& of_robot : points) {
    std::sort(of_robot.begin(), of_robot.end());
    of_robot.erase(std::unique(of_robot.begin(), of_robot.end()), of_robot.end());
  }
  return points;
}

std::vector<core::ActionPlace> closed_gates(const std::vector<Gate>& gates,
                                            const std::vector<core::ActionPlace>& progress) {
  std::vector<core::ActionPlace> closed(progress.size(), kNever);
  for (const Gate& gate : gates) {
    if (gate.until <= progress[gate.other]) continue;
    closed[gate.robot] = std::min(closed[gate.robot], gate.place);
  }
  return closed;
}

std::size_t released_nodes(const Route& route, const core::ActionPlace& closed) {
  const auto is_open = [&](const RouteNode& node) { return node.at <= closed; };
  const auto end = std::partition_point(route.nodes.begin(), route.nodes.end(), is_open);
  return std::max<std::size_t>(1, static_cast<std::size_t>(end - route.nodes.begin()));
}

std::size_t nodes_within(double seconds, const Route& route, core::Actions actions,
                         const core::ActionPlace& progress) {
  const double end = time_of(actions, progress) + seconds;
  const auto is_within = [&](const RouteNode& node) {
    return node.at <= progress || time_of(actions, node.at) <= end;
  };
  const auto is_behind = [&](const RouteNode& node) { return node.at <= progress; };
  const auto first = route.nodes.begin();
  const auto within = std::partition_point(first, route.nodes.end(), is_within) - first;
  const auto behind = std::partition_point(first, route.nodes.end(), is_behind) - first;
  return std::min(route.nodes.size(), static_cast<std::size_t>(std::max(within, behind + 1)));
}

}  // namespace fleetplan::api
