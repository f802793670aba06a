#include "core/moves/single_move_search.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

/// How many times as much the way that is left counts as the way so far.
constexpr float kGreed = 4.0F;
/// Configurations between two checks of the stop condition.
constexpr std::size_t kConfigurationsBetweenPolls = 64;
constexpr std::size_t kFirstTable = 1024;

/// FNV-1a by words, with a last mix of the bits.
std::size_t hash_of(std::vector<int>::const_iterator at, std::size_t count) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (std::size_t k = 0; k < count; ++k, ++at) {
    hash ^= static_cast<std::uint32_t>(*at);
    hash *= 0x100000001B3;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

SingleMoveSearch::SingleMoveSearch(const JointSteps& steps)
    : steps_(steps), table_(kFirstTable, kNone), at_(steps.size(), 0) {
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
    std::copy_n(places_of(node), at_.size(), at_.begin());
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
    plan.emplace_back(places_of(node), places_of(node) + static_cast<std::ptrdiff_t>(steps_.size()));
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
  std::uint32_t& slot = find(at);
  if (slot == kNone) {
    slot = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({before, way});
    places_.insert(places_.end(), at.begin(), at.end());
  } else {
    Node& known = nodes_[slot];
    if (known.is_closed || !(way < known.way)) return;
    known.before = before;
    known.way = way;
  }
  float left = 0.0F;
  for (std::size_t robot = 0; robot < at.size(); ++robot) left += steps_.robot(robot).at(at[robot]).to_go;
  open_.emplace(way + kGreed * left, slot);
  if (2 * nodes_.size() > table_.size()) grow();
}

/// The slot of a configuration in the table; kNone is written there if it is not known.
std::uint32_t& SingleMoveSearch::find(const Configuration& at) {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash_of(at.begin(), at.size()) & mask;
  // Bounded: half of the slots are free.
  while (table_[slot] != kNone && !std::equal(at.begin(), at.end(), places_of(table_[slot]))) {
    slot = (slot + 1) & mask;
  }
  return table_[slot];
}

void SingleMoveSearch::grow() {
  table_.assign(2 * table_.size(), kNone);
  const std::size_t mask = table_.size() - 1;
  // Bounded: half of the slots stay free.
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    std::size_t slot = hash_of(places_of(node), at_.size()) & mask;
    while (table_[slot] != kNone) slot = (slot + 1) & mask;
    table_[slot] = node;
  }
}

}  // namespace fleetplan::core
