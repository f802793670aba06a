#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/execution/simulation/simulation.h"
#include "core/model/progress.h"

namespace fleetplan::api {

/// The progress of a request's plan, or of a simulation.
struct PlanProgress {
  std::size_t robots = 0;  // of the request
  core::Progress planner = {};
  std::optional<core::SimulationProgress> simulation = {};  // instead of the planner's
};

/// Receives the events while a plan is made or simulated (`text/event-stream`). Called by the planning
/// thread, which waits meanwhile: an implementation must not wait for a client.
class PlanEvents {
 public:
  PlanEvents() = default;
  PlanEvents(const PlanEvents&) = delete;
  PlanEvents& operator=(const PlanEvents&) = delete;
  virtual ~PlanEvents() = default;

  /// The request is valid: from now on, every outcome is an event. Called at most once, before the others.
  virtual void begin(const PlanProgress& progress) = 0;

  /// The newest state, called often; it replaces the earlier ones.
  virtual void progress(const PlanProgress& progress) = 0;

  /// A better plan was found: a whole answer, as JSON, whose plan has passed the check.
  virtual void incumbent(std::string answer) = 0;
};

/// The data of `event: progress`. `elapsed_ms`: since the last byte of the request.
std::string write_progress(const PlanProgress& progress, double elapsed_ms);

}  // namespace fleetplan::api
