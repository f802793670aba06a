#include "api/response/write_response.h"

#include <chrono>
#include <string_view>

#include "api/json/error.h"
#include "api/json/json_writer.h"
#include "api/response/reply.h"
#include "api/response/write_actions.h"
#include "api/response/write_dependencies.h"
#include "api/response/write_report.h"

namespace fleetplan::api {

namespace {

constexpr std::size_t kBytesAnAction = 320;

void write_metadata(JsonWriter& json, const std::string& metadata) {
  if (!metadata.empty()) json.key("metadata").json(metadata);
}

/// `metadata`: of the goals by their number, or none.
void write_visits(JsonWriter& json, const std::vector<core::Visit>& visits,
                  const std::vector<std::string>& metadata) {
  json.key("visits").begin_array();
  for (const core::Visit& visit : visits) {
    json.begin_object().member("goal", visit.goal).member("t_arrive", visit.t_arrive);
    json.member("t_leave", visit.t_leave);  // null at the last goal
    if (visit.goal < metadata.size()) write_metadata(json, metadata[visit.goal]);
    json.end_object();
  }
  json.end_array();
}

void write_plan(JsonWriter& json, const core::RobotPlan& plan, const VerifiedPlan& verified) {
  const core::Robot& robot = verified.robots[plan.robot];
  const ReceivedRobot& received = verified.received[plan.robot];
  json.begin_object();
  json.member("robot", robot.id).member("cost", plan.cost).member("lower_bound", plan.lower_bound);
  if (plan.estimated_cost) json.member("ends_at", "horizon").member("estimated_cost", *plan.estimated_cost);
  write_actions(json, plan.actions, robot, received, verified.origin);
  if (received.lists_visits) write_visits(json, plan.visits, received.goal_metadata);
  write_metadata(json, received.metadata);
  json.end_object();
}

void write_unplanned(JsonWriter& json, const core::Unplanned& unplanned, const VerifiedPlan& verified) {
  json.begin_object();
  json.member("robot", verified.robots[unplanned.robot].id);
  json.member("reason", name_of(unplanned.reason)).member("detail", unplanned.detail);
  json.key("blocked_by").begin_array();
  for (const std::size_t robot : unplanned.blocked_by) json.value(verified.robots[robot].id);
  json.end_array().member("blocked_by_total", unplanned.blocked_by.total());
  const core::Robot& robot = verified.robots[unplanned.robot];
  const ReceivedRobot& received = verified.received[unplanned.robot];
  if (!robot.committed.empty()) write_actions(json, robot.committed, robot, received, verified.origin);
  if (!received.errors.empty()) write_errors(json, received.errors);
  write_metadata(json, received.metadata);
  json.end_object();
}

void write_meeting(JsonWriter& json, const core::Meeting& meeting, const VerifiedPlan& verified) {
  const std::string& robot = verified.robots[meeting.robot].id;
  json.begin_object();
  if (meeting.other) {
    json.key("robots").begin_array().value(robot).value(verified.robots[*meeting.other].id).end_array();
  } else {
    json.member("robot", robot);
  }
  if (meeting.obstacle) json.member("obstacle", verified.obstacles[*meeting.obstacle].id);
  json.member("t", meeting.t).end_object();
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
  if (plan.estimated) {
    json.key("estimated").begin_object();
    json.member("flowtime", plan.estimated->flowtime).member("makespan", plan.estimated->makespan);
    json.end_object();
  }
  json.member("verified", verified.report.valid());
  json.member("min_clearance", reported_clearance(verified.report));
  json.member("deterministic", plan.deterministic);
  if (verified.lattice_spacing) json.member("lattice_spacing", *verified.lattice_spacing);
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
  for (const core::Unplanned& one : plan.unplanned) actions += verified.robots[one.robot].committed.size();
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
  if (!plan.unavoidable.empty()) {
    json.key("unavoidable").begin_array();
    for (const core::Meeting& one : plan.unavoidable) write_meeting(json, one, verified);
    json.end_array();
  }
  if (verified.dependencies != nullptr) {
    const auto& made = *verified.dependencies;
    write_dependencies(json, made ? &*made : nullptr, verified.robots);
  }
  write_summary(json, verified);
  write_timings(json, stages);
  json.key("warnings").begin_array();
  for (const std::string& warning : verified.warnings) json.value(std::string_view(warning));
  json.end_array();
  write_metadata(json, verified.metadata);
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api
