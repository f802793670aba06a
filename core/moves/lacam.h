#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/moves/configuration_search.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A fleet that moves on a graph in steps: in each, every robot goes to a neighbouring vertex or stays.
struct StepProblem {
  static constexpr int kNone = -1;
  /// Robots times vertices: with more, the distances to all goals take too much memory.
  static constexpr std::size_t kMaxDistances = 20'000'000;
  /// Vertices between two checks of the stop condition.
  static constexpr std::size_t kVerticesBetweenPolls = 4096;
  /// By vertex and direction, the vertices that one step reaches, or kNone. The step back from there has the
  /// other direction of two: 0 and 1, or 2 and 3.
  using Neighbours = std::vector<std::array<int, 4>>;
  struct Mover {
    std::size_t graph = 0;  // of `graphs`
    int start = 0;          // no two robots have the same
    int goal = 0;           // no two robots have the same
  };

  std::vector<Neighbours> graphs;  // by kind of robot; all have the same vertices
  std::vector<Mover> movers;
};

/// Plans all robots at once: by LaCAM (Okumura, AAAI 2023), a search over configurations that makes the next
/// one with PIBT (Okumura et al., Artificial Intelligence, 2022), lazily trying all others. So it finds a
/// plan where priorities lead to no end of failures: in crowds, and in corridors in which only one robot has
/// room. At first, robots avoid the ways that most others come along from the other side.
///
/// Returns the configurations from the starts to the goals: no two robots are at the same vertex, exchange
/// their vertices in a step, or go round in a cycle in one step, each into the place of another one. None if
/// there is no such plan, if `stop` is met first, if the search takes too much memory in several tries, for
/// too many robots and vertices, and if a way has more than 8000 steps.
std::optional<std::vector<Configuration>> plan_steps(const StepProblem& problem, Random& random,
                                                     const StopCondition& stop);

}  // namespace fleetplan::core
