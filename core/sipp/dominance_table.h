#pragma once

#include <cstddef>
#include <vector>

#include "core/instance.h"

namespace fleetplan::core {

/// One robot's arrivals in safe intervals that others are measured by. Arrival a dominates b of the same
/// interval if a's time plus the rotation from a's heading to b's, and the added wait if there is one, is no
/// later than b's time.
class DominanceTable {
 public:
  /// Forgets all, for a search of a robot that moves so. `slack` > 0: an arrival that is earlier than another
  /// by less (seconds) is no better, whatever its heading; 0: only domination counts.
  void begin(const Motion& motion, double slack);

  /// Intervals are numbered from 0 and this is how many there are; never fewer than before.
  void set_interval_count(std::size_t count) { first_.resize(count, -1); }

  bool none_in(int interval) const { return first_[static_cast<std::size_t>(interval)] < 0; }

  /// DominanceTable with this heading are no better than a known one from then on. Who arrives earlier may
  /// have to make the added wait that a later one, which passes on, does without.
  double needless_from(int interval, double heading) const;

  /// Is the same arrival known?
  bool has(int interval, double time, double heading) const;

  /// Adds an arrival and strikes out those that it dominates; its number.
  int add(int interval, double time, double heading);

  /// Was the arrival of this number struck out?
  bool dominated(int arrival) const { return arrivals_[static_cast<std::size_t>(arrival)].dominated; }

 private:
  struct Arrival {
    double time;
    double heading;
    int next;  // of the same interval, or -1
    bool dominated;
  };

  const Motion* motion_ = nullptr;
  double slack_ = 0.0;
  std::vector<int> first_;  // by interval, or -1
  std::vector<Arrival> arrivals_;
};

}  // namespace fleetplan::core
