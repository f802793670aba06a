#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/runtime/arrays.h"
#include "core/sipp/dominance_table.h"

namespace fleetplan::core {

enum class EdgeId : int {};
enum class EntryId : int { none = -1 };

/// Where an edge starts: at the label that is expanded, or at its parent (any-angle). A service leads from a
/// stage to the next one, at the same vertex.
enum class EdgeKind : std::uint8_t { local, shortcut, service };

/// A move along an edge into one safe interval of its target.
struct OpenEntry {
  double arrival;    // g; a lower bound until the edge is timed
  double departure;  // from the source
  EdgeId edge;
  int interval;
  ArrivalId timed_arrival;  // in the dominance table; none until the edge is timed
  EdgeKind kind;
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

}  // namespace fleetplan::core
