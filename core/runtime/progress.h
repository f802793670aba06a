#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/model/plan.h"

namespace fleetplan::core {

/// How far planning has got.
struct Progress {
  std::int64_t attempts = 0;       // begun so far, as in SearchStatistics
  std::size_t planned = 0;         // robots with a plan at the moment, parked ones included; may fall again
  std::optional<Objectives> best;  // of the plan that would be returned now; none before there is one
};

/// Watches a planner at work. Called by the thread that called the planner, which waits meanwhile; nothing
/// that it does or answers changes the plan, but the time that it takes is the planner's.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;

  /// Something has changed; often, perhaps thousands of times a second.
  virtual void progressed(const Progress& progress) = 0;

  /// Does it want to see the whole plan now? Asked again and again while `anytime` has a plan that is better
  /// than the one shown last.
  virtual bool wants_plan() = 0;

  /// The plan that would be returned now; `deterministic` is false, as the observer chose the moment.
  virtual void show(const Plan& plan) = 0;
};

}  // namespace fleetplan::core
