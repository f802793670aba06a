#include "api/response/write_response.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/response/reply.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/objective_share.h"

namespace fleetplan::api {

namespace {

std::string_view type_name(core::Action::Type type) {
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

bool same(const core::Pose& a, const core::Pose& b) { return a.position == b.position && a.theta == b.theta; }

bool same(const core::Action& a, const core::Action& b) {
  return a.type == b.type && a.t_start == b.t_start && a.t_end == b.t_end && same(a.from, b.from) &&
         same(a.to, b.to) && a.reverse == b.reverse;
}

class ActionWriter {
 public:
  ActionWriter(JsonWriter& json, const core::Robot& robot, const ReceivedRobot& received,
               const core::Position& origin, const NamedReasons& reasons)
      : json_(json), robot_(robot), received_(received), origin_(origin), reasons_(reasons) {}

  /// Writes the next action, whose number is `index`.
  void write(const core::Action& action, std::size_t index) {
    index_ = index;
    if (const core::Action* world = as_received(action, index)) {
      write_members(action, world->t_start, world->t_end, world->from, world->to);
      end_ = End{action.to.position, world->to.position};
    } else {
      write_members(action, action.t_start, action.t_end, to_world(action.from), to_world(action.to));
    }
  }

 private:
  /// A position that was received, in the map frame and in the world.
  struct End {
    core::Position map;
    core::Position world;
  };

  /// Returns the action of the request that this one repeats, if it differs in the world; otherwise null.
  const core::Action* as_received(const core::Action& action, std::size_t index) const {
    if (index < robot_.committed.size() && same(action, robot_.committed[index])) {
      return received_.committed.find(index);
    }
    if (robot_.previous && index < robot_.previous->size() && same(action, (*robot_.previous)[index])) {
      return received_.previous.find(index);
    }
    return nullptr;
  }

  core::Pose to_world(const core::Pose& pose) const {
    const bool at_end = end_ && end_->map == pose.position;
    return {at_end ? end_->world : core::Position(pose.position + origin_),
            core::normalize_angle(pose.theta)};
  }

  void write_members(const core::Action& action, double t_start, double t_end, const core::Pose& from,
                     const core::Pose& to) {
    json_.begin_object();
    json_.member("type", type_name(action.type));
    json_.member("t_start", t_start).member("t_end", t_end);
    if (action.goal) json_.member("goal", *action.goal);
    if (action.reverse) json_.member("reverse", true);
    write_reason();
    if (action.profile) write_profile(json_, *action.profile);
    write_pose("from", from);
    write_pose("to", to);
    json_.end_object();
  }

  /// Writes the member `for` of a wait that ends when others have passed.
  void write_reason() {
    if (reasons_.list == nullptr) return;
    const std::vector<core::WaitReason>& list = *reasons_.list;
    // Bounded: each reason once, as actions ascend.
    while (next_reason_ < list.size() && list[next_reason_].action < index_) ++next_reason_;
    if (next_reason_ == list.size() || list[next_reason_].action != index_) return;
    json_.key("for").begin_array();
    for (const std::size_t other : list[next_reason_].robots) json_.value((*reasons_.robots)[other].id);
    json_.end_array();
  }

  void write_pose(std::string_view key, const core::Pose& pose) {
    json_.key(key).begin_object();
    json_.member("x", pose.position.x()).member("y", pose.position.y()).member("theta", pose.theta);
    json_.end_object();
  }

  JsonWriter& json_;
  const core::Robot& robot_;
  const ReceivedRobot& received_;
  const core::Position& origin_;
  const NamedReasons& reasons_;
  std::size_t index_ = 0;
  std::size_t next_reason_ = 0;
  std::optional<End> end_;  // the end of the last action with the numbers received
};

}  // namespace

void write_profile(JsonWriter& json, const core::SpeedProfile& profile) {
  json.key("profile").begin_object();
  json.member("start", profile.start).member("cruise", profile.cruise).member("end", profile.end);
  json.end_object();
}

bool write_actions(JsonWriter& json, const std::vector<core::Action>& actions, const core::Robot& robot,
                   const ReceivedRobot& received, const core::Position& origin,
                   const core::StopCondition* stop, const NamedReasons& reasons) {
  constexpr std::size_t kActionsAtOnce = 64;  // between two questions
  std::optional<core::StopStride> stride;
  if (stop != nullptr) stride = core::StopStride::from_first(*stop, kActionsAtOnce);
  ActionWriter writer(json, robot, received, origin, reasons);
  json.key("actions").begin_array();
  for (std::size_t index = 0; index < actions.size(); ++index) {
    if (stride && stride->met_at_step()) return false;
    writer.write(actions[index], index);
  }
  json.end_array();
  return true;
}

namespace {

void write_action_progress(JsonWriter& json, std::string_view key, const core::ActionProgress& progress,
                           const std::vector<core::Robot>& robots) {
  json.key(key).begin_object();
  json.member("robot", robots[progress.robot].id).member("action", progress.action);
  json.member("progress", progress.fraction).end_object();
}

}  // namespace

void write_dependencies(JsonWriter& json, const core::Dependencies* dependencies,
                        const std::vector<core::Robot>& robots) {
  if (dependencies == nullptr) {
    json.key("dependencies").json("null").key("tight").json("null");
    return;
  }
  json.key("dependencies").begin_array();
  for (const core::Dependency& one : dependencies->list) {
    json.begin_object();
    write_action_progress(json, "gate", one.gate, robots);
    write_action_progress(json, "until", one.until, robots);
    json.member("slack", one.slack).end_object();
  }
  json.end_array().key("tight").begin_array();
  for (const core::TightPair& one : dependencies->tight) {
    json.begin_object().key("robots").begin_array();
    json.value(robots[one.first].id).value(robots[one.second].id).end_array();
    json.member("t", one.t).member("slack", one.slack).end_object();
  }
  json.end_array();
}

namespace {

constexpr std::size_t kBytesAnAction = 320;

void write_metadata(JsonWriter& json, const std::string& metadata) {
  if (!metadata.empty()) json.key("metadata").json(metadata);
}

/// Begins the entry of a goal that the plan does not reach.
void begin_visit_without_times(JsonWriter& json, std::size_t goal) {
  json.begin_object().member("goal", goal).key("t_arrive").json("null").key("t_leave").json("null");
}

void write_late_by(JsonWriter& json, const core::Goal& goal, double t_arrive) {
  if (const auto late = core::late_by(goal, t_arrive)) json.member("late_by", *late);
}

/// The number of the pose that the plan goes to; none for a goal that has one only.
std::optional<std::size_t> choice_of(const ReceivedRobot& received, std::size_t goal) {
  return goal < received.choices.size() ? received.choices[goal] : std::nullopt;
}

/// Writes where a goal is served that has several poses or a tolerance; null if it is not.
void write_where(JsonWriter& json, std::size_t goal, const ReceivedRobot& received,
                 const core::Position& origin, bool is_served) {
  if (const auto choice = choice_of(received, goal)) {
    is_served ? json.member("choice", *choice) : json.key("choice").json("null");
  }
  if (goal >= received.places.size() || !received.places[goal]) return;
  json.key("place");
  if (!is_served) {
    json.json("null");
    return;
  }
  const core::Position world = *received.places[goal] + origin;
  json.begin_object().member("x", world.x()).member("y", world.y()).end_object();
}

/// Ends the entry of a goal with its actions and metadata, if it has any. `texts`: of the goals by their
/// number, or none.
void end_visit(JsonWriter& json, std::size_t goal, const std::vector<GoalTexts>& texts) {
  if (goal < texts.size()) {
    if (!texts[goal].actions.empty()) json.key("actions").json(texts[goal].actions);
    write_metadata(json, texts[goal].metadata);
  }
  json.end_object();
}

/// Writes the goals that are put off: the goal that is inside a zone, and the goals after it.
void write_goals_put_off(JsonWriter& json, const core::PostponedGoals& goals, const VerifiedPlan& verified,
                         const ReceivedRobot& received) {
  for (std::size_t k = 0; k < goals.count; ++k) {
    begin_visit_without_times(json, goals.first + k);
    json.member("reason", k == 0 ? "zone_closed" : "goal_before");
    if (k == 0) json.member("zone", verified.problem.zones()[goals.zone].id);
    write_where(json, goals.first + k, received, verified.origin, k == 0);
    end_visit(json, goals.first + k, received.goal_texts);
  }
}

/// Writes the visits of a plan, and the visits that it leaves at the horizon. A goal that is anywhere is not
/// a goal of the request. `put_off`: the first goal, if any, from which on goals are not visited. Then the
/// service at the goal before it has an end.
void write_planned_visits(JsonWriter& json, const core::RobotPlan& plan, const core::Robot& robot,
                          const core::PostponedGoals* put_off, const ReceivedRobot& received,
                          const core::Position& origin) {
  const std::vector<GoalTexts>& texts = received.goal_texts;
  const std::size_t count = put_off != nullptr ? put_off->first : robot.own_goal_count();
  for (const core::Visit& visit : plan.visits) {
    if (visit.goal >= count) continue;
    json.begin_object().member("goal", visit.goal).member("t_arrive", visit.t_arrive);
    const bool stays = visit.t_leave == core::kForever;
    json.member("t_leave", stays && put_off != nullptr ? plan.cost : visit.t_leave);  // null at the last goal
    write_where(json, visit.goal, received, origin, true);
    write_late_by(json, robot.goal_at(visit.goal), visit.t_arrive);
    end_visit(json, visit.goal, texts);
  }
  for (const core::Visit& visit : plan.estimated_visits) {
    if (visit.goal >= count) continue;
    begin_visit_without_times(json, visit.goal);
    json.member("estimated_t_arrive", visit.t_arrive);  // null without a way
    write_where(json, visit.goal, received, origin, false);
    write_late_by(json, robot.goal_at(visit.goal), visit.t_arrive);
    end_visit(json, visit.goal, texts);
  }
}

/// Writes the member `visits`. The end of a way out that replaces a goal does not count. At the last goal
/// before the goals that are put off, the service ends, as at any goal that is not the last one.
void write_visits(JsonWriter& json, const core::RobotPlan& plan, const VerifiedPlan& verified) {
  const ReceivedRobot& received = verified.received[plan.robot];
  const core::Leaving* leaving = verified.problem.leaving(plan.robot);
  const core::PostponedGoals* put_off =
      leaving != nullptr && leaving->postponed ? &*leaving->postponed : nullptr;
  json.key("visits").begin_array();
  write_planned_visits(json, plan, verified.problem.robots()[plan.robot], put_off, received, verified.origin);
  if (put_off != nullptr) write_goals_put_off(json, *put_off, verified, received);
  json.end_array();
}

/// Returns the spacing of the finest lattice, metres; none if the answer does not have it.
std::optional<double> finest_lattice(const VerifiedPlan& verified) {
  const std::vector<double>& spacings = verified.lattice_spacings;
  const auto finest = std::min_element(spacings.begin(), spacings.end());
  return finest != spacings.end() ? std::optional(*finest) : std::nullopt;
}

/// Writes the spacing of the robot's lattice, unless it is the finest of all.
void write_own_lattice(JsonWriter& json, std::size_t robot, const VerifiedPlan& verified) {
  const auto finest = finest_lattice(verified);
  if (finest && verified.lattice_spacings[robot] != *finest) {
    json.member("lattice_spacing", verified.lattice_spacings[robot]);
  }
}

void write_blocked_by(JsonWriter& json, const core::RobotList& blocked_by, const VerifiedPlan& verified) {
  json.key("blocked_by").begin_array();
  for (const std::size_t robot : blocked_by) json.value(verified.problem.robots()[robot].id);
  json.end_array().member("blocked_by_total", blocked_by.total());
}

void write_plan(JsonWriter& json, const core::RobotPlan& plan, const VerifiedPlan& verified) {
  const core::Robot& robot = verified.problem.robots()[plan.robot];
  const ReceivedRobot& received = verified.received[plan.robot];
  json.begin_object();
  json.member("robot", robot.id).member("cost", plan.cost).member("lower_bound", plan.lower_bound);
  const core::Leaving* leaving = verified.problem.leaving(plan.robot);
  const bool puts_off = leaving != nullptr && leaving->postponed;
  if (plan.estimated_cost) {  // null without a way
    json.member("ends_at", "horizon").member("estimated_cost", *plan.estimated_cost);
  } else if (puts_off) {
    json.member("ends_at", "zone");
  }
  if (plan.is_stuck) {
    json.member("stuck", true);
    write_blocked_by(json, plan.blocked_by, verified);
  }
  write_own_lattice(json, plan.robot, verified);
  NamedReasons reasons{nullptr, &verified.problem.robots()};
  if (verified.wait_reasons != nullptr) reasons.list = &(*verified.wait_reasons)[plan.robot];
  write_actions(json, plan.actions, robot, received, verified.origin, nullptr, reasons);
  if (received.lists_visits || puts_off) write_visits(json, plan, verified);
  write_metadata(json, received.metadata);
  json.end_object();
}

/// Returns a length or a coordinate, to the accuracy of a width.
std::string millimetres_text(double number) {
  constexpr double kPerMetre = 1e3;
  return number_text(std::round(number * kPerMetre) / kPerMetre);
}

/// Returns a sentence, after a space.
std::string narrow_text(const core::NarrowPlace& narrow, const core::Position& origin) {
  const core::Position place = narrow.place + origin;
  return " It needs " + millimetres_text(narrow.needed) +
         " m; the narrowest place of the widest way there is " + millimetres_text(narrow.width) +
         " m wide, at (" + millimetres_text(place.x()) + ", " + millimetres_text(place.y()) + ").";
}

void write_unplanned(JsonWriter& json, std::size_t index, const VerifiedPlan& verified) {
  const core::Unplanned& unplanned = verified.plan.unplanned[index];
  std::string detail = unplanned.detail;
  if (index < verified.narrow_places.size() && verified.narrow_places[index]) {
    detail += narrow_text(*verified.narrow_places[index], verified.origin);
  }
  json.begin_object();
  json.member("robot", verified.problem.robots()[unplanned.robot].id);
  json.member("reason", name_of(unplanned.reason)).member("detail", detail);
  write_blocked_by(json, unplanned.blocked_by, verified);
  write_own_lattice(json, unplanned.robot, verified);
  const core::Robot& robot = verified.problem.robots()[unplanned.robot];
  const ReceivedRobot& received = verified.received[unplanned.robot];
  if (!robot.committed.empty()) write_actions(json, robot.committed, robot, received, verified.origin);
  if (!received.errors.empty()) write_errors(json, received.errors);
  write_metadata(json, received.metadata);
  json.end_object();
}

void write_unavoidable(JsonWriter& json, const core::UnavoidableCollision& collision,
                       const VerifiedPlan& verified) {
  const std::string& robot = verified.problem.robots()[collision.robot].id;
  json.begin_object();
  if (collision.other) {
    json.key("robots")
        .begin_array()
        .value(robot)
        .value(verified.problem.robots()[*collision.other].id)
        .end_array();
  } else {
    json.member("robot", robot);
  }
  if (collision.obstacle) json.member("obstacle", verified.problem.obstacles()[*collision.obstacle].id);
  json.member("t", collision.t).end_object();
}

void write_timings(JsonWriter& json, const StageTimes& stages) {
  const auto in_ms = [](StageTimes::Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
  };
  const auto milliseconds = [&](StageTimes::Time from, StageTimes::Time to) { return in_ms(to - from); };
  const StageTimes::Time now = StageTimes::Clock::now();
  json.key("timings_ms").begin_object();
  json.member("queue", milliseconds(stages.parsed, stages.started));
  json.member("parse", milliseconds(stages.received, stages.parsed));
  json.member("plan", milliseconds(stages.started, stages.planned));
  json.member("choose", in_ms(stages.parts.taken(core::PlanPart::choose)));
  json.member("first_plan", in_ms(stages.parts.taken(core::PlanPart::first_plan)));
  json.member("bounds", in_ms(stages.parts.taken(core::PlanPart::bounds)));
  json.member("improve", in_ms(stages.parts.taken(core::PlanPart::improve)));
  json.member("verify", milliseconds(stages.planned, stages.verified));
  json.member("serialize", milliseconds(stages.verified, now));
  json.member("total", milliseconds(stages.received, now));
  json.end_object();
}

/// Writes the members about the plan as a whole.
void write_summary(JsonWriter& json, const VerifiedPlan& verified) {
  const core::Plan& plan = verified.plan;
  json.member("flowtime", plan.objectives.flowtime).member("makespan", plan.objectives.makespan);
  if (verified.objective_value) json.member("objective_value", *verified.objective_value);
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
  if (const auto finest = finest_lattice(verified)) json.member("lattice_spacing", *finest);
  json.key("search").begin_object();
  json.member("attempts", plan.search.attempts).member("expansions", plan.search.expansions);
  json.member("improvements", plan.search.improvements);
  json.key("moves").begin_object();
  for (std::size_t k = 0; k < core::kMethods; ++k) {
    const core::MethodCounts& counts = plan.search.moves[k];
    if (counts.tried == 0) continue;
    json.key(name_of(static_cast<core::Method>(k))).begin_object();
    json.member("tried", counts.tried).member("served", counts.served);
    json.member("could_not_serve", counts.could_not_serve);
    json.end_object();
  }
  json.end_object();
  if (plan.search.exhausted) json.member("exhausted", true);
  json.end_object();
}

}  // namespace

std::string write_response(const VerifiedPlan& verified, const std::string& request_id,
                           const StageTimes& stages) {
  const core::Plan& plan = verified.plan;
  std::size_t actions = 0;
  for (const core::RobotPlan& one : plan.plans) actions += one.actions.size();
  for (const core::Unplanned& one : plan.unplanned)
    actions += verified.problem.robots()[one.robot].committed.size();
  JsonWriter json;
  json.reserve((actions + verified.problem.robots().size() + 4) * kBytesAnAction);
  json.begin_object();
  json.member("status", name_of(status_of(plan))).member("request_id", request_id);
  json.key("plans").begin_array();
  for (const core::RobotPlan& one : plan.plans) write_plan(json, one, verified);
  json.end_array();
  json.key("unplanned").begin_array();
  for (std::size_t k = 0; k < plan.unplanned.size(); ++k) write_unplanned(json, k, verified);
  json.end_array();
  if (!plan.unavoidable.empty()) {
    json.key("unavoidable").begin_array();
    for (const core::UnavoidableCollision& one : plan.unavoidable) write_unavoidable(json, one, verified);
    json.end_array();
  }
  if (verified.dependencies != nullptr) {
    const auto& made = *verified.dependencies;
    write_dependencies(json, made ? &*made : nullptr, verified.problem.robots());
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

namespace {

constexpr std::size_t kMaxWritten = 20;

std::string_view kind_name(core::Violation::Kind kind) {
  switch (kind) {
    case core::Violation::Kind::robot_collision:
      return "robot_collision";
    case core::Violation::Kind::obstacle_collision:
      return "obstacle_collision";
    case core::Violation::Kind::discontinuity:
      return "discontinuity";
    case core::Violation::Kind::speed:
      return "speed";
    case core::Violation::Kind::profile:
      return "profile";
    case core::Violation::Kind::wrong_start:
      return "wrong_start";
    case core::Violation::Kind::wrong_goal:
      return "wrong_goal";
    case core::Violation::Kind::wrong_visit:
      return "wrong_visit";
    case core::Violation::Kind::committed_changed:
      return "committed_changed";
    case core::Violation::Kind::margin:
      return "margin";
    case core::Violation::Kind::moving_obstacle:
      return "moving_obstacle";
    case core::Violation::Kind::zone:
      break;
  }
  return "zone";
}

}  // namespace

std::optional<double> reported_clearance(const core::VerifyReport& report) {
  if (!report.min_clearance) return std::nullopt;
  const bool contact =
      *report.min_clearance >= -core::kContactTolerance && *report.min_clearance <= core::kSamePosition;
  return contact ? 0.0 : *report.min_clearance;
}

std::string write_report(const core::VerifyReport& report, const std::vector<core::Robot>& robots,
                         const std::vector<core::MovingObstacle>& obstacles,
                         const std::vector<core::Zone>& zones) {
  const std::size_t written = std::min(report.violations.size(), kMaxWritten);
  JsonWriter json;
  json.begin_object();
  json.member("valid", report.valid());
  json.key("violations").begin_array();
  // Bounded: at most kMaxWritten violations.
  for (std::size_t index = 0; index < written; ++index) {
    const core::Violation& violation = report.violations[index];
    json.begin_object();
    json.member("kind", kind_name(violation.kind));
    json.key("robots").begin_array();
    for (const std::size_t robot : violation.robots) json.value(robots[robot].id);
    json.end_array();
    if (violation.obstacle) json.member("obstacle", obstacles[*violation.obstacle].id);
    if (violation.zone) json.member("zone", zones[*violation.zone].id);
    json.member("t", violation.t).member("distance", violation.distance);
    json.member("required", violation.required).member("detail", violation.detail);
    json.end_object();
  }
  json.end_array();
  json.member("min_clearance", reported_clearance(report));
  json.member("violations_total", report.violation_count);
  if (written < report.violation_count) json.member("truncated", true);
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api
