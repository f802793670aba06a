#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>

#include "api/endpoints/plan_events.h"
#include "api/response/reply.h"
#include "core/model/progress.h"

namespace fleetplan::api {

/// Turns the planner's progress into events, and its better plans into answers: at most one a second, less
/// often where making one takes long, and none shortly before the final one.
class ProgressReporter final : public core::Observer {
 public:
  using Clock = std::chrono::steady_clock;
  using MakeAnswer = std::function<Reply(const core::Plan&)>;

  /// The pause after an answer is at least this, and at least so many times as long as making it took.
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

  /// The 500 for a plan that the checker rejected.
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
