#include "core/execution/simulation/course.h"

namespace fleetplan::core {

std::vector<Phase> moving_phases(const DisturbedActions& disturbed, std::size_t action) {
  const double moving = disturbed.actions[action].moving;
  std::vector<Phase> phases;
  double moved = 0.0;
  double fraction = 0.0;
  for (const DisturbedActions::Halt& halt : disturbed.halts(action)) {
    fraction = halt.after / moving;
    phases.push_back({halt.after - moved, fraction});
    phases.push_back({halt.seconds, fraction});
    moved = halt.after;
  }
  phases.push_back({moving - moved, 1.0});
  return phases;
}

}  // namespace fleetplan::core
