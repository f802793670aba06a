#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

class Vertices;

/// How long translations take along the fastest ways of lattice moves and links from where a robot sets out,
/// as far as it takes to reach its goal (A*; Hart, Nilsson and Raphael, 1968). Each move has the greatest
/// speed where it begins. The ways follow rooms, corridors and zones, which a straight line does not, and
/// take a small part of the effort of any-angle ways.
class TimesFromStart {
 public:
  /// Between two vertices; `vertices` outlives this object.
  TimesFromStart(const Vertices& vertices, int start, int goal);

  /// Whether there is a way to the goal; none if that takes more than `max_expansions` more expansions, or if
  /// `stop` is met first.
  std::optional<bool> reach_goal(std::int64_t max_expansions, const StopCondition& stop);

  /// A lower bound for the ways to a vertex, seconds; exact on the fastest way to the goal. 0 as long as the
  /// goal is not reached.
  double at_least(int vertex);

  std::int64_t expansions() const { return expansions_; }
  /// Approximate memory in use, bytes.
  std::size_t bytes() const { return times_.bytes(); }

 private:
  struct Time {
    float seconds = static_cast<float>(kForever);
  };
  struct Open {
    float estimate;  // of the time by way of the vertex to the goal, seconds
    float seconds;
    std::int32_t vertex;
    bool operator>(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : vertex > other.vertex;
    }
  };

  float& time(int vertex) { return times_[static_cast<std::size_t>(vertex)].seconds; }
  double to_goal(int vertex) const;
  void open(int vertex, float seconds);
  void expand(const Open& best);

  const Vertices& vertices_;
  const int goal_;
  const Position goal_position_;
  PagedArray<Time> times_;  // of the fastest ways known
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::int64_t expansions_ = 0;
  bool reached_goal_ = false;
};

}  // namespace fleetplan::core
