#pragma once

#include <cstddef>

#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_limits.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {

/// AA-SIPP with headings: any-angle safe-interval path planning for one robot among reservations (paper,
/// section "Individual planner: enhanced AA-SIPP"; Phillips and Likhachev, ICRA 2011; Yakovlev and
/// Andreychuk, ICAPS 2017).
///
/// Terms. A *place* is a vertex with its safe intervals. A *label* is a settled node of the search: a place,
/// one of its safe intervals and a heading, with the arrival g. An *entry* of OPEN is a move into one safe
/// interval that has no label yet. Its g is a lower bound until the entry is *timed*, that is, tested against
/// the reservations; from then on its g is exact. An entry starts at the label that was expanded (*local*
/// edge) or, any-angle, at that label's parent (*shortcut*). See search_state.h and open_list.h.
///
/// Pseudo-code, with the subsections of the paper in brackets:
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
///         if g rose above its lower bound, or there is no departure:
///           if it is a shortcut, offer the local edge
///           if there is a departure and the arrival is not dominated: push the timed entry
///           continue
///       else if the entry is dominated by now: continue
///       label <- settle (vertex, safe interval, heading) with g      ["High-level overview"]
///       if label is at the goal in its last safe interval: stop
///       with a horizon: stop at the best label from there on in a safe interval without end
///       expand label:
///         if the goal is in sight (any-angle): offer the straight move to it
///         for each neighbour: offer the shortcut from the label's parent (any-angle), or else the local
///           edge, into the first safe interval that one of them can reach
///     offer: push an entry with the lower bound of g, unless it is impossible, too expensive or dominated
///
/// DominanceTable defines "dominates". A timed entry takes part in dominance as if it were a label. The paper
/// increments waits by a step until a move is free of collisions; here departures have a closed form.
///
/// run() makes one or two passes of this search. The quick pass also discards arrivals that are not
/// dominated but hardly better than others (SearchLimits::thorough). If it finds no path and has discarded
/// such an arrival, the complete pass searches again and discards dominated arrivals only.
class AaSipp {
 public:
  explicit AaSipp(const ReservationTable& table) : table_(table) {}

  /// Plans `robot` from the end of its committed actions, or its start, to its goal (which it has). The robot
  /// holds no reservation.
  SearchResult run(std::size_t robot, SearchSpace& space, const SearchLimits& limits,
                   const StopCondition& stop);

  /// Frees what is kept for the next search.
  void release_memory() { state_ = SearchState(); }

 private:
  const ReservationTable& table_;
  SearchState state_;  // of one search; a member only to reuse its memory
};

}  // namespace fleetplan::core
