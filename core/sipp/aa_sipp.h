#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/geometry/segment.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {

/// A long search asks it whether it can end because there is no path.
class NoPathTest {
 public:
  NoPathTest() = default;
  virtual ~NoPathTest() = default;
  NoPathTest(const NoPathTest&) = delete;
  NoPathTest& operator=(const NoPathTest&) = delete;

  virtual bool no_path(std::int64_t expansions) = 0;
};

/// The parameters of the search for one robot: limits of cost and effort, and the accepted suboptimality.
struct SearchSettings {
  double bound = kForever;        // seconds; only trajectories that cost less are accepted
  double heuristic_weight = 1.1;  // >= 1; weight of h in f = g + weight * h (weighted A*; Pohl, 1970)
  double suboptimality = 0.01;    // accepts a path to the goal that costs at most (1 + this) * the smallest f
  double suboptimality_growth = 1e-4;  // added to `suboptimality` with every expansion
  /// Relaxes dominance between arrivals in the same safe interval, whatever their heading. An arrival also
  /// counts as dominated if it is later than another, or earlier by less than a slack. The slack is the time
  /// to translate by this many lattice spacings. 0: exact dominance.
  double dominance_slack = 0.2;
  /// Seconds: from this time on, a path may also end wherever the robot may rest for good. It then costs the
  /// estimate of its static way from there in addition. kForever: a path ends only at the goal.
  double horizon = kForever;
  double start_delay = 0.0;  // seconds, >= 0; the robot stays where it begins at least this long
  /// Search again with exact dominance if the quick search finds nothing. The quick search applies
  /// `dominance_slack`. While f is below the time from which the goal is free, it keeps only one label per
  /// safe interval.
  bool thorough = true;
  /// Limits the expansions of both searches together. A search that needs more ends as not complete.
  std::int64_t max_expansions = std::numeric_limits<std::int64_t>::max();
  /// May be null. Asked after kFirstTest expansions and whenever their number has doubled.
  NoPathTest* no_path_test = nullptr;
  static constexpr std::int64_t kFirstTest = 512;
};

/// The result of a search for one robot.
struct SearchResult {
  std::optional<Trajectory> trajectory;
  /// False if there is no trajectory because the stop condition or max_expansions ended the search. If true,
  /// and the search was `thorough`, no trajectory costs less than the bound, except for trajectories that
  /// dominance loses (docs/proofs.md).
  bool complete = true;
  std::int64_t expansions = 0;
};

/// AA-SIPP with headings: any-angle safe-interval path planning for one robot among reservations (paper,
/// section "Individual planner: enhanced AA-SIPP"; Phillips and Likhachev, ICRA 2011; Yakovlev and
/// Andreychuk, ICAPS 2017).
///
/// Terms. A *stage* leads to the next goal of the robot (Goals). A *place* is a vertex in a stage, with its
/// safe intervals. A *label* is a settled node of the search: a place, one of its safe intervals and a
/// heading, with the arrival g. An *edge* leads from a label to a neighbour of its place, straight to the
/// goal, or by a service into the next stage (Successors).
///
/// An *entry* of OPEN is a move along an edge into one safe interval that has no label yet. Its g is a lower
/// bound at first. An entry that has been tested against the reservations is *timed*, and its g is exact. A
/// move starts at the label that was expanded (*local*) or, any-angle, at that label's parent (*shortcut*).
/// See search_state.h.
///
/// Pseudo-code, with the functions that do it, and the subsections of the paper in brackets:
///
///     label the start and expand it                          label_start
///     while OPEN is not empty:                               run
///       if the best timed entry at the end costs at most (1 + suboptimality) * min f: settle it, stop
///                                                            PathEnd::goal_suffices
///       with a horizon: if no entry has a clearly smaller f than the best label to rest at, stop there
///                                                            PathEnd::rest_suffices
///       entry <- OPEN.pop()                                  smallest f = g + heuristic_weight * h
///       if entry is not timed:                               time_entry: lazy, as in Lazy Theta*
///         if it is a shortcut, test the line of sight        Successors::test_sight
///                                                              ["... w.r.t. static obstacles"]
///         offer the same edge into the target's next safe interval   ["Computing intervals"]
///         if an arrival in the same interval dominates g: continue       DominatedArrivals
///         g <- earliest arrival: rotate, wait, translate     Successors::earliest_departure
///                                     ["... w.r.t. dynamic obstacles and computing earliest arrival time"]
///         if g rose above its lower bound, or there is no departure:
///           if it is a shortcut, offer the local move
///           if there is a departure and the arrival is not dominated: push the timed entry
///           continue
///       else if the entry is dominated by now: continue
///       label <- (place, safe interval, heading) with g      settle ["High-level overview"]
///       if label is at the last goal in a safe interval without end: stop  Goals::is_end
///       with a horizon: remember it if the robot may rest there for good   Goals::may_rest_at
///       expand label:
///         if it is at the goal of its stage: push its service              Successors::services_from
///         for each edge to the goal in sight or to a neighbour:            Successors::add_edges
///           offer it into the first safe interval that it can reach        ["Handling rotations"]
///     offer: push an entry with the lower bound of g, unless it is impossible, too expensive or dominated
///
/// DominanceTable defines "dominates". A timed entry takes part in dominance as if it were a label. The paper
/// increments waits by a step until a move is free of collisions; here, departures have a closed form.
///
/// run() makes one or two passes of this search. The quick pass also discards arrivals that are not dominated
/// but hardly better than others (SearchSettings::thorough). If it finds no path after it has discarded such
/// an arrival, the complete pass searches again. It discards only dominated arrivals.
class AaSipp {
 public:
  explicit AaSipp(const ReservationTable& table) : table_(table) {}

  /// Plans the robot of this space to its goal, from its start or the end of its committed actions. The robot
  /// must have a goal, and holds no reservation.
  SearchResult run(SearchSpace& space, const SearchSettings& settings, const StopCondition& stop);

  /// Frees what is kept for the next search.
  void release_memory() { state_ = SearchState(); }

 private:
  const ReservationTable& table_;
  SearchState state_;  // of one search; a member only to reuse its memory
};

}  // namespace fleetplan::core
