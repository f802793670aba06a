#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// Some of the vertices of a robot, and straight moves between them: a sparse graph of where it can go. A
/// fleet has far fewer configurations on it. All ways that matter lead through it:
///
/// - Each vertex that can be reached from the start is within `spacing` metres of a chosen vertex.
/// - The ends of dead ends are chosen first.
/// - Chosen vertices whose neighbourhoods touch are joined along the shortest way over vertices, unless other
///   vertices join them about as well.
class SparseVertices {
 public:
  /// `wanted`: places that are chosen, too, if the robot can come there: starts and ends of other robots.
  SparseVertices(const Vertices& vertices, const std::vector<int>& required,
                 const std::vector<Position>& wanted, double spacing, const StopCondition& stop);

  /// Where straight moves from a chosen vertex lead.
  const std::vector<int>& steps_from(int vertex) const;

 private:
  std::unordered_map<int, std::vector<int>> steps_;
};

}  // namespace fleetplan::core
