#pragma once

#include <cstddef>

#include "core/instance/motion.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

enum class ArrivalId : int { none = -1 };

/// The arrivals of one robot in safe intervals that no other arrival dominates. Arrival a dominates arrival b
/// in the same interval if a's time, plus the rotation from a's heading to b's, plus the added wait before a
/// move, is no later than b's time.
class DominanceTable {
 public:
  /// Removes all arrivals and intervals, for a search with this motion. `slack` > 0: an arrival also
  /// dominates others that precede it by less than `slack` seconds, whatever their heading.
  void reset(const Motion& motion, double slack);

  /// Intervals are numbered from 0. The count never decreases until reset().
  void set_interval_count(std::size_t count) { first_.resize(count, ArrivalId::none); }

  bool empty(int interval) const { return first_[interval] == ArrivalId::none; }

  /// The time from which arrivals with this heading are dominated. The added wait is included: an earlier
  /// arrival may need it, a later one that continues straight does not.
  double dominated_from(int interval, double heading) const;

  /// Returns whether an arrival at the same time with the same heading is in the table.
  bool contains(int interval, double time, double heading) const;

  /// Adds an arrival and removes those that it dominates (without the slack).
  ArrivalId add(int interval, double time, double heading);

  /// Returns whether this arrival was removed because one added after it dominates it.
  bool is_dominated(ArrivalId arrival) const { return arrivals_[arrival].dominated; }

 private:
  struct Arrival {
    double time;
    double heading;
    ArrivalId next;  // in the same interval
    bool dominated;
  };

  const Motion* motion_ = nullptr;
  double slack_ = 0.0;
  IndexedVector<ArrivalId> first_;  // by interval
  IndexedVector<Arrival, ArrivalId> arrivals_;
};

}  // namespace fleetplan::core
