#include "core/execution/simulation/course.h"

namespace fleetplan::core {

std::optional<std::vector<Phase>> moving_phases(const DisturbedActions& disturbed, std::size_t action,
                                                const StopCondition& stop) {
  constexpr std::size_t kPhasesBetweenPolls = 1024;
  const double moving = disturbed.actions[action].moving;
  std::vector<Phase> phases;
  double moved = 0.0;
  double fraction = 0.0;
  for (const DisturbedActions::Halt& halt : disturbed.halts(action)) {
    if ((phases.size() + 2) % kPhasesBetweenPolls == 0 && stop.met()) return std::nullopt;
    fraction = halt.after / moving;
    phases.push_back({halt.after - moved, fraction});
    phases.push_back({halt.seconds, fraction});
    moved = halt.after;
  }
  phases.push_back({moving - moved, 1.0});
  return phases;
}

}  // namespace fleetplan::core
