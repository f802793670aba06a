#include "api/response/write_response.h"

#include <chrono>
#include <string_view>

#include "api/json/json_writer.h"
#include "api/response/plan_outcome.h"
#include "api/response/write_report.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

constexpr std::size_t kBytesAnAction = 320;

std::string_view name_of(core::Action::Type type) {
  switch (type) {
    case core::Action::Type::rotate:
      return "rotate";
    case core::Action::Type::translate:
      return "translate";
    case core::Action::Type::wait:
      break;
  }
  return "wait";
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

void write_pose(JsonWriter& json, std::string_view key, const core::Pose& pose,
                const core::Position& origin) {
  const core::Position position = pose.position + origin;
  json.key(key).begin_object();
  json.member("x", position.x()).member("y", position.y());
  json.member("theta", core::normalize_angle(pose.theta));
  json.end_object();
}

void write_plan(JsonWriter& json, const core::RobotPlan& plan, const VerifiedPlan& verified) {
  json.begin_object();
  json.member("robot", verified.robots[plan.robot].id).member("cost", plan.cost);
  json.member("lower_bound", plan.lower_bound);
  json.key("actions").begin_array();
  for (const core::Action& action : plan.actions) {
    json.begin_object();
    json.member("type", name_of(action.type));
    json.member("t_start", action.t_start).member("t_end", action.t_end);
    write_pose(json, "from", action.from, verified.origin);
    write_pose(json, "to", action.to, verified.origin);
    json.end_object();
  }
  json.end_array().end_object();
}

void write_unplanned(JsonWriter& json, const core::Unplanned& unplanned, const VerifiedPlan& verified) {
  json.begin_object();
  json.member("robot", verified.robots[unplanned.robot].id);
  json.member("reason", name_of(unplanned.reason)).member("detail", unplanned.detail);
  json.key("blocked_by").begin_array();
  for (const std::size_t robot : unplanned.blocked_by) json.value(verified.robots[robot].id);
  json.end_array().member("blocked_by_total", unplanned.blocked_by.total()).end_object();
}

void write_timings(JsonWriter& json, const Stages& stages) {
  const auto milliseconds = [](Stages::Time from, Stages::Time to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  };
  const Stages::Time now = Stages::Clock::now();
  json.key("timings_ms").begin_object();
  json.member("queue", milliseconds(stages.parsed, stages.started));
  json.member("parse", milliseconds(stages.received, stages.parsed));
  json.member("plan", milliseconds(stages.started, stages.planned));
  json.member("verify", milliseconds(stages.planned, stages.verified));
  json.member("serialize", milliseconds(stages.verified, now));
  json.member("total", milliseconds(stages.received, now));
  json.end_object();
}

/// The members about the plan as a whole.
void write_summary(JsonWriter& json, const VerifiedPlan& verified) {
  const core::Plan& plan = verified.plan;
  json.member("flowtime", plan.objectives.flowtime).member("makespan", plan.objectives.makespan);
  json.key("lower_bound").begin_object();
  json.member("flowtime", plan.lower_bound.flowtime).member("makespan", plan.lower_bound.makespan);
  json.end_object();
  json.member("verified", verified.report.valid());
  json.member("min_clearance", reported_clearance(verified.report));
  json.member("deterministic", plan.deterministic);
  json.key("search").begin_object();
  json.member("attempts", plan.search.attempts).member("expansions", plan.search.expansions);
  json.member("improvements", plan.search.improvements);
  if (plan.search.exhausted) json.member("exhausted", true);
  json.end_object();
}

}  // namespace

std::string write_response(const VerifiedPlan& verified, const std::string& request_id,
                           const Stages& stages) {
  const core::Plan& plan = verified.plan;
  std::size_t actions = 0;
  for (const core::RobotPlan& one : plan.plans) actions += one.actions.size();
  JsonWriter json;
  json.reserve((actions + verified.robots.size() + 4) * kBytesAnAction);
  json.begin_object();
  json.member("status", name_of(status_of(plan))).member("request_id", request_id);
  json.key("plans").begin_array();
  for (const core::RobotPlan& one : plan.plans) write_plan(json, one, verified);
  json.end_array();
  json.key("unplanned").begin_array();
  for (const core::Unplanned& one : plan.unplanned) write_unplanned(json, one, verified);
  json.end_array();
  write_summary(json, verified);
  write_timings(json, stages);
  json.key("warnings").begin_array();
  for (const std::string& warning : verified.warnings) json.value(std::string_view(warning));
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
