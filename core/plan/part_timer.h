#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The parts of planning, as core/runtime/budget.h has them.
enum class PlanPart : std::uint8_t {
  choose,      // poses of goals that have several
  first_plan,  // previous plans, the first plan and the safe one, and their smoothing
  bounds,      // lower bounds
  improve,     // improvement, and the end of planning
};

/// How long each part of planning has taken. A part may come several times.
class PartTimer {
 public:
  using Time = StopCondition::Clock::time_point;
  using Duration = StopCondition::Clock::duration;

  /// Begins with the first plan, unless another part begins at once.
  explicit PartTimer(Time begin) : since_(begin) {}

  /// Ends the part before.
  void begin(PlanPart part, Time now = StopCondition::Clock::now()) {
    taken_[index(current_)] += now - since_;
    since_ = now;
    current_ = part;
  }
  /// The time of a part until its last end.
  Duration taken(PlanPart part) const { return taken_[index(part)]; }

 private:
  static std::size_t index(PlanPart part) { return static_cast<std::size_t>(part); }

  Time since_;
  PlanPart current_ = PlanPart::first_plan;
  std::array<Duration, 4> taken_{};
};

}  // namespace fleetplan::core
