#pragma once

// Answers without a socket, and what metrics and the log need to know about them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/errors.h"
#include "core/model/plan.h"

namespace fleetplan::api {

/// The outcome of a valid request to plan, for metrics and the log.
struct PlanOutcome {
  /// solved: every robot has a plan. partial: some robots have a plan. none: no robot has a plan. refused:
  /// the checker rejected the plan, which is a bug.
  enum class Status { solved, partial, none, refused };
  Status status = Status::none;
  std::size_t planned = 0;      // robots
  std::size_t unplanned = 0;    // robots
  std::int64_t expansions = 0;  // search labels
  double flowtime = 0.0;        // seconds, of the planned robots
  /// Time for planning, without parsing, checking and writing. None if the budget was spent before.
  std::optional<double> plan_seconds = std::nullopt;
  std::array<std::size_t, core::kUnplannedReasons> unplanned_by_reason = {};  // by Unplanned::Reason
};

/// Returns the status as it is in answers, metrics and the log, e.g. "solved".
std::string_view name_of(PlanOutcome::Status status);

/// Returns the reason as it is in answers and metrics, e.g. "goal_blocked".
std::string_view name_of(core::Unplanned::Reason reason);

/// Returns the method as it is in answers, e.g. "steps".
std::string_view name_of(core::Method method);

/// Returns the status of a plan that the checker accepts.
PlanOutcome::Status status_of(const core::Plan& plan);

PlanOutcome outcome_of(const core::Plan& plan, std::optional<double> plan_seconds);

inline constexpr const char* kJson = "application/json";
inline constexpr const char* kProblemJson = "application/problem+json";

/// An answer to a client, without any socket.
struct Reply {
  int status = 200;
  std::string content_type = kJson;
  std::string body;

  // The members below are for metrics and the log, not for the client.
  std::string_view problem = {};  // the error's code, e.g. "not_found"; empty: none
  std::optional<PlanOutcome> outcome = std::nullopt;

  /// The objects that were needed to make the answer. They are freed once it is sent. Null: nothing.
  std::shared_ptr<const void> leftovers = nullptr;
};

class JsonWriter;

/// Writes the member `errors`: faults of a request's content.
void write_errors(JsonWriter& json, const std::vector<Fault>& faults);

/// Returns the error as application/problem+json, the problem details of RFC 9457.
Reply problem_reply(const RequestError& error, const std::string& request_id);
inline Reply problem_reply(ErrorCode code, const std::string& detail, const std::string& request_id) {
  return problem_reply({code, detail, {}, 0}, request_id);
}

/// Returns the answer to a request that gets no turn to compute.
Reply too_busy(const std::string& request_id);

}  // namespace fleetplan::api
