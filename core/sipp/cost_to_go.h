#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "core/instance.h"
#include "core/map/paged_array.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// What it costs a robot that is alone on the static map to get from a vertex to its goal: straight where it
/// sees the goal, elsewhere along the tree of a backward search from the goal (Theta*, Daniel et al., JAIR
/// 2010, with turns counted) that is resumed when a vertex is asked for that it has not reached yet. The cost
/// of a path that exists, so close to the optimum from above: it guides a search, it is no lower bound.
class CostToGo {
 public:
  struct Estimate {
    double seconds = 0.0;   // without the rotation to `heading`; kForever if there is no way
    double heading = 0.0;   // of the first translation
    bool straight = false;  // the goal is in sight
  };

  /// The robot must have a goal. `vertices` outlives this object.
  CostToGo(const Instance& instance, std::size_t robot, const Vertices& vertices);

  /// From any vertex but the goal. When `stop` is met meanwhile, the estimate is a straight line's.
  Estimate from(int vertex, const StopCondition& stop);

  /// Roughly the memory in use, bytes.
  std::size_t bytes() const { return nodes_.bytes(); }

 private:
  enum class State : std::uint8_t { unseen, open, closed };
  struct Node {
    double seconds = 0.0;
    double heading = 0.0;
    std::int32_t next = -1;  // the vertex that the first translation ends at
    State state = State::unseen;
    bool sight_known = false;
    bool in_sight = false;
  };
  struct Open {
    double key;
    double seconds;
    std::int32_t vertex;
    bool operator>(const Open& other) const {
      return key != other.key ? key > other.key : vertex > other.vertex;
    }
  };

  Node& node(int vertex) { return nodes_[static_cast<std::size_t>(vertex)]; }
  /// The cost from `vertex` when it first translates straight to `next`, which is closed or the goal.
  Estimate via(int vertex, int next);
  bool goal_in_sight(int vertex);
  void relax(int vertex, int next);
  void close(int vertex);
  void expand_best();

  const Instance& instance_;
  std::size_t robot_;
  const Motion& motion_;
  const Vertices& vertices_;
  Position start_;
  PagedArray<Node> nodes_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace fleetplan::core
