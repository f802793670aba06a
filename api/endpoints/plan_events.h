#pragma once

// The events of a request while its plan is made or simulated.

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "api/response/reply.h"
#include "core/execution/simulation/simulation.h"
#include "core/model/progress.h"

namespace fleetplan::api {

/// The progress of planning a request, or of a simulation.
struct PlanProgress {
  std::size_t robots = 0;  // robots of the request
  core::Progress planner = {};
  std::optional<core::SimulationProgress> simulation = {};  // instead of the planner's progress
};

/// Receives the events while a plan is made or simulated (`text/event-stream`). Called by the planning
/// thread, which waits meanwhile: an implementation must not wait for a client.
class PlanEvents {
 public:
  PlanEvents() = default;
  PlanEvents(const PlanEvents&) = delete;
  PlanEvents& operator=(const PlanEvents&) = delete;
  virtual ~PlanEvents() = default;

  /// Called when the request is valid: from now on, every outcome is an event. Called at most once, before
  /// the others.
  virtual void begin(const PlanProgress& progress) = 0;

  /// Called often, with the newest state, which replaces the earlier ones.
  virtual void progress(const PlanProgress& progress) = 0;

  /// Called when a better plan was found, with a whole answer as JSON. Its plan has passed the check.
  virtual void incumbent(std::string answer) = 0;
};

/// Returns the data of `event: progress`. `elapsed_ms`: since the last byte of the request.
std::string write_progress(const PlanProgress& progress, double elapsed_ms);

/// Turns the planner's progress into events, and its better plans into answers: at most one a second, less
/// often where making one takes long, and none shortly before the final one.
class ProgressReporter final : public core::Observer {
 public:
  using Clock = std::chrono::steady_clock;
  using MakeAnswer = std::function<Reply(const core::Plan&)>;

  /// The least pause after an answer, and the least factor of the pause to the time that making the answer
  /// took.
  static constexpr std::chrono::seconds kLeastPause{1};
  static constexpr int kLeastPauseFactor = 10;
  /// No answer is made in this last part of the time for planning.
  static constexpr std::chrono::milliseconds kQuietEnd{250};

  /// Planning ends at `deadline`. `make_answer` checks a plan and writes the answer, or rejects it.
  ProgressReporter(PlanEvents& events, std::size_t robots, Clock::time_point deadline,
                   MakeAnswer make_answer);

  void progressed(const core::Progress& progress) override;
  bool wants_plan() override;
  void show(const core::Plan& plan) override;

  /// The 500 for a plan that the checker rejected; none if it rejected none.
  const std::optional<Reply>& rejection() const { return rejection_; }

 private:
  PlanEvents& events_;
  const std::size_t robots_;
  const Clock::time_point deadline_;
  const MakeAnswer make_answer_;
  Clock::time_point next_ = Clock::time_point::min();
  std::optional<Reply> rejection_;
};

}  // namespace fleetplan::api
