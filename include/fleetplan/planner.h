#pragma once

#include <fleetplan/options.h>
#include <fleetplan/plan.h>
#include <fleetplan/problem.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

namespace fleetplan {

/// How far planning has come.
struct Progress {
  std::int64_t attempts = 0;            // priority orders begun so far
  std::size_t planned = 0;              // robots that have a plan now, parked ones included; may decrease
  std::optional<Objectives> best = {};  // objectives of the present plan; none before the first
};

/// How the caller stops and observes a call that is running.
struct Control {
  /// When a stop is requested, planning ends within milliseconds. It returns what it has, as at the end of
  /// the time budget. Any thread may request the stop.
  std::stop_token stop = {};
  /// Called in the thread that called plan(), possibly thousands of times a second. Its time counts against
  /// the time budget. It may throw, which ends planning; plan() passes the exception on.
  std::function<void(const Progress&)> progress = {};
};

/// Plans collision-free timed motions for all robots of the problem, or for as many as possible within the
/// time budget. Checks the plan in continuous time. The computation takes place in the calling thread.
///
/// Planning is prioritized, so it is neither complete nor optimal: a solvable problem may return
/// Plan::Status::partial, and costs may exceed the optimum. Each plan comes with a lower bound of its cost.
///
/// Throws InvalidProblem if faults_of() has any. Throws std::logic_error if the checker rejects the plan: a
/// bug of the library, not of the problem.
Plan plan(const Problem& problem, const Options& options = {}, const Control& control = {});

}  // namespace fleetplan
