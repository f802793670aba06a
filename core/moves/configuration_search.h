#pragma once

// The search over configurations that plans a fleet in steps: LaCAM (Okumura, AAAI 2023).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Where all robots are: by robot, the number of a vertex or place.
using Configuration = std::vector<int>;

/// Binds one robot: in the next configuration, it must be at this place. The constraint before binds other
/// robots, and so on. The first constraint of a configuration binds no robot.
struct StepConstraint {
  static constexpr int kNone = -1;

  std::size_t before = 0;   // its place among the constraints of the configuration
  std::uint32_t depth = 0;  // the number of robots that are bound
  std::uint32_t robot = 0;
  int place = kNone;
};

/// How large a search over configurations may become.
struct ConfigurationLimits {
  std::size_t max_nodes = 0;        // configurations
  std::size_t max_places = 0;       // of robots, in all configurations together
  std::size_t max_constraints = 0;  // in all configurations together
};

/// Searches configurations depth-first, from the starts of a fleet to its goals. `Fleet` defines the fleet
/// and its steps:
///
/// - `Configuration starts()`, `bool is_end(const Configuration&)`;
/// - `bool is_home(robot, place)`: whether the robot need not move;
/// - `bool comes_before(a, b)`: which of two robots moves first if both have waited equally long;
/// - `void for_each_step(robot, place, visit)`: calls visit(place) for each place that one step reaches;
/// - `std::optional<Configuration> next(from, order, constraints, constraint, depth)`: a configuration that
///   one step reaches and that meets the constraint. None if there is none or if it finds none. If all robots
///   are bound, it finds the configuration whenever there is one. `depth`: steps from the starts.
///
/// The search makes each configuration once. It makes constraints lazily, until they bind all robots to each
/// of their steps. So it reaches every configuration that such steps reach, if it has enough time and memory.
template <class Fleet>
class ConfigurationSearch {
 public:
  ConfigurationSearch(Fleet& fleet, const ConfigurationLimits& limits, Random& random,
                      const StopCondition& stop)
      : fleet_(fleet), limits_(limits), random_(random), stop_(stop) {}

  /// The configurations from the starts to the goals. None if there is no way, if the search becomes too
  /// large, or if the stop condition is met first.
  std::optional<std::vector<Configuration>> run() {
    add(fleet_.starts(), nullptr);
    while (!open_.empty() && constraints_ < limits_.max_constraints && !stop_.met()) {
      Node& node = *open_.back();
      if (fleet_.is_end(node.at)) return path_to(node);
      if (node.next == node.made.size()) {
        open_.pop_back();
        continue;
      }
      const std::size_t constraint = node.next++;
      bind_one_more(node, constraint);
      std::optional<Configuration> made = fleet_.next(node.at, node.order, node.made, constraint, node.steps);
      if (!made) continue;
      const auto known = known_.find(bytes_of(*made));
      if (known != known_.end()) {
        open_.push_back(known->second);
      } else if (nodes_.size() >= limits_.max_nodes || nodes_.size() * made->size() >= limits_.max_places) {
        return std::nullopt;
      } else {
        add(std::move(*made), &node);
      }
    }
    return std::nullopt;
  }

  /// Whether the search has ended because there is no way.
  bool has_no_way() const { return open_.empty(); }

 private:
  /// A configuration of the search, and its constraints that have not been tried yet.
  struct Node {
    Configuration at;
    std::vector<std::int32_t> waited;  // by robot: steps since it was at its goal
    std::vector<std::size_t> order;    // of robots: the longest waiting come first
    std::vector<StepConstraint> made;  // in the order in which they are tried
    std::size_t next = 0;              // of `made`
    const Node* before = nullptr;
    std::size_t steps = 0;  // from the starts
  };

  static std::string_view bytes_of(const Configuration& configuration) {
    return {reinterpret_cast<const char*>(configuration.data()), configuration.size() * sizeof(int)};
  }

  void add(Configuration&& at, const Node* before) {
    Node& node = nodes_.emplace_back();
    node.at = std::move(at);
    node.before = before;
    node.steps = before == nullptr ? 0 : before->steps + 1;
    node.made.emplace_back();
    node.waited.resize(node.at.size());
    node.order.resize(node.at.size());
    for (std::size_t i = 0; i < node.at.size(); ++i) {
      const bool waits = before != nullptr && !fleet_.is_home(i, node.at[i]);
      node.waited[i] = waits ? before->waited[i] + 1 : 0;
      node.order[i] = i;
    }
    std::sort(node.order.begin(), node.order.end(), [&](std::size_t a, std::size_t b) {
      if (node.waited[a] != node.waited[b]) return node.waited[a] > node.waited[b];
      return fleet_.comes_before(a, b);
    });
    known_.emplace(bytes_of(node.at), &node);
    open_.push_back(&node);
  }

  /// Makes the constraints that also bind the next robot: to its own place, or to a place that one step
  /// reaches.
  void bind_one_more(Node& node, std::size_t constraint) {
    const std::uint32_t depth = node.made[constraint].depth;
    if (depth == node.at.size()) return;
    const std::size_t robot = node.order[depth];
    std::vector<int> places{node.at[robot]};
    fleet_.for_each_step(robot, node.at[robot], [&](int place) { places.push_back(place); });
    random_.shuffle(places);
    for (const int place : places) {
      node.made.push_back({constraint, depth + 1, static_cast<std::uint32_t>(robot), place});
    }
    constraints_ += places.size();
  }

  static std::vector<Configuration> path_to(const Node& last) {
    std::vector<Configuration> path;
    for (const Node* node = &last; node != nullptr; node = node->before) path.push_back(node->at);
    std::reverse(path.begin(), path.end());
    return path;
  }

  Fleet& fleet_;
  const ConfigurationLimits limits_;
  Random& random_;
  const StopCondition& stop_;
  std::deque<Node> nodes_;  // addresses stay
  std::unordered_map<std::string_view, Node*> known_;
  std::vector<Node*> open_;  // the last one is expanded
  std::size_t constraints_ = 0;
};

}  // namespace fleetplan::core
