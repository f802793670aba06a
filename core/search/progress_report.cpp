#include "core/search/progress_report.h"

namespace fleetplan::core {

ProgressReport::ProgressReport(const FleetState& state, Observer* observer)
    : state_(state), observer_(observer) {
  for (std::size_t robot = 0; robot < state.fleet().size(); ++robot) {
    if (!state.fleet().robot(robot).goal) ++parked_;
  }
}

void ProgressReport::tell() {
  progress_.planned = parked_ + state_.following();
  observer_->progressed(progress_);
}

}  // namespace fleetplan::core
