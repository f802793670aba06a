#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>

#include "api/endpoints/plan_events.h"
#include "api/response/reply.h"
#include "core/runtime/progress.h"

namespace fleetplan::api {

/// Makes events of what the planner tells, and answers of its better plans: at most one a second, less often
/// where making one takes long, and none shortly before the final one.
class PlanWatch final : public core::Observer {
 public:
  using Clock = std::chrono::steady_clock;
  using MakeAnswer = std::function<Reply(const core::Plan&)>;

  /// From one answer to the next at least this; and so many times what it took to make the last one.
  static constexpr std::chrono::seconds kPeriod{1};
  static constexpr int kLeastPause = 10;
  /// No answer is made in the last bit of the time for planning.
  static constexpr std::chrono::milliseconds kLastBit{250};

  /// Planning ends at `deadline`. `make_answer` checks a plan and writes the answer, or refuses it.
  PlanWatch(PlanEvents& events, std::size_t robots, Clock::time_point deadline, MakeAnswer make_answer);

  void progressed(const core::Progress& progress) override;
  bool wants_plan() override;
  void show(const core::Plan& plan) override;

  /// The refusal of a plan that did not pass the check, which is a bug.
  const std::optional<Reply>& refusal() const { return refusal_; }

 private:
  PlanEvents& events_;
  const std::size_t robots_;
  const Clock::time_point deadline_;
  const MakeAnswer make_answer_;
  Clock::time_point next_ = Clock::time_point::min();
  std::optional<Reply> refusal_;
};

}  // namespace fleetplan::api
