#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/fleet/progress_report.h"
#include "core/model/trajectory.h"
#include "core/moves/place_steps.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Whether robots follow a plan in steps.
enum class StepsOutcome : std::uint8_t {
  followed,
  /// There is no such plan: everything that steps reach was searched.
  none,
  /// There may be a plan: the search has reached its size limit.
  limited,
  /// There may be a plan: the time was over.
  cut_off,
};

/// Plans of the whole fleet in steps: along the rows and columns of a lattice if that suffices, otherwise
/// over places. It keeps what it has searched for the next call with the same robots.
class FleetSteps {
 public:
  /// With a horizon, the most robots that are planned to their goals all at once.
  static constexpr std::size_t kMaxWholeWays = 64;

  /// All arguments outlive this object.
  FleetSteps(FleetReservations& reservations, Random& random, ProgressReport& progress)
      : reservations_(reservations), random_(random), progress_(progress) {}

  /// Plans the robots of `order` in steps, among the other robots as they move. The `hopeless` robots stay.
  /// If all of them get a plan without conflicts, they follow it. Otherwise, no reservation changes. Takes a
  /// part of the time until `stop`.
  StepsOutcome follow(const std::vector<std::size_t>& order, const std::vector<std::size_t>& hopeless,
                      const StopCondition& stop);

 private:
  StepsOutcome follow_until(const std::vector<std::size_t>& robots, bool others_move,
                            const StopCondition& stop);
  bool follow_all(const std::vector<std::size_t>& robots, std::vector<Trajectory> trajectories,
                  const StopCondition& stop);
  PlaceSteps& on_places(const std::vector<std::size_t>& robots);

  FleetReservations& reservations_;
  Random& random_;
  ProgressReport& progress_;
  std::optional<PlaceSteps> on_places_;  // of the robots that were asked for last
};

}  // namespace fleetplan::core
