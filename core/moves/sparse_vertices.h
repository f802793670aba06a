#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// Some of the vertices of a robot, and straight moves between them: a sparse picture of where it can go, in
/// which a fleet has far fewer configurations. All ways that matter lead through it: each vertex that can be
/// reached from the start is within `spacing` metres of a chosen one, the ends of dead ends are chosen first,
/// and chosen vertices whose neighbourhoods touch are joined along the shortest way over vertices, unless
/// others join them about as well.
class SparseVertices {
 public:
  /// `wanted`: places that are chosen, too, if the robot can come there: where others start and end.
  SparseVertices(const Vertices& vertices, const std::vector<int>& required,
                 const std::vector<Position>& wanted, double spacing, const StopCondition& stop);

  /// Where straight moves from a chosen vertex lead.
  const std::vector<int>& steps_from(int vertex) const;

 private:
  std::unordered_map<int, std::vector<int>> steps_;
};

}  // namespace fleetplan::core
