#pragma once

// Drives of robots with profiles, as they are disturbed.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/drive.h"
#include "core/execution/executed_actions.h"
#include "core/execution/simulation/disturbance.h"

namespace fleetplan::core {

/// Whether the robot is at speed when an action begins, so that nothing can delay it.
inline bool goes_on_at_speed(Actions actions, std::size_t action) {
  return actions[action].profile && actions[action].profile->start > 0.0;
}

/// A drive with the halts on its way.
struct DisturbedDrive {
  struct Halt {
    double place = 0.0;  // of the drive
    double seconds = 0.0;
  };

  DisturbedDrive(Actions actions, std::size_t first, const DisturbedActions& disturbed, double t,
                 double start_speed)
      : drive(actions, first, factors(actions, first, disturbed), t, start_speed) {
    // Bounded: the halts that were drawn.
    for (std::size_t k = first; k < drive.end(); ++k) {
      for (const HaltPlace& at : halt_places(actions[k], disturbed, k)) {
        halts.push_back({drive.place_of(k, at.fraction), at.seconds});
      }
    }
  }

  std::optional<Halt> next_halt() const {
    return halt < halts.size() ? std::optional(halts[halt]) : std::nullopt;
  }
  /// Goes on after a halt, at this time.
  void pass_halt(double t) {
    drive.stand_until(t);
    ++halt;
  }

  Drive drive;
  std::vector<Halt> halts = {};  // ascending
  std::size_t halt = 0;          // the next one

 private:
  static std::vector<double> factors(Actions actions, std::size_t first, const DisturbedActions& disturbed) {
    std::vector<double> all;
    const std::size_t end = end_of_drive(actions, first);
    for (std::size_t k = first; k < end; ++k) all.push_back(disturbed.actions[k].factor);
    return all;
  }
};

}  // namespace fleetplan::core
