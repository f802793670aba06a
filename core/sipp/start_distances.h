#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/map/paged_array.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

class Vertices;

/// The lengths of the shortest ways along lattice moves and links from where a robot sets out, as far as it
/// takes to reach its goal (A*; Hart, Nilsson and Raphael, 1968). They follow rooms and corridors, which a
/// straight line does not, and take a small part of the effort of any-angle ways.
class StartDistances {
 public:
  /// Between two vertices; `vertices` outlives this object.
  StartDistances(const Vertices& vertices, int start, int goal);

  /// Whether there is a way to the goal; none if that takes more than `max_expansions` more expansions, or if
  /// `stop` is met first.
  std::optional<bool> reach_goal(std::int64_t max_expansions, const StopCondition& stop);

  /// A lower bound on the length of the ways to a vertex, metres; exact on the shortest way to the goal. 0 as
  /// long as the goal is not reached.
  double at_least(int vertex);

  std::int64_t expansions() const { return expansions_; }
  /// Approximate memory in use, bytes.
  std::size_t bytes() const { return lengths_.bytes(); }

 private:
  struct Length {
    float metres = static_cast<float>(kForever);
  };
  struct Open {
    float estimate;  // of the length by way of the vertex to the goal, metres
    float length;
    std::int32_t vertex;
    bool operator>(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : vertex > other.vertex;
    }
  };

  float& length(int vertex) { return lengths_[static_cast<std::size_t>(vertex)].metres; }
  double to_goal(int vertex) const;
  void open(int vertex, float length);
  void expand(const Open& best);

  const Vertices& vertices_;
  const int goal_;
  const Position goal_position_;
  PagedArray<Length> lengths_;  // of the shortest ways known
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::int64_t expansions_ = 0;
  bool reached_goal_ = false;
};

}  // namespace fleetplan::core
