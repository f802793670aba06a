#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/model/plan.h"
#include "core/model/progress.h"

namespace fleetplan::core {

/// Reports the progress of planning to an observer, if there is one. Counts which methods planned which
/// robots.
class ProgressReport {
 public:
  /// Reports the robots that follow a trajectory as planned. `observer` may be null.
  ProgressReport(const FleetReservations& reservations, Observer* observer)
      : reservations_(reservations), observer_(observer) {
    for (std::size_t robot = 0; robot < reservations.instance().size(); ++robot) {
      if (reservations.instance().itinerary(robot).is_parked()) ++parked_;
    }
  }

  /// Reports that another attempt at planning all robots begins.
  void next_attempt() {
    ++progress_.attempts;
    update();
  }
  /// Reports the number of robots with a trajectory if it has changed.
  void update() {
    if (observer_ != nullptr) notify();
  }
  /// Reports that there is a plan, or a better one.
  void plan_found(const Objectives& best) {
    progress_.best = best;
    update();
  }

  /// Counts robots that a method was to plan.
  void count(Method method, const MethodCounts& robots) {
    MethodCounts& all = counts_[static_cast<std::size_t>(method)];
    all.tried += robots.tried;
    all.served += robots.served;
    all.could_not_serve += robots.could_not_serve;
  }
  /// Counts robots that were to be planned one after the other. Robots that follow a trajectory are served.
  void count_by_priorities(const std::vector<std::size_t>& robots) {
    const auto planned = std::count_if(robots.begin(), robots.end(), [&](std::size_t robot) {
      return reservations_.trajectory(robot).has_value();
    });
    count(Method::priorities, {std::ssize(robots), planned, 0});
  }
  const std::array<MethodCounts, kMethods>& counts() const { return counts_; }

  Observer* observer() const { return observer_; }

 private:
  void notify() {
    progress_.planned = parked_ + reservations_.planned_count();
    observer_->progressed(progress_);
  }

  const FleetReservations& reservations_;
  Observer* observer_;
  std::size_t parked_ = 0;
  Progress progress_;
  std::array<MethodCounts, kMethods> counts_{};
};

}  // namespace fleetplan::core
