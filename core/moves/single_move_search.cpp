#include "core/moves/single_move_search.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

/// Configurations between two checks of the stop condition.
constexpr std::size_t kConfigurationsBetweenPolls = 64;

}  // namespace

SingleMoveSearch::SingleMoveSearch(const JointSteps& steps)
    : steps_(steps), known_(steps.size()), at_(steps.size(), 0) {
  add(at_, kNone, 0.0F);
}

SingleMoveSearch::Outcome SingleMoveSearch::run(std::size_t max_configurations, const StopCondition& stop) {
  StopStride stride(stop, kConfigurationsBetweenPolls);
  while (!open_.empty()) {
    if (nodes_.size() >= max_configurations || stride.met_at_step()) return Outcome::cut_off;
    const std::uint32_t node = open_.top().second;
    open_.pop();
    if (nodes_[node].is_closed) continue;
    nodes_[node].is_closed = true;
    std::copy_n(known_[node], at_.size(), at_.begin());
    if (steps_.is_end(at_)) {
      end_ = node;
      return Outcome::found;
    }
    expand(node);
  }
  return Outcome::none;
}

std::vector<Configuration> SingleMoveSearch::plan() const {
  std::vector<Configuration> plan;
  for (std::uint32_t node = end_; node != kNone; node = nodes_[node].before) {
    plan.emplace_back(known_[node], known_[node] + static_cast<std::ptrdiff_t>(steps_.size()));
  }
  std::reverse(plan.begin(), plan.end());
  return plan;
}

void SingleMoveSearch::expand(std::uint32_t node) {
  // Bounded: the steps of each robot from one place, and the others for each of them.
  for (std::size_t robot = 0; robot < at_.size(); ++robot) {
    const int from = at_[robot];
    const StepPlaces& places = steps_.robot(robot);
    for (const StepPlaces::Step& step : places.steps_from(from)) {
      if (!places.has_way(step.to) || steps_.touches_any(robot, step, at_)) continue;
      at_[robot] = step.to;
      add(at_, node, nodes_[node].way + step.length);
      at_[robot] = from;
    }
  }
}

void SingleMoveSearch::add(const Configuration& at, std::uint32_t before, float way) {
  const std::uint32_t node = known_.add(at);
  if (node == nodes_.size()) {
    nodes_.push_back({before, way});
  } else {
    Node& known = nodes_[node];
    if (known.is_closed || !(way < known.way)) return;
    known.before = before;
    known.way = way;
  }
  float left = 0.0F;
  for (std::size_t robot = 0; robot < at.size(); ++robot) left += steps_.robot(robot).at(at[robot]).to_go;
  open_.emplace(way + kGreed * left, node);
}

}  // namespace fleetplan::core
