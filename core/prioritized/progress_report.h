#pragma once

#include <cstddef>

#include "core/prioritized/plan_state.h"
#include "core/runtime/progress.h"

namespace fleetplan::core {

/// Tells an observer, if there is one, how far planning has got.
class ProgressReport {
 public:
  /// Counts the robots that follow a trajectory in `state`. A null `observer`: nobody watches.
  ProgressReport(const PlanState& state, Observer* observer);

  /// Another attempt at planning all robots begins.
  void next_attempt() {
    ++progress_.attempts;
    update();
  }
  /// Other robots may follow a trajectory than before.
  void update() {
    if (observer_ != nullptr) tell();
  }
  /// There is a plan, or a better one.
  void found(const Objectives& best) {
    progress_.best = best;
    update();
  }

  Observer* observer() const { return observer_; }

 private:
  void tell();

  const PlanState& state_;
  Observer* observer_;
  std::size_t parked_ = 0;
  Progress progress_;
};

}  // namespace fleetplan::core
