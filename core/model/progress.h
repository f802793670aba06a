#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/model/plan.h"

namespace fleetplan::core {

/// The progress of planning.
struct Progress {
  std::int64_t attempts = 0;       // begun so far, as in SearchStatistics
  std::size_t planned = 0;         // robots that have a plan now, parked ones included; may decrease
  std::optional<Objectives> best;  // objectives of the present plan; nullopt before the first
};

/// Receives the progress of a planner. The thread that called the planner calls it and waits for it. It
/// cannot change the plan, but its time counts against the planner's budget.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;

  /// The progress has changed. Can be called thousands of times a second.
  virtual void progressed(const Progress& progress) = 0;

  /// Whether to call show() with the current plan. Called repeatedly while `anytime` has a plan that is
  /// better than the last one shown.
  virtual bool wants_plan() = 0;

  /// Receives the plan that would be returned now. `deterministic` is false, because the observer chose the
  /// moment.
  virtual void show(const Plan& plan) = 0;
};

}  // namespace fleetplan::core
