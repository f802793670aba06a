#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): see the header
constinit thread_local StepClock step_clock;

}  // namespace fleetplan::core
