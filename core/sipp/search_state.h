#pragma once

// The nodes of the search for one robot: places, labels and edges, the open list, and dominance.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/model/body.h"
#include "core/runtime/arrays.h"
#include "core/sipp/cost_to_go.h"

namespace fleetplan::core {

enum class PlaceId : int { none = -1 };
enum class LabelId : int { none = -1 };
enum class EdgeId : int {};
enum class EntryId : int { none = -1 };
enum class ArrivalId : int { none = -1 };

/// A vertex that the search has reached in a stage, with its safe intervals (paper, "Computing intervals").
struct Place {
  int vertex;
  int stage;
  int number;  // of the vertex among the vertices of all views: SearchSpace::first_vertex(stage) + vertex
  Position position;
  CostToGo::Estimate
      estimate;            // h, to the end of the last service; of an existing way, so it may be too high
  bool any_heading;        // the goal of the stage, in which the robot may rest with any heading
  int first_interval;      // of SearchState::intervals
  int end_interval;        // one past the last one
  PlaceId other_stage;     // links the places of one vertex in all stages; none for the place that was
                           // reached first
  bool is_window = false;  // the intervals are the arrivals for a service after which the radius changes

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

/// A straight move from a label, into any safe interval of its target. It departs after the rotation and the
/// added wait, within the label's safe interval. It arrives within the target's safe interval. A move in the
/// direction of the translation before may depart at once: both then form one translation, with one added
/// wait.
struct Move {
  double heading = 0.0;              // of the robot
  double duration = 0.0;             // seconds; 0 for a service
  double ready = 0.0;                // earliest departure after the rotation and the added wait
  double latest = 0.0;               // latest departure: see Goals::latest_departure
  bool reverse = false;              // backwards
  bool continues_straight = false;   // without added wait, from `at_source_from` on
  double at_source_from = kForever;  // arrival of the robot at the label

  double latest_into(const SafeInterval& target) const { return std::min(latest, target.end - duration); }
  double ready_for(const SafeInterval& target) const { return std::max(ready, target.begin - duration); }
  bool may_continue_into(const SafeInterval& target) const {
    return continues_straight && at_source_from + duration >= target.begin &&
           at_source_from <= latest_into(target);
  }
  /// A lower bound of the departure if there were no robots on the way. kForever if the move is impossible.
  double earliest_into(const SafeInterval& target) const {
    if (may_continue_into(target)) return at_source_from;
    return ready_for(target) <= latest_into(target) ? ready_for(target) : kForever;
  }
};

/// Where a move along an edge starts: at the label that is expanded, or at its parent (any-angle). A service
/// leads from a stage to the next one, at the same vertex.
enum class MoveKind : std::uint8_t { local, shortcut, service };

/// The two ways to reach a place when a label is expanded: a local move from the label or, any-angle, a
/// shortcut from its parent.
struct Edge {
  enum class Sight : std::uint8_t { unknown, free, blocked };

  Move local;
  Move shortcut;
  LabelId via = LabelId::none;  // the label that is expanded
  PlaceId target = PlaceId::none;
  Sight shortcut_sight = Sight::blocked;  // blocked if there is no shortcut
  int from_interval = 0;                  // the first one of the target into which it may lead

  const Move& move(MoveKind kind) const { return kind == MoveKind::shortcut ? shortcut : local; }
};

/// A move along an edge into one safe interval of its target.
struct OpenEntry {
  double arrival;    // g; a lower bound until the entry is timed
  double departure;  // from the source
  EdgeId edge;
  int interval;
  ArrivalId timed_arrival;  // in the dominance table; none until the entry is timed
  MoveKind kind;
  bool next_interval_follows;  // the move into the target's next interval is offered when this one is popped

  bool timed() const { return timed_arrival != ArrivalId::none; }
};

/// The open list of A*: the smallest f first, then the smallest h, then the oldest entry.
class OpenList {
 public:
  bool empty() const { return heap_.empty(); }
  double min_f() const { return heap_.front().f; }

  EntryId push(const OpenEntry& entry, double f, double h) {
    const EntryId id = entries_.push_back(entry);
    heap_.push_back({f, h, id});
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    return id;
  }

  OpenEntry pop() {
    const EntryId id = heap_.front().entry;
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    return entries_[id];
  }

  /// An entry that was pushed, popped ones included.
  const OpenEntry& operator[](EntryId id) const { return entries_[id]; }

  void clear() {
    heap_.clear();
    entries_.clear();
  }

 private:
  struct Key {
    double f;
    double h;
    EntryId entry;
    bool operator>(const Key& other) const {
      if (f != other.f) return f > other.f;
      if (h != other.h) return h > other.h;
      return entry > other.entry;
    }
  };

  std::vector<Key> heap_;
  IndexedVector<OpenEntry, EntryId> entries_;
};

/// The arrivals of one robot in safe intervals that no other arrival dominates. Let a and b be arrivals in
/// the same interval. Take a's time, add the rotation from a's heading to b's, and the added wait before a
/// move. If the sum is no later than b's time, a dominates b.
class DominanceTable {
 public:
  /// Removes all arrivals and intervals, for a search with these limits of motion. They have the least
  /// angular speed that the robot has anywhere, so that an arrival that dominates does so in every zone.
  /// `slack` > 0: an arrival also dominates others that are earlier by less than `slack` seconds, whatever
  /// their heading.
  void reset(const Body& body, double slack);

  /// Intervals are numbered from 0. The count never decreases until reset().
  void set_interval_count(std::size_t count) { first_.resize(count, ArrivalId::none); }

  bool empty(int interval) const { return first_[interval] == ArrivalId::none; }

  /// The time from which arrivals with this heading are dominated, with the added wait. An earlier arrival
  /// may need the wait. A later arrival that continues straight does not.
  double dominated_from(int interval, double heading) const {
    double from = kForever;
    for (ArrivalId id = first_[interval]; id != ArrivalId::none;) {
      const Arrival& arrival = arrivals_[id];
      const double ready = body_->rotation_time(arrival.heading, heading) + body_->wait_before_move;
      from = std::min(from, arrival.time + (slack_ > 0.0 ? -slack_ : ready));
      id = arrival.next;
    }
    return from;
  }

  /// Returns whether an arrival at the same time with the same heading is in the table.
  bool contains(int interval, double time, double heading) const;

  /// Adds an arrival and removes the arrivals that it dominates (without the slack).
  ArrivalId add(int interval, double time, double heading);

  /// Returns whether this arrival was removed because a later addition dominates it.
  bool is_dominated(ArrivalId arrival) const { return arrivals_[arrival].dominated; }

 private:
  struct Arrival {
    double time;
    double heading;
    ArrivalId next;  // in the same interval
    bool dominated;
  };

  const Body* body_ = nullptr;
  double slack_ = 0.0;
  IndexedVector<ArrivalId> first_;  // by interval
  IndexedVector<Arrival, ArrivalId> arrivals_;
};

inline void DominanceTable::reset(const Body& body, double slack) {
  body_ = &body;
  slack_ = slack;
  first_.clear();
  arrivals_.clear();
}

inline bool DominanceTable::contains(int interval, double time, double heading) const {
  for (ArrivalId id = first_[interval]; id != ArrivalId::none;) {
    const Arrival& arrival = arrivals_[id];
    if (std::abs(arrival.time - time) <= kSameTime && angle_between(arrival.heading, heading) <= kSameHeading)
      return true;
    id = arrival.next;
  }
  return false;
}

inline ArrivalId DominanceTable::add(int interval, double time, double heading) {
  ArrivalId* link = &first_[interval];
  while (*link != ArrivalId::none) {
    Arrival& arrival = arrivals_[*link];
    const double ready = body_->rotation_time(heading, arrival.heading) + body_->wait_before_move;
    if (time + ready <= arrival.time) {
      arrival.dominated = true;
      *link = arrival.next;
    } else {
      link = &arrival.next;
    }
  }
  *link = arrivals_.next_index();
  return arrivals_.push_back({time, heading, ArrivalId::none, false});
}

/// What the search for one robot has reached. Kept from search to search to reuse its memory.
struct SearchState {
  IndexedVector<PlaceId> place_of_vertex;  // the latest; none for vertices that were not reached
  IndexedVector<Place, PlaceId> places;
  IndexedVector<SafeInterval> intervals;  // of all places
  IndexedVector<Label, LabelId> labels;
  IndexedVector<Edge, EdgeId> edges;
  OpenList open;
  DominanceTable dominance;

  const Place& place_at(LabelId label) const { return places[labels[label].place]; }
  LabelId source_of(const Edge& edge, MoveKind kind) const {
    return kind == MoveKind::shortcut ? labels[edge.via].parent : edge.via;
  }

  /// Prepares for a search among so many vertices.
  void clear(std::size_t vertex_count) {
    for (const Place& place : places) place_of_vertex[place.number] = PlaceId::none;
    place_of_vertex.resize(std::max(place_of_vertex.size(), vertex_count), PlaceId::none);
    places.clear();
    intervals.clear();
    labels.clear();
    edges.clear();
    open.clear();
  }
};

}  // namespace fleetplan::core
