#pragma once

#include <cstddef>

#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/search_limits.h"
#include "core/sipp/search_state.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// AA-SIPP with headings: any-angle safe-interval path planning for one robot among reservations (paper,
/// section "Individual planner: enhanced AA-SIPP"; Phillips and Likhachev, ICRA 2011; Yakovlev and
/// Andreychuk, ICAPS 2017). In brackets: the subsections of the paper.
///
///     label the start and expand it
///     while OPEN is not empty:
///       if the best timed entry at the goal costs at most (1 + suboptimality) * min f: settle it, stop
///       entry <- OPEN.pop()                          smallest f = g + heuristic_weight * h
///       if entry is not timed:                       its g is a lower bound (lazy, as in Lazy Theta*)
///         offer the same edge into the target's next safe interval   ["Computing intervals"]
///         if it is a shortcut, test the line of sight                ["... w.r.t. static obstacles"]
///         if an arrival in the same interval dominates g: continue
///         g <- earliest arrival: rotate, wait, translate             ["... w.r.t. dynamic obstacles and
///                                     computing earliest arrival time", "Handling rotations"]
///         if g rose above its lower bound:
///           offer the local edge after a shortcut; push the timed entry unless dominated; continue
///       else if the entry is dominated by now: continue
///       label <- settle (vertex, safe interval, heading) with g      ["High-level overview"]
///       if label is at the goal in its last safe interval: stop
///       expand label: for each neighbour and each of its safe intervals,
///         offer the shortcut from the label's parent (any-angle), else the edge from the label
///     offer: push an entry with the lower bound of g, unless it is impossible, too expensive or dominated
///
/// DominanceTable defines "dominates". A timed entry takes part in dominance as if it were a label. The paper
/// increments waits by a step until a move is free of collisions; here departures have a closed form.
class AaSipp {
 public:
  explicit AaSipp(const ReservationTable& table) : table_(table) {}

  /// Plans `robot` from its start to its goal (which it has). The robot holds no reservation.
  SearchResult run(std::size_t robot, const Vertices& vertices, CostToGo& cost_to_go,
                   const SearchLimits& limits, const StopCondition& stop);

 private:
  const ReservationTable& table_;
  SearchState state_;  // of one search; a member only to reuse its memory
};

}  // namespace fleetplan::core
