#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/model/plan.h"

namespace fleetplan::api {

/// The outcome of a valid request to plan, for metrics and the log.
struct PlanOutcome {
  /// solved: every robot has a plan; partial: some have; none: no robot has. refused: by the checker, a bug.
  enum class Status { solved, partial, none, refused };
  Status status = Status::none;
  std::size_t planned = 0;      // robots
  std::size_t unplanned = 0;    // robots
  std::int64_t expansions = 0;  // search labels
  double flowtime = 0.0;        // seconds, of the planned robots
  /// Time for planning, without parsing, checking and writing; none when the budget was spent before.
  std::optional<double> plan_seconds = std::nullopt;
  std::array<std::size_t, core::kUnplannedReasons> unplanned_by_reason = {};  // by Unplanned::Reason
};

/// As in answers, metrics and the log, e.g. "solved".
std::string_view name_of(PlanOutcome::Status status);

/// As in answers and metrics, e.g. "goal_blocked".
std::string_view name_of(core::Unplanned::Reason reason);

/// The status of a plan that the checker accepts.
PlanOutcome::Status status_of(const core::Plan& plan);

PlanOutcome outcome_of(const core::Plan& plan, std::optional<double> plan_seconds);

}  // namespace fleetplan::api
