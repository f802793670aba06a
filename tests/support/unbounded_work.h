#pragma once

#include "core/runtime/stop_condition.h"

namespace fleetplan {

/// Returns work without bounds. It outlives the documents that tests read with it.
inline core::Work& unbounded_work() {
  thread_local core::Work work = core::Work::unbounded();
  return work;
}

}  // namespace fleetplan
