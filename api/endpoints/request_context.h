#pragma once

// What an endpoint gets of its request beside the body: its limits, its turn to compute, and the receiver of
// its progress.

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "api/request/limits.h"
#include "api/response/reply.h"
#include "core/execution/simulation/simulation.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/model/progress.h"
#include "core/plan/make_plan.h"
#include "core/plan/margins.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The progress of planning a request, of a simulation, or of finding margins.
struct PlanProgress {
  std::size_t robots = 0;  // robots of the request
  core::Progress planner = {};
  // Instead of the planner's progress:
  std::optional<core::SimulationProgress> simulation = {};
  std::optional<core::MarginProgress> margins = {};
};

/// Receives the events while a plan is made or simulated (`text/event-stream`). The planning thread calls it
/// and waits meanwhile, so an implementation must not wait for a client.
class PlanEvents {
 public:
  PlanEvents() = default;
  PlanEvents(const PlanEvents&) = delete;
  PlanEvents& operator=(const PlanEvents&) = delete;
  virtual ~PlanEvents() = default;

  /// Called when the request is valid. From now on, every outcome is an event. Called at most once, before
  /// the others.
  virtual void begin(const PlanProgress& progress) = 0;

  /// Called often, with the newest state, which replaces earlier states.
  virtual void progress(const PlanProgress& progress) = 0;

  /// Whether incumbents are received at all. If not, no answers are written for them.
  virtual bool wants_incumbents() const { return true; }

  /// Called when a better plan was found, with a whole answer as JSON. Its plan has passed the check.
  virtual void incumbent(std::string answer) = 0;
};

/// Returns the data of `event: progress`. `elapsed_ms`: since the last byte of the request.
std::string write_progress(const PlanProgress& progress, double elapsed_ms);

/// Turns the planner's progress into events, and its better plans into answers. There is at most one answer a
/// second, fewer if making an answer takes long, and none shortly before the final one.
class ProgressReporter final : public core::PlanObserver {
 public:
  using Clock = std::chrono::steady_clock;
  using MakeAnswer = std::function<Reply(const core::CheckedPlan&)>;

  /// The least pause after an answer, and the least ratio of the pause to the time that making the answer
  /// took.
  static constexpr std::chrono::seconds kLeastPause{1};
  static constexpr int kLeastPauseFactor = 10;
  /// No answer is made in this last part of the time for planning.
  static constexpr std::chrono::milliseconds kQuietEnd = core::budget::kQuietEnd;

  /// Planning ends at `deadline`. `make_answer` writes the answer with a plan, or rejects the plan.
  ProgressReporter(PlanEvents& events, std::size_t robots, Clock::time_point deadline,
                   MakeAnswer make_answer);

  void progressed(const core::Progress& progress) override;
  bool wants_plan() override;
  void show(const core::CheckedPlan& plan) override;

  /// The 500 for a plan that the checker rejected; none if it rejected no plan.
  const std::optional<Reply>& rejection() const { return rejection_; }

 private:
  PlanEvents& events_;
  const std::size_t robots_;
  const Clock::time_point deadline_;
  const MakeAnswer make_answer_;
  Clock::time_point next_ = Clock::time_point::min();
  std::optional<Reply> rejection_;
};

/// What a request needs of the server, known once it is parsed.
struct TurnNeed {
  enum class Kind { plan, check, simulation, conversion, travel };

  Kind kind = Kind::plan;
  core::StopCondition stop;  // ends the computation
  core::StopCondition::Clock::time_point answer_by = core::StopCondition::Clock::time_point::max();
  double work = 1.0;      // proportional to the expected time, for the kind
  bool is_short = false;  // takes milliseconds at most, as far as can be told
};

/// A request's turn to compute, among the requests of others.
class Turn {
 public:
  Turn() = default;
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  virtual ~Turn() = default;

  /// Asks for the turn, once, when the request is known to be valid. Returns at once. Returns false if the
  /// server is too busy for it.
  virtual bool request(const TurnNeed& need) = 0;

  /// Waits for the turn that was granted. Returns false if the need's `stop` was met before, or if so little
  /// time is left that the server gives up.
  virtual bool await() = 0;

  /// Lets other requests have the turn, and waits for the next one. Long computations must call it now and
  /// then once they have their turn. Returns false if the need's `stop` was met before.
  virtual bool let_others() = 0;
};

/// Receives the plan of an answer, which has passed the check, before the answer is written.
using AnsweredPlan = std::function<void(const core::Problem&, const core::Plan&)>;

/// The context of a request: its limits, and who takes part in its work.
struct RequestContext {
  using Clock = std::chrono::steady_clock;

  std::string request_id;
  Clock::time_point received_at = Clock::now();  // last byte of the body in
  std::stop_token stop;                          // requested when the client is gone or the server drains
  Limits limits;
  core::Executor* executor = nullptr;  // runs further threads; null: the caller's alone
  PlanEvents* events = nullptr;        // receives the progress of a plan; may be null
  AnsweredPlan answered;               // gets the plan that is returned; may be empty
  Turn* turn = nullptr;                // turn to compute; null: it may compute at once
  core::MapCache* maps = nullptr;      // the maps of earlier requests; null: none
  core::Work::CpuClock cpu_clock = core::thread_cpu_time;
  core::EarlyEnd* early_end = nullptr;  // may end the work before its budget; null: none
};

}  // namespace fleetplan::api
