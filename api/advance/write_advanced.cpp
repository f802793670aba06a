#include "api/advance/write_advanced.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_writer.h"

namespace fleetplan::api {

namespace {

// The members of a robot that depend on the moment.
constexpr std::array<std::string_view, 5> kChanging{"start", "goal", "goals", "committed", "previous"};

void write_pose(JsonWriter& json, std::string_view key, const core::Pose& pose) {
  json.key(key).begin_object();
  json.member("x", pose.position.x()).member("y", pose.position.y()).member("theta", pose.theta);
  json.end_object();
}

void write_goal(JsonWriter& json, const core::Goal& goal, const std::string& metadata) {
  json.begin_object().member("x", goal.position.x()).member("y", goal.position.y());
  if (goal.theta) json.member("theta", *goal.theta);
  if (goal.service > 0.0) json.member("service", goal.service);
  if (goal.not_before > 0.0) json.member("not_before", goal.not_before);
  if (goal.radius_after) json.member("radius_after", *goal.radius_after);
  if (!metadata.empty()) json.key("metadata").json(metadata);
  json.end_object();
}

void write_actions(JsonWriter& json, std::string_view key, const std::vector<core::Action>& actions,
                   core::Work& work) {
  constexpr std::size_t kWorkOfAnAction = 512;  // bytes of text
  constexpr std::array<std::string_view, 3> kTypes{"rotate", "translate", "wait"};
  json.key(key).begin_array();
  for (const core::Action& action : actions) {
    if (work.met_after(kWorkOfAnAction)) break;
    json.begin_object().member("type", kTypes[static_cast<std::size_t>(action.type)]);
    json.member("t_start", action.t_start).member("t_end", action.t_end);
    write_pose(json, "from", action.from);
    write_pose(json, "to", action.to);
    if (action.goal) json.member("goal", *action.goal);
    if (action.reverse) json.member("reverse", true);
    json.end_object();
  }
  json.end_array();
}

/// The metadata of the goals that are left: the last ones of those that the robot had.
class GoalMetadata {
 public:
  GoalMetadata(const AdvanceRequest& request, std::size_t index, const core::Robot& left)
      : all_(request.goal_metadata[index]) {
    const Execution& execution = request.executions[index];
    const std::size_t had = execution.goals ? execution.goals->size() : request.robots[index].goal_count();
    visited_ = had - left.goal_count();
  }

  const std::string& of(std::size_t goal) const {
    static const std::string none;
    return visited_ + goal < all_.size() ? all_[visited_ + goal] : none;
  }

 private:
  const std::vector<std::string>& all_;
  std::size_t visited_ = 0;
};

/// As one goal if the request gave one goal, otherwise as a list.
void write_goals(JsonWriter& json, const core::Robot& robot, const GoalMetadata& metadata, bool as_one) {
  if (!robot.goal) return;
  if (as_one && robot.via.empty()) {
    json.key("goal");
    return write_goal(json, *robot.goal, metadata.of(0));
  }
  json.key("goals").begin_array();
  for (std::size_t k = 0; k < robot.goal_count(); ++k) write_goal(json, robot.goal_at(k), metadata.of(k));
  json.end_array();
}

/// `radius`: that the robot had.
void write_robot(JsonWriter& json, const JsonValue& given, double radius, const core::Robot& robot,
                 const GoalMetadata& metadata, core::Work& work) {
  const bool has_other_radius = robot.radius != radius;
  json.begin_object();
  for (const JsonValue member : given.children()) {
    if (std::find(kChanging.begin(), kChanging.end(), member.key()) != kChanging.end()) continue;
    if (has_other_radius && member.key() == "radius") continue;
    json.key(member.key());
    copy_json(json, member);
  }
  if (has_other_radius) json.member("radius", robot.radius);
  write_pose(json, "start", robot.start);
  write_goals(json, robot, metadata, given.find("goal").has_value());
  if (!robot.committed.empty()) write_actions(json, "committed", robot.committed, work);
  if (robot.previous) write_actions(json, "previous", *robot.previous, work);
  json.end_object();
}

void write_robots(JsonWriter& json, const JsonValue& given, const AdvanceRequest& request,
                  const std::vector<core::Robot>& robots, core::Work& work) {
  json.begin_array();
  std::size_t index = 0;
  for (const JsonValue robot : given.children()) {
    write_robot(json, robot, request.robots[index].radius, robots[index],
                GoalMetadata(request, index, robots[index]), work);
    ++index;
  }
  json.end_array();
}

void write_obstacles(JsonWriter& json, const JsonValue& given, const AdvanceRequest& request) {
  json.begin_array();
  auto read = request.obstacles.begin();
  // Bounded: the text of the request, which is copied.
  for (const JsonValue obstacle : given.children()) {
    // One that had left at the start is not among those that were read.
    if (read == request.obstacles.end() || obstacle.find("id")->string() != read->id) continue;
    const auto left = advanced(*read++, request.moment.at);
    if (!left) continue;
    json.begin_object();
    for (const JsonValue member : obstacle.children()) {
      if (member.key() == "motion") continue;
      json.key(member.key());
      copy_json(json, member);
    }
    json.key("motion").begin_array();
    for (const auto& entry : left->motion) {
      json.begin_object().member("t", entry.t);
      json.member("x", entry.position.x()).member("y", entry.position.y()).end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace

std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           core::Work& work) {
  JsonWriter json;
  json.begin_object();
  for (const JsonValue member : request.request.value().children()) {
    json.key(member.key());
    if (member.key() == "robots") {
      write_robots(json, member, request, robots, work);
    } else if (member.key() == "obstacles") {
      write_obstacles(json, member, request);
    } else {
      copy_json(json, member);
    }
  }
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api
