#include "core/sipp/dominance_table.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.h"
#include "core/geometry/interval.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

void DominanceTable::begin(const Motion& motion, double slack) {
  motion_ = &motion;
  slack_ = slack;
  first_.clear();
  arrivals_.clear();
}

double DominanceTable::needless_from(int interval, double heading) const {
  double from = kForever;
  for (int a = first_[static_cast<std::size_t>(interval)]; a >= 0;) {
    const Arrival& arrival = arrivals_[static_cast<std::size_t>(a)];
    const double ready = motion_->rotation_time(arrival.heading, heading) + motion_->wait_before_move;
    from = std::min(from, arrival.time + (slack_ > 0.0 ? -slack_ : ready));
    a = arrival.next;
  }
  return from;
}

bool DominanceTable::has(int interval, double time, double heading) const {
  for (int a = first_[static_cast<std::size_t>(interval)]; a >= 0;) {
    const Arrival& arrival = arrivals_[static_cast<std::size_t>(a)];
    if (std::abs(arrival.time - time) <= kSameTime && angle_between(arrival.heading, heading) <= kSameHeading)
      return true;
    a = arrival.next;
  }
  return false;
}

int DominanceTable::add(int interval, double time, double heading) {
  int* link = &first_[static_cast<std::size_t>(interval)];
  while (*link >= 0) {
    Arrival& arrival = arrivals_[static_cast<std::size_t>(*link)];
    const double ready = motion_->rotation_time(heading, arrival.heading) + motion_->wait_before_move;
    if (time + ready <= arrival.time) {
      arrival.dominated = true;
      *link = arrival.next;
    } else {
      link = &arrival.next;
    }
  }
  const int number = static_cast<int>(arrivals_.size());
  *link = number;
  arrivals_.push_back({time, heading, -1, false});
  return number;
}

}  // namespace fleetplan::core
