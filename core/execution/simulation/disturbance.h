#pragma once

// What delays robots, and how far they drive beside their paths. Drawn for one execution of a fleet at a
// time. Also: what a robot has to do and its policy may not change, as phases of an action, or as a drive
// with profiles.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/drive.h"
#include "core/execution/executed_actions.h"
#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A uniform distribution; min <= max.
struct UniformRange {
  double min = 0.0;
  double max = 0.0;
};

/// What disturbs the execution of a plan. The default disturbs nothing.
struct Disturbance {
  /// Stops: a Poisson process in the time during which a robot moves, with exponential durations.
  struct Stops {
    double rate_per_hour = 0.0;
    double mean_s = 0.0;
  };
  /// Offsets to the left of a translation, metres. They are normal values about one correlation length apart,
  /// linear between them, and 0 at both ends of the translation.
  struct CrossTrack {
    double sigma = 0.0;
    double correlation_length = 1.0;  // metres, > 0
  };

  UniformRange speed{1.0, 1.0};  // factor on the planned speed of each translation, > 0
  UniformRange turn{1.0, 1.0};   // factor on the planned speed of each rotation, > 0
  Stops stops = {};
  UniformRange start_delay{0.0, 0.0};  // seconds before each action, >= 0
  CrossTrack cross_track = {};

  bool leaves_paths() const { return cross_track.sigma > 0.0; }
};

/// The disturbances of the actions of one robot in one execution.
struct DisturbedActions {
  /// A robot stands still after it has moved for `after` seconds in an action.
  struct Halt {
    double after = 0.0;
    double seconds = 0.0;
  };
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  struct Of {
    double start_delay = 0.0;  // seconds
    double moving = 0.0;       // seconds that a rotation or translation takes without halts
    double factor = 1.0;       // on the planned speed
    Range halts = {};
    Range offsets = {};
  };

  std::vector<Of> actions;
  std::vector<Halt> all_halts;
  std::vector<double> all_offsets;  // metres to the left, evenly spaced between the ends of the translation

  std::span<const Halt> halts(std::size_t action) const {
    const Range range = actions[action].halts;
    return std::span(all_halts).subspan(range.begin, range.end - range.begin);
  }
  std::span<const double> offsets(std::size_t action) const {
    const Range range = actions[action].offsets;
    return std::span(all_offsets).subspan(range.begin, range.end - range.begin);
  }
};

/// Returns the disturbances of every plan in run number `run`, in the order of `plans`. They depend only on
/// the plans, the disturbance, the seed and the number of the run. So every policy is disturbed equally.
/// Returns none if `stop` is met first.
std::optional<std::vector<DisturbedActions>> draw_disturbances(const std::vector<RobotPlan>& plans,
                                                               const Disturbance& disturbance,
                                                               std::uint64_t seed, std::uint64_t run,
                                                               const StopCondition& stop);

/// A part of an action that takes a fixed time. The robot moves at constant speed from the end of the part
/// before to this fraction of the action. It stands if the fraction is the same.
struct ActionPhase {
  double seconds = 0.0;
  double to_fraction = 0.0;
};

/// The phases of a rotation or translation, after its start delay: the robot moves and halts in turn, as if
/// at its mean speed. Returns none if `stop` is met first.
std::optional<std::vector<ActionPhase>> moving_phases(const DisturbedActions& disturbed, std::size_t action,
                                                      const StopCondition& stop);

/// Whether the robot is at speed when an action begins, so that nothing can delay it.
inline bool goes_on_at_speed(Actions actions, std::size_t action) {
  return actions[action].profile && actions[action].profile->start > 0.0;
}

/// A drive with profiles, and the halts on its way. The robot brakes so that it stands for a while at each
/// halt. It halts where the undisturbed robot is after the same share of the action's time.
struct DisturbedDrive {
  struct Halt {
    double place = 0.0;  // of the drive
    double seconds = 0.0;
  };

  DisturbedDrive(Actions actions, std::size_t first, const DisturbedActions& disturbed, double t,
                 double start_speed);

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
};

}  // namespace fleetplan::core
