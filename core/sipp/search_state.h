#pragma once

#include <cstdint>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/runtime/arrays.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/dominance_table.h"
#include "core/sipp/edge_timing.h"
#include "core/sipp/open_list.h"
#include "core/sipp/stage.h"

namespace fleetplan::core {

enum class PlaceId : int { none = -1 };
enum class LabelId : int { none = -1 };

/// A vertex that the search has reached in a stage, with its safe intervals (paper, "Computing intervals").
struct Place {
  int vertex;
  int stage;
  int number;  // of the vertex among those of all radii
  Position position;
  CostToGo::Estimate estimate;  // to the end of the last service
  bool any_heading;             // the goal of the stage, in which the robot may rest with any heading
  int first_interval;           // of SearchState::intervals
  int end_interval;             // one past the last one
  PlaceId other_stage;          // of the same vertex; none for the one that was reached first
  bool is_window = false;       // the intervals are the arrivals for a service after which the radius changes

  bool never_safe() const { return first_interval == end_interval; }
};

/// A settled state of the search: a place, one of its safe intervals and a heading, with the arrival g.
struct Label {
  double arrival;
  double heading;
  double departure;  // from the parent
  LabelId parent;    // none at the start
  PlaceId place;
  int interval;
  bool by_translation;  // from the parent; otherwise the parent's stage ends here
  bool reverse;         // backwards
};

/// The two ways to reach a place when a label is expanded: a local move from the label or, any-angle, a
/// shortcut from its parent.
struct Edge {
  enum class Sight : std::uint8_t { unknown, free, blocked };

  Move local;
  Move shortcut;
  LabelId via = LabelId::none;  // the label that is expanded
  PlaceId target = PlaceId::none;
  Sight shortcut_sight = Sight::blocked;  // blocked if there is no shortcut

  const Move& move(EdgeKind kind) const { return kind == EdgeKind::shortcut ? shortcut : local; }
};

/// The state of one search.
struct SearchState {
  IndexedVector<Stage> stages;
  IndexedVector<PlaceId> place_of_vertex;  // the latest; none for vertices that were not reached
  IndexedVector<Place, PlaceId> places;
  IndexedVector<SafeInterval> intervals;  // of all places
  IndexedVector<Label, LabelId> labels;
  IndexedVector<Edge, EdgeId> edges;
  OpenList open;
  DominanceTable dominance;
  PlaceId goal = PlaceId::none;             // the last one, in the last stage
  double horizon = kForever;                // see SearchLimits
  double release = 0.0;                     // estimate: no path ends earlier; see Stage
  EntryId best_goal_entry = EntryId::none;  // the cheapest timed entry into the goal's last safe interval
  double best_goal_cost = kForever;
  LabelId rest_label = LabelId::none;  // the best label to rest at beyond the horizon
  double best_rest = kForever;         // its f
  LabelId goal_label = LabelId::none;
  bool incomplete = false;  // the quick pass discarded an arrival that the complete pass may keep

  /// Prepares for another search; keeps the memory.
  void clear() {
    for (const Place& place : places) place_of_vertex[place.number] = PlaceId::none;
    places.clear();
    intervals.clear();
    labels.clear();
    edges.clear();
    open.clear();
    goal = PlaceId::none;
    best_goal_entry = EntryId::none;
    best_goal_cost = kForever;
    rest_label = LabelId::none;
    best_rest = kForever;
    goal_label = LabelId::none;
    incomplete = false;
  }
};

}  // namespace fleetplan::core
