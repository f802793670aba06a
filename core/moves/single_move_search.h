#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "core/moves/configuration_search.h"
#include "core/moves/joint_steps.h"
#include "core/moves/known_tuples.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans robots in steps: in each step, one robot moves while all others rest. A best-first search over
/// configurations, in which the way that is left counts more than the way so far. With few robots in little
/// room, it can visit all configurations.
class SingleMoveSearch {
 public:
  /// The weight of the way that is left, relative to the way so far.
  static constexpr float kGreed = 4.0F;

  /// `steps` outlive this object.
  explicit SingleMoveSearch(const JointSteps& steps);

  enum class Outcome : std::uint8_t {
    found,
    /// There is no plan: all configurations that such steps reach were visited.
    none,
    /// The search has reached its size limit, or `stop` was met. It may continue.
    cut_off,
  };
  /// Goes on until so many configurations are known.
  Outcome run(std::size_t max_configurations, const StopCondition& stop);

  /// Once the plan is found: the configurations from the starts to the goals.
  std::vector<Configuration> plan() const;
  /// How many configurations are known.
  std::size_t count() const { return nodes_.size(); }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Node {
    std::uint32_t before = kNone;
    float way = 0.0F;  // metres, of all robots from the starts on
    bool is_closed = false;
  };
  using Open = std::pair<float, std::uint32_t>;

  void expand(std::uint32_t node);
  void add(const Configuration& at, std::uint32_t before, float way);

  const JointSteps& steps_;
  KnownTuples known_;  // the places of all robots, by node
  std::vector<Node> nodes_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  Configuration at_;  // of the node that is expanded
  std::uint32_t end_ = kNone;
};

}  // namespace fleetplan::core
