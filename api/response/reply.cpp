#include "api/response/reply.h"

#include "api/json/json_writer.h"

namespace fleetplan::api {

std::string_view name_of(PlanOutcome::Status status) {
  switch (status) {
    case PlanOutcome::Status::solved:
      return "solved";
    case PlanOutcome::Status::partial:
      return "partial";
    case PlanOutcome::Status::none:
      return "none";
    case PlanOutcome::Status::refused:
      break;
  }
  return "refused";
}

std::string_view name_of(core::Unplanned::Reason reason) {
  switch (reason) {
    case core::Unplanned::Reason::start_blocked:
      return "start_blocked";
    case core::Unplanned::Reason::goal_blocked:
      return "goal_blocked";
    case core::Unplanned::Reason::goal_unreachable:
      return "goal_unreachable";
    case core::Unplanned::Reason::blocked_by_robots:
      return "blocked_by_robots";
    case core::Unplanned::Reason::committed_in_the_way:
      return "committed_in_the_way";
    case core::Unplanned::Reason::invalid:
      return "invalid";
    case core::Unplanned::Reason::budget_exhausted:
      break;
  }
  return "budget_exhausted";
}

std::string_view name_of(core::Method method) {
  switch (method) {
    case core::Method::priorities:
      return "priorities";
    case core::Method::steps:
      return "steps";
    case core::Method::room:
      return "room";
    case core::Method::smoothing:
      return "smoothing";
    case core::Method::improvement:
      break;
  }
  return "improvement";
}

PlanOutcome::Status status_of(const core::Plan& plan) {
  if (plan.unplanned.empty()) return PlanOutcome::Status::solved;
  return plan.plans.empty() ? PlanOutcome::Status::none : PlanOutcome::Status::partial;
}

PlanOutcome outcome_of(const core::Plan& plan, std::optional<double> plan_seconds) {
  PlanOutcome outcome{status_of(plan),        plan.plans.size(),        plan.unplanned.size(),
                      plan.search.expansions, plan.objectives.flowtime, plan_seconds};
  for (const core::Unplanned& one : plan.unplanned) {
    ++outcome.unplanned_by_reason[static_cast<std::size_t>(one.reason)];
  }
  return outcome;
}

void write_errors(JsonWriter& json, const std::vector<Fault>& faults) {
  json.key("errors").begin_array();
  for (const Fault& fault : faults) {
    json.begin_object();
    json.member("pointer", fault.pointer).member("code", fault.code).member("detail", fault.detail);
    json.end_object();
  }
  json.end_array();
}

Reply problem_reply(const RequestError& error, const std::string& request_id) {
  const ErrorRow& row = row_of(error.code);
  JsonWriter json;
  json.begin_object();
  // The type is a name, not an address: there is no page behind it.
  json.member("type", "urn:fleetplan:problem:" + std::string(row.name));
  json.member("title", row.title).member("status", row.status).member("detail", error.detail);
  json.member("code", row.name).member("request_id", request_id);
  write_errors(json, error.faults);
  json.member("errors_total", error.faults_total).end_object();
  return {row.status, kProblemJson, json.take(), row.name};
}

Reply too_busy(const std::string& request_id) {
  return problem_reply(ErrorCode::overloaded,
                       "All workers are busy, and the request's time budget would be spent in the queue: try "
                       "again later, or with a larger options.time_budget_ms.",
                       request_id);
}

}  // namespace fleetplan::api
