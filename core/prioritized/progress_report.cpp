#include "core/prioritized/progress_report.h"

namespace fleetplan::core {

ProgressReport::ProgressReport(const PlanState& state, Observer* observer)
    : state_(state), observer_(observer) {
  for (std::size_t robot = 0; robot < state.instance().size(); ++robot) {
    if (!state.instance().robot(robot).goal) ++parked_;
  }
}

void ProgressReport::notify() {
  progress_.planned = parked_ + state_.planned_count();
  observer_->progressed(progress_);
}

}  // namespace fleetplan::core
