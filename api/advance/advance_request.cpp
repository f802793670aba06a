#include "api/advance/advance_request.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "api/json/json_writer.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/parse_body.h"
#include "api/request/parse_request.h"
#include "api/response/write_response.h"
#include "core/advance/timeline.h"
#include "core/geometry/position.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 5> kPoseMembers{"robot", "x", "y", "theta", "speed"};
constexpr std::array<std::string_view, 9> kStateMembers{"robot", "action", "progress", "service_left", "x",
                                                        "y",     "theta",  "speed",    "released"};
constexpr std::array<std::string_view, 2> kPlaceMembers{"action", "progress"};
constexpr std::array<std::string_view, 2> kHoldMembers{"robot", "until"};
constexpr std::array<std::string_view, 2> kGoalsMembers{"robot", "goals"};

/// Reads a list of entries of robots, at most one for each. `read` gets an entry and its robot's index.
template <typename Read>
void read_entries(const JsonReader& list, std::span<const std::string_view> members, const RobotNames& names,
                  const Read& read) {
  std::unordered_set<std::size_t> seen;
  for (const JsonReader item : list.array().items()) {
    const JsonReader entry = item.object(members);
    const JsonReader robot = entry.require("robot");
    const auto index = names.find(robot);
    if (index && !seen.insert(*index).second) {
      robot.fault(fault::kDuplicate, "This robot already has an entry in this list; give only one.");
    }
    read(entry, index);
  }
}

std::optional<core::Pose> parse_measured(const JsonReader& entry, const WorldFrame& frame) {
  const auto x = entry.require("x").number(kCoordinate);
  const auto y = entry.require("y").number(kCoordinate);
  const auto theta = entry.require("theta").number(kAnyAngle);
  if (!x || !y || !theta) return std::nullopt;
  return core::Pose{frame.to_map({*x, *y}), core::normalize_angle(*theta)};
}

void parse_events(const JsonReader& root, const RobotNames& names, const Limits& limits,
                  const WorldFrame& frame, AdvanceRequest& request) {
  std::vector<core::Execution>& executions = request.now.executions;
  Quota quota(limits.max_goals, "goals");
  read_entries(root.find("poses"), kPoseMembers, names, [&](const JsonReader& entry, auto robot) {
    const auto pose = parse_measured(entry, frame);
    const auto speed = entry.find("speed").number(kMeasuredSpeed);
    if (!robot) return;
    executions[*robot].measured = pose;
    executions[*robot].speed = speed;
  });
  read_entries(root.find("holds"), kHoldMembers, names, [&](const JsonReader& entry, auto robot) {
    const auto until = entry.require("until").number(kDuration);
    if (robot) executions[*robot].hold = until;
  });
  read_entries(root.find("goals"), kGoalsMembers, names, [&](const JsonReader& entry, auto robot) {
    entry.require("goals");
    ParsedGoals goals = parse_goals(entry, frame, quota);
    if (!robot) return;
    check_loads(goals.places, request.fleet.robots[*robot].robot);
    executions[*robot].goals = std::move(goals.goals);
    if (request.fleet.robots[*robot].robot.yields()) {
      executions[*robot].goals->emplace_back().anywhere = true;
    }
    request.repeated[*robot].others = std::move(goals.texts);
    request.repeated[*robot].other_open = std::move(goals.open);
  });
}

/// The number of an action that the robot has.
std::optional<std::size_t> parse_action_number(const JsonReader& member, const core::Robot& robot,
                                               const std::vector<core::Action>& actions) {
  const auto action = member.natural(kGreatestIndex);
  if (!action || *action < actions.size()) return action;
  member.fault(fault::kOutOfRange, [&] {
    if (actions.empty()) {
      return "Robot " + in_quotes(robot.id) +
             " has no action, neither of a plan nor committed: leave its state out, or give its pose in "
             "poses.";
    }
    return "Robot " + in_quotes(robot.id) + " has " + std::to_string(actions.size()) +
           " actions, numbered from 0; one that has done all of them is at progress 1 of the last.";
  });
  return std::nullopt;
}

/// A measured position without a heading has the planned heading.
std::optional<core::Pose> parse_measured_at(const JsonReader& entry, const WorldFrame& frame,
                                            const core::Pose& planned) {
  const JsonReader theta_member = entry.find("theta");
  if (!entry.find("x") && !entry.find("y") && !theta_member) return std::nullopt;
  constexpr std::string_view kRemedy = "; a measured pose has x and y";
  const auto x = entry.require("x", kRemedy).number(kCoordinate);
  const auto y = entry.require("y", kRemedy).number(kCoordinate);
  const double theta = theta_member.number(kAnyAngle).value_or(planned.theta);
  if (!x || !y) return std::nullopt;
  return core::Pose{frame.to_map({*x, *y}), core::normalize_angle(theta)};
}

/// Reads how far a robot is released, which is not behind it.
std::optional<core::ActionPlace> parse_released(const JsonReader& member, const core::Robot& robot,
                                                const core::ActionPlace& place,
                                                const std::vector<core::Action>& actions) {
  const JsonReader json = member.object(kPlaceMembers);
  if (!json) return std::nullopt;
  const auto number = parse_action_number(json.require("action"), robot, actions);
  const auto fraction = json.require("progress").number(kFraction);
  if (!number || !fraction) return std::nullopt;
  const auto whole = [](std::size_t action, double done) { return static_cast<double>(action) + done; };
  if (whole(*number, *fraction) < whole(place.action, place.fraction)) {
    member.fault(fault::kOutOfRange, [&] {
      return "Robot " + in_quotes(robot.id) +
             " is further than it is released; give its own action and progress if it may go no further.";
    });
  }
  return core::ActionPlace{*number, *fraction};
}

/// Reads where a robot says that it is in its actions.
void parse_state(const JsonReader& entry, const WorldFrame& frame, const core::Robot& robot,
                 core::Execution& execution) {
  const std::vector<core::Action>& actions = execution.actions;
  const JsonReader left_member = entry.find("service_left");
  const auto number = parse_action_number(entry.require("action"), robot, actions);
  const auto fraction = entry.require("progress").number(kFraction);
  const auto service_left = left_member.number(kDuration);
  execution.speed = entry.find("speed").number(kMeasuredSpeed);
  if (!number || !fraction) return;
  const core::Action& action = actions[*number];
  const bool is_service = action.goal && *action.goal < robot.goal_count();
  if (service_left && !is_service) {
    left_member.fault(fault::kUnknownKey, [&] {
      return "Action " + std::to_string(*number) +
             " is no service, which is a wait with goal: leave service_left out.";
    });
  }
  execution.reported = core::ReportedState{{*number, *fraction}, service_left, {}};
  execution.reported->released =
      parse_released(entry.find("released"), robot, execution.reported->place, actions);
  execution.measured = parse_measured_at(entry, frame, core::pose_of(actions, *execution.reported));
}

/// Reads them when the actions of all robots are known.
void parse_states(const JsonReader& list, const RobotNames& names, AdvanceRequest& request) {
  read_entries(list, kStateMembers, names, [&](const JsonReader& entry, auto robot) {
    if (!robot) return;
    core::Execution& execution = request.now.executions[*robot];
    if (execution.measured) {
      entry.find("robot").fault(
          fault::kDuplicate,
          "This robot has an entry in poses, too: leave that out, and give the measured "
          "pose here, as x, y and theta.");
    }
    parse_state(entry, request.fleet.map->frame, request.now.robots[*robot], execution);
  });
}

core::Moment parse_moment(const JsonReader& root, const core::PlanOptions& options) {
  core::Moment moment;
  moment.at = root.require("at").number(kDuration).value_or(0.0);
  moment.commit = root.find("commit").number(kDuration);
  if (const auto tolerance = root.find("pose_tolerance").number(kLengthOrZero)) {
    moment.pose_tolerance = *tolerance;
  }
  moment.wait_before_move = options.wait_before_move;
  moment.inflation = options.inflation;
  moment.has_horizon = options.horizon.has_value();
  return moment;
}

/// Takes a robot of the fleet, whose open goals its plan has settled.
void take_robot(std::size_t index, AdvanceRequest& read) {
  ParsedRobot& given = read.fleet.robots[index];
  RepeatedGoals& repeated = read.repeated[index];
  repeated.texts = std::move(given.goal_texts);
  repeated.open = std::move(given.open);
  repeated.returns = given.idle == Idle::come_back;
  core::Execution& execution = read.now.executions[index];
  execution.stop_distance = given.stop_distance;
  execution.stays_when_served = given.idle == Idle::stay;
  execution.first_unserved = given.first_unserved;
  core::Robot robot = given.robot;
  if (!execution.planned) execution.actions = robot.committed;
  // A robot that is off its path turns back as slowly as it has to anywhere.
  robot.angular_speed = core::DriveZones(read.fleet.zones, index, robot).least_angular_speed();
  read.now.robots.push_back(std::move(robot));
}

}  // namespace

std::optional<AdvanceRequest> parse_advance_request(const JsonReader& root, const Limits& limits,
                                                    core::Work& work) {
  AdvanceRequest read;
  read.request = root.require("request").object(kPlanRequestMembers);
  read.given = std::make_unique<GivenPositions>();
  const auto set_budget = [&](const ParsedOptions& options) {
    work.set_budget(effective_budget(options, limits));
  };
  read.fleet = parse_fleet(read.request, limits, set_budget, read.given.get());
  Fleet& fleet = read.fleet;
  read.now.moment = parse_moment(root, fleet.options.plan);
  read.now.executions.resize(fleet.robots.size());
  read.repeated.resize(fleet.robots.size());
  const RobotNames names(fleet.robots, "robots of the request");
  const WorldFrame frame = fleet.map ? fleet.map->frame : WorldFrame();
  parse_events(root, names, limits, frame, read);
  const JsonReader list = root.require("plans");
  std::vector<core::RobotPlan> plans = parse_plans(list, fleet.robots, frame);
  check_profiles(list, plans);
  for (core::RobotPlan& plan : plans) {
    read.now.executions[plan.robot].actions = std::move(plan.actions);
    read.now.executions[plan.robot].planned = true;
  }
  if (!read.request || root.fault_count() > 0 || work.met()) return std::nullopt;
  std::size_t corners = fleet.zones.size();
  for (const core::Zone& zone : fleet.zones) corners += zone.polygon.size();
  for (std::size_t k = 0; k < fleet.robots.size(); ++k) {
    if (work.met_after(corners)) return std::nullopt;
    take_robot(k, read);
  }
  read.now.obstacles = fleet.obstacles;
  parse_states(root.find("states"), names, read);
  if (root.fault_count() > 0) return std::nullopt;
  return work.met() ? std::nullopt : std::optional(std::move(read));
}

core::Judgement judgement_of(AdvanceRequest& request, core::MapCache* maps, core::Work& work) {
  return {.options = request.fleet.options.plan,
          .zones = request.fleet.zones,
          .reports_invalid = request.fleet.options.invalid_robots == InvalidRobots::report,
          .read_back =
              [&frame = request.fleet.map->frame](const core::Position& position) {
                return core::Position(frame.to_world(position) - frame.origin);
              },
          .map =
              [&grid = request.fleet.map->grid, maps, &work] {
                return maps != nullptr ? maps->map_of(std::move(grid), work.reading())
                                       : core::static_map(std::move(grid), work.reading());
              }};
}

namespace {

// The members of a robot that depend on the moment.
constexpr std::array<std::string_view, 6> kChanging{"start",     "goal",     "goals",
                                                    "committed", "previous", "goal_age"};

void write_position(JsonWriter& json, const core::Position& position, const WorldFrame& frame) {
  const core::Position world = frame.to_world(position);
  json.member("x", world.x()).member("y", world.y());
}

void write_pose(JsonWriter& json, std::string_view key, const core::Pose& pose, const WorldFrame& frame) {
  json.key(key).begin_object();
  write_position(json, pose.position, frame);
  json.member("theta", pose.theta).end_object();
}

/// With the speed, if the robot is under way.
void write_start(JsonWriter& json, const core::Robot& robot, const WorldFrame& frame) {
  json.key("start").begin_object();
  write_position(json, robot.start.position, frame);
  json.member("theta", robot.start.theta);
  if (robot.committed_speed() != 0.0) json.member("speed", robot.committed_speed());
  json.end_object();
}

/// Without a service, nothing is left of its actions. `open`: all that was given is still possible; null if
/// not. `is_told`: the actions of the robot serve it at the chosen pose.
void write_goal(JsonWriter& json, const core::Goal& goal, const WorldFrame& frame, const GoalTexts& texts,
                const core::OpenGoal* open, bool is_told) {
  json.begin_object();
  if (open != nullptr && open->tolerance == 0.0) {
    json.key("any_of").json(texts.any_of);
    if (is_told) json.member("choice", open->choice().number);
  } else {
    write_position(json, open != nullptr ? open->own : goal.position, frame);
    if (goal.theta) json.member("theta", *goal.theta);
  }
  if (open != nullptr && open->tolerance > 0.0) {
    json.member("tolerance", open->tolerance);
    if (is_told && open->choice().position != open->own) {
      json.key("place").begin_object();
      write_position(json, open->choice().position, frame);
      json.end_object();
    }
  }
  if (goal.service > 0.0) json.member("service", goal.service);
  if (goal.not_before > 0.0) json.member("not_before", goal.not_before);
  if (goal.due) json.member("due", *goal.due);
  if (goal.radius_after) json.member("radius_after", *goal.radius_after);
  if (goal.linear_speed_after) json.member("linear_speed_after", *goal.linear_speed_after);
  if (goal.linear_acceleration_after)
    json.member("linear_acceleration_after", *goal.linear_acceleration_after);
  if (goal.linear_deceleration_after)
    json.member("linear_deceleration_after", *goal.linear_deceleration_after);
  if (!texts.actions.empty() && goal.service > 0.0) json.key("actions").json(texts.actions);
  if (!texts.metadata.empty()) json.key("metadata").json(texts.metadata);
  json.end_object();
}

void write_actions(JsonWriter& json, std::string_view key, const std::vector<core::Action>& actions,
                   const WorldFrame& frame, core::Work& work) {
  constexpr std::size_t kTextOfAnAction = 512;  // bytes
  constexpr std::array<std::string_view, 3> kTypes{"rotate", "translate", "wait"};
  json.key(key).begin_array();
  for (const core::Action& action : actions) {
    if (work.met_after(kTextOfAnAction)) break;
    json.begin_object().member("type", kTypes[static_cast<std::size_t>(action.type)]);
    json.member("t_start", action.t_start).member("t_end", action.t_end);
    write_pose(json, "from", action.from, frame);
    write_pose(json, "to", action.to, frame);
    if (action.goal) json.member("goal", *action.goal);
    if (action.reverse) json.member("reverse", true);
    if (action.profile) write_profile(json, *action.profile);
    json.end_object();
  }
  json.end_array();
}

/// What is repeated of the goals of a robot: the last of its goals, or the goals that it passes, followed by
/// new goals.
class GoalsToRepeat {
 public:
  GoalsToRepeat(const AdvanceRequest& request, std::size_t index, const core::Robot& left)
      : left_(left), repeated_(request.repeated[index]) {
    const core::Execution& execution = request.now.executions[index];
    are_other_ = execution.goals.has_value();
    if (are_other_) {
      passed_ = core::passed_goals(request.now.robots[index], execution, request.now.moment, left);
    } else {
      passed_.first = request.now.robots[index].goal_count() - left.goal_count();
    }
  }

  /// Whether the robot has got other goals.
  bool are_other() const { return are_other_; }

  /// The goal, if all of its poses are still possible; otherwise null. A robot that rests in the pose that
  /// its plan has chosen stays with it, unless it is done and may come back to another pose. Passed goals do
  /// not count.
  const core::OpenGoal* open(std::size_t goal) const {
    const core::OpenGoal* open = open_goal(goal);
    if (open == nullptr || goal > 0 || !open->is_settled) return open;
    const core::Goal& next = left_.goal_at(goal);
    if (!core::is_in_pose(left_.start, next)) return open;
    const bool comes_back = repeated_.returns && left_.own_goal_count() == 1 && next.service == 0.0;
    return comes_back ? open : nullptr;
  }

  /// Whether the actions of the robot may serve its goals at the chosen poses only.
  bool are_told() const { return !left_.committed.empty() || left_.previous; }

  const GoalTexts& texts_of(std::size_t goal) const {
    static const GoalTexts none;
    const bool is_other = are_other_ && !is_passed(goal);
    const std::vector<GoalTexts>& all = is_other ? repeated_.others : repeated_.texts;
    const std::size_t number = is_other ? goal - passed_.count : passed_.first + goal;
    return number < all.size() ? all[number] : none;
  }

 private:
  bool is_passed(std::size_t goal) const { return are_other_ && goal < passed_.count; }

  /// The goal, if it has several poses; otherwise null.
  const core::OpenGoal* open_goal(std::size_t goal) const {
    if (is_passed(goal)) return nullptr;
    const std::size_t number = are_other_ ? goal - passed_.count : passed_.first + goal;
    return core::find_open(are_other_ ? repeated_.other_open : repeated_.open, number);
  }

  const core::Robot& left_;
  const RepeatedGoals& repeated_;
  core::PassedGoals passed_;  // the goals that are left begin with the first of them
  bool are_other_ = false;
};

/// As one goal if the request gave one goal, otherwise as a list.
void write_goals(JsonWriter& json, const core::Robot& robot, const WorldFrame& frame,
                 const GoalsToRepeat& goals, bool as_one) {
  const auto write = [&](std::size_t goal) {
    write_goal(json, robot.goal_at(goal), frame, goals.texts_of(goal), goals.open(goal), goals.are_told());
  };
  const std::size_t count = robot.own_goal_count();
  if (count == 0) return;
  if (as_one && count == 1) {
    json.key("goal");
    return write(0);
  }
  json.key("goals").begin_array();
  for (std::size_t k = 0; k < count; ++k) write(k);
  json.end_array();
}

/// The traits that the load has changed, by their names.
std::vector<std::pair<std::string_view, double>> changed_traits(const core::Robot& before,
                                                                const core::Robot& robot) {
  std::vector<std::pair<std::string_view, double>> changed;
  if (robot.radius != before.radius) changed.emplace_back("radius", robot.radius);
  if (robot.linear_speed != before.linear_speed) changed.emplace_back("linear_speed", robot.linear_speed);
  // A deceleration that is not given follows the acceleration.
  if (robot.linear_inertia() != before.linear_inertia()) {
    for (const auto& [name, limit] : {std::pair("linear_acceleration", robot.linear_acceleration),
                                      std::pair("linear_deceleration", robot.linear_deceleration)}) {
      if (limit < core::Robot::kNoLimit) changed.emplace_back(name, limit);
    }
  }
  return changed;
}

/// `before`: as the request gave it.
void write_robot(JsonWriter& json, const JsonValue& given, const core::Robot& before,
                 const core::Robot& robot, const WorldFrame& frame, const GoalsToRepeat& goals,
                 core::Work& work) {
  const auto changed = changed_traits(before, robot);
  const auto is_changed = [&](std::string_view key) {
    return std::any_of(changed.begin(), changed.end(), [&](const auto& trait) { return trait.first == key; });
  };
  json.begin_object();
  for (const JsonValue member : given.children()) {
    if (std::find(kChanging.begin(), kChanging.end(), member.key()) != kChanging.end()) continue;
    if (is_changed(member.key())) continue;
    json.key(member.key());
    copy_json(json, member);
  }
  for (const auto& [name, value] : changed) json.member(name, value);
  write_start(json, robot, frame);
  const bool is_listed = given.find("goals").has_value() || goals.are_other();
  write_goals(json, robot, frame, goals, given.find("goal").has_value() || !is_listed);
  if (robot.goal_age > 0.0) json.member("goal_age", robot.goal_age);
  if (!robot.committed.empty()) write_actions(json, "committed", robot.committed, frame, work);
  if (robot.previous) write_actions(json, "previous", *robot.previous, frame, work);
  json.end_object();
}

void write_robots(JsonWriter& json, const JsonValue& given, const AdvanceRequest& request,
                  const std::vector<core::Robot>& robots, core::Work& work) {
  json.begin_array();
  std::size_t index = 0;
  for (const JsonValue robot : given.children()) {
    write_robot(json, robot, request.now.robots[index], robots[index], request.fleet.map->frame,
                GoalsToRepeat(request, index, robots[index]), work);
    ++index;
  }
  json.end_array();
}

void write_obstacles(JsonWriter& json, const JsonValue& given, const AdvanceRequest& request) {
  json.begin_array();
  auto read = request.now.obstacles.begin();
  // Bounded: the text of the request, which is copied.
  for (const JsonValue obstacle : given.children()) {
    // An obstacle that had left at the start has not been read.
    if (read == request.now.obstacles.end() || obstacle.find("id")->string() != read->id) continue;
    const auto left = core::advanced(*read++, request.now.moment.at);
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
      write_position(json, entry.position, request.fleet.map->frame);
      json.end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

void write_place(JsonWriter& json, std::string_view key, const core::ActionPlace& place) {
  json.key(key).begin_object();
  json.member("action", place.action).member("progress", place.fraction);
  json.end_object();
}

/// The options as given. Adds options without which robots could not be where they are.
void write_options(JsonWriter& json, const std::optional<JsonValue>& given,
                   const core::Circumstances& circumstances) {
  json.key("options").begin_object();
  if (given) {
    // Bounded: the text of the request, which is copied.
    for (const JsonValue member : given->children()) {
      const bool is_replaced = (circumstances.start_overlap && member.key() == "start_overlap") ||
                               (circumstances.some_in_walls && member.key() == "invalid_robots");
      if (is_replaced) continue;
      json.key(member.key());
      copy_json(json, member);
    }
  }
  if (circumstances.start_overlap) json.member("start_overlap", *circumstances.start_overlap);
  if (circumstances.some_in_walls) json.member("invalid_robots", "report");
  json.end_object();
}

void write_unavoidable(JsonWriter& json, const AdvanceRequest& request,
                       const core::Circumstances& circumstances, core::Work& work) {
  constexpr std::size_t kWorkOfAPair = 64;  // bytes of text, without names
  json.key("unavoidable").begin_array();
  for (const auto& [first, second, t] : circumstances.unavoidable.listed) {
    const std::string& a = request.now.robots[first].id;
    const std::string& b = request.now.robots[second].id;
    if (work.met_after(kWorkOfAPair + a.size() + b.size())) break;
    json.begin_object().key("robots").begin_array().value(a).value(b).end_array();
    json.member("t", t).end_object();
  }
  json.end_array();
  json.member("unavoidable_total", circumstances.unavoidable.total);
}

/// Where each robot is in the actions that it was given. In the new request, it is at the beginning of its
/// actions, because time 0 of a request is its moment.
void write_progress(JsonWriter& json, const AdvanceRequest& request, core::Work& work) {
  constexpr std::size_t kWorkOfALook = 64;  // at an action, to find the one under way
  json.key("progress").begin_array();
  for (std::size_t k = 0; k < request.now.robots.size(); ++k) {
    const core::Execution& execution = request.now.executions[k];
    if (work.met_after(kWorkOfALook * (1 + execution.actions.size()))) break;
    json.begin_object().member("robot", request.now.robots[k].id);
    write_place(json, "was", core::place_of(request.now.robots[k], execution, request.now.moment));
    write_place(json, "is", core::ActionPlace{});
    json.end_object();
  }
  json.end_array();
}

}  // namespace

std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           const core::Circumstances& circumstances, core::Work& work) {
  const bool needs_options = circumstances.start_overlap || circumstances.some_in_walls;
  JsonWriter json;
  json.begin_object();
  for (const JsonValue member : request.request.value().children()) {
    if (is_of_an_answer(member.key()) || (member.key() == "options" && needs_options)) continue;
    json.key(member.key());
    if (member.key() == "robots") {
      write_robots(json, member, request, robots, work);
    } else if (member.key() == "obstacles") {
      write_obstacles(json, member, request);
    } else {
      copy_json(json, member);
    }
  }
  if (needs_options) write_options(json, request.request.value().find("options"), circumstances);
  write_progress(json, request, work);
  if (!circumstances.unavoidable.listed.empty()) write_unavoidable(json, request, circumstances, work);
  json.end_object();
  return json.take();
}

}  // namespace fleetplan::api
