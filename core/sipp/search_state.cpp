#include "core/sipp/search_state.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

void DominanceTable::reset(const Motion& motion, double slack) {
  motion_ = &motion;
  slack_ = slack;
  first_.clear();
  arrivals_.clear();
}

bool DominanceTable::contains(int interval, double time, double heading) const {
  for (ArrivalId id = first_[interval]; id != ArrivalId::none;) {
    const Arrival& arrival = arrivals_[id];
    if (std::abs(arrival.time - time) <= kSameTime && angle_between(arrival.heading, heading) <= kSameHeading)
      return true;
    id = arrival.next;
  }
  return false;
}

ArrivalId DominanceTable::add(int interval, double time, double heading) {
  ArrivalId* link = &first_[interval];
  while (*link != ArrivalId::none) {
    Arrival& arrival = arrivals_[*link];
    const double ready = motion_->rotation_time(heading, arrival.heading) + motion_->wait_before_move;
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

}  // namespace fleetplan::core
