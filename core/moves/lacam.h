#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/moves/configuration_search.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A fleet that moves on a graph in steps. In each step, every robot goes to a neighbouring vertex or stays.
struct StepProblem {
  static constexpr int kNone = -1;
  /// The largest number of robots times vertices: with more, the distances to all goals take too much memory.
  static constexpr std::size_t kMaxDistances = 20'000'000;
  /// Vertices between two checks of the stop condition.
  static constexpr std::size_t kVerticesBetweenPolls = 4096;
  /// By vertex and direction, the vertices that one step reaches, or kNone. The step back has the opposite
  /// direction: 0 and 1 are opposite, and so are 2 and 3.
  using Neighbours = std::vector<std::array<int, 4>>;
  struct Mover {
    std::size_t graph = 0;  // of `graphs`
    int start = 0;          // no two robots have the same
    int goal = 0;           // no two robots have the same
  };

  std::vector<Neighbours> graphs;  // by kind of robot; all have the same vertices
  std::vector<Mover> movers;
};

/// Plans all robots at once by LaCAM (Okumura, AAAI 2023), a search over configurations. It makes the next
/// configuration with PIBT (Okumura et al., Artificial Intelligence, 2022), and tries all others lazily. So
/// it finds a plan where prioritized planning fails without end: in crowds, and in corridors in which only
/// one robot has room. At first, robots avoid ways that most other robots take in the opposite direction.
///
/// Returns the configurations from the starts to the goals. No two robots are at the same vertex or exchange
/// their vertices in a step. No robots move in a cycle in one step, each to the place of the next.
///
/// Returns none if
///
/// - there is no such plan,
/// - `stop` is met first,
/// - the search takes too much memory in several tries,
/// - there are too many robots and vertices,
/// - or a way has more than 8000 steps.
std::optional<std::vector<Configuration>> plan_steps(const StepProblem& problem, Random& random,
                                                     const StopCondition& stop);

}  // namespace fleetplan::core
