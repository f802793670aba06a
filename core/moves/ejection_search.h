#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Makes way for robots that find no path in a dense crowd. It ejects a few other robots: their trajectories
/// are removed, and they are planned again. As in guided ejection search (Nagata and Braysy, 2009), robots
/// that fail often are the last to be ejected.
class EjectionSearch {
 public:
  EjectionSearch(PlanState& state, Random& random, const StopCondition& stop);

  /// Plans `robot`, which has no reservation, so that it conflicts with few of the other robots that follow a
  /// trajectory (`planned`). Changes no reservation. `failures` counts how often each robot has failed.
  ///
  /// 1. Ignores an eighth of the other robots, a quarter, half, and then all of them, until there is a path.
  ///    It first ignores robots with few failures. A robot for which others were ejected is ignored last for
  ///    a while, so that two robots do not eject each other for ever.
  /// 2. Plans again and ignores fewer of the robots that conflict with the path, as long as there is a path.
  ///    In the end, every robot that is still ignored has to be.
  SearchResult plan(std::size_t robot, std::vector<std::size_t> planned, const std::vector<int>& failures);

 private:
  using Robots = std::vector<std::size_t>;

  void sort_by_ejection(Robots& planned, const std::vector<int>& failures);
  std::vector<std::size_t> counts_to_ignore(const Robots& planned) const;
  SearchResult eject_fewer(std::size_t robot, SearchResult result, const Robots& planned);
  bool is_protected(std::size_t robot) const { return protected_until_[robot] > calls_; }

  PlanState& state_;
  Random& random_;
  const StopCondition& stop_;
  std::int64_t calls_ = 0;
  std::vector<std::int64_t> protected_until_;  // by robot: the call from which on others may eject it again
};

}  // namespace fleetplan::core
