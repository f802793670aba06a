#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/instance.h"
#include "core/model/itinerary.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// What a search for one robot needs besides reservations: where and when its plan begins, its goals, its
/// view of the static map, and the costs to go to each of its goals.
class SearchSpace {
 public:
  SearchSpace(const Instance& instance, std::size_t robot);

  const Itinerary& itinerary() const { return itinerary_; }
  const Vertices& vertices() const { return vertices_; }
  std::size_t goal_count() const { return vertices_.goals().size(); }
  /// The committed actions end at rest in the pose of the first goal.
  bool begins_in_goal_pose() const { return begins_in_goal_pose_; }

  /// To the goal with this index in Vertices::goals(), created on first use. Equal goals share theirs.
  CostToGo& cost_to_go(std::size_t goal);

  /// Expansions of all backward searches so far.
  std::int64_t expansions() const;
  /// Approximate memory in use, bytes.
  std::size_t bytes() const;

 private:
  const Itinerary& itinerary_;
  Vertices vertices_;
  bool begins_in_goal_pose_;
  std::vector<std::size_t> first_equal_;                // by goal
  std::vector<std::unique_ptr<CostToGo>> costs_to_go_;  // by goal, of the first of equal ones
};

}  // namespace fleetplan::core
