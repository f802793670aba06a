#include "api/request/fleet/parse_robots.h"

#include <fleetplan/limits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/request/fleet/parse_actions.h"
#include "api/request/limits.h"
#include "api/request/shared_members.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 16> kGoalMembers{"x",
                                                        "y",
                                                        "theta",
                                                        "any_of",
                                                        "choice",
                                                        "tolerance",
                                                        "place",
                                                        "service",
                                                        "not_before",
                                                        "due",
                                                        "radius_after",
                                                        "linear_speed_after",
                                                        "linear_acceleration_after",
                                                        "linear_deceleration_after",
                                                        "actions",
                                                        "metadata"};
constexpr Range kGoalTolerance{0.0, core::kMaxGoalTolerance, "metres"};
constexpr std::array<std::string_view, 4> kAlternativeMembers{"x", "y", "theta", "bias"};

/// A robot that waits for `not_before` is not late, so it cannot be due before.
void check_due(const JsonReader& due, double due_at, double not_before) {
  if (not_before <= 0.0 || due_at >= not_before) return;
  due.fault(fault::kOutOfRange, [&] {
    return "The goal is due at " + number_text(due_at) + " s, before its not_before, " +
           number_text(not_before) + " s; make due at least not_before, or leave one of them out.";
  });
}

/// Reads the poses of `any_of`, which a goal has instead of one of its own.
std::vector<core::Alternative> parse_any_of(const JsonReader& goal, const JsonReader& any_of,
                                            const WorldFrame& frame, Quota& quota) {
  std::vector<core::Alternative> poses;
  for (const std::string_view member : {"x", "y", "theta"}) {
    if (const JsonReader own = goal.find(member)) {
      own.fault(fault::kDuplicate,
                "The goal has any_of, too, whose poses have x, y and theta; give either "
                "a pose or any_of.");
    }
  }
  const JsonReader list = any_of.array();
  if (!list) return poses;
  if (list.size() < kFewestPoses || list.size() > kMaxPoses) {
    list.fault(fault::kOutOfRange, "any_of must have " + std::to_string(kFewestPoses) + " to " +
                                       std::to_string(kMaxPoses) + " poses, not " +
                                       std::to_string(list.size()) +
                                       "; a goal with one pose has it as x, y and theta.");
    return poses;
  }
  if (!quota.take(list)) return poses;
  for (const JsonReader item : list.items()) {
    const JsonReader json = item.object(kAlternativeMembers);
    const auto pose = parse_pose(json, frame);
    const double bias = json.find("bias").number(kDuration).value_or(0.0);
    if (pose) poses.push_back({pose->position, pose->theta, bias, poses.size()});
  }
  return poses;
}

/// Reads the pose of `any_of` at which the actions of the robot serve the goal.
std::optional<std::size_t> parse_choice(const JsonReader& goal, std::size_t poses) {
  const JsonReader member = goal.find("choice");
  const auto number = member.natural(kGreatestIndex);
  if (!number || *number < poses) return number;
  if (!goal.find("any_of")) {
    member.fault(fault::kOutOfRange, "The goal has no any_of; leave choice out.");
  } else if (poses > 0) {
    member.fault(fault::kOutOfRange, [&] {
      return "any_of of the goal has " + std::to_string(poses) + " poses, numbered from 0.";
    });
  }
  return std::nullopt;
}

/// Reads `tolerance`, and the `place` at which the actions of the robot serve the goal. Returns the goal as
/// an open goal; none if it has no tolerance.
std::optional<core::OpenGoal> parse_tolerance(const JsonReader& json, const core::Goal& pose,
                                              const WorldFrame& frame) {
  const JsonReader member = json.find("tolerance");
  const double tolerance = member.number(kGoalTolerance).value_or(0.0);
  const JsonReader place = json.find("place");
  if (member && json.find("any_of")) {
    member.fault(fault::kDuplicate,
                 "The goal has any_of, whose poses are all that it may be served at; leave tolerance out.");
    return std::nullopt;
  }
  if (tolerance <= 0.0) {
    if (place) place.fault(fault::kOutOfRange, "The goal has no tolerance; leave place out.");
    return std::nullopt;
  }
  core::OpenGoal open{.poses = {{pose.position, pose.theta}}, .tolerance = tolerance, .own = pose.position};
  parse_place(place, frame, open);
  open.is_told = static_cast<bool>(place);
  return open;
}

/// Reads what changes with the service.
void parse_load(const JsonReader& json, core::Goal& goal) {
  goal.radius_after = json.find("radius_after").number(kLength);
  goal.linear_speed_after = json.find("linear_speed_after").number(kLinearSpeed);
  goal.linear_acceleration_after = json.find("linear_acceleration_after").number(kLinearAcceleration);
  goal.linear_deceleration_after = json.find("linear_deceleration_after").number(kLinearAcceleration);
}

/// Adds the goal if it is valid.
void add_goal(const JsonReader& member, const WorldFrame& frame, Quota& quota, ParsedGoals& read) {
  const std::size_t before = member.fault_count();
  const JsonReader json = member.object(kGoalMembers);
  const JsonReader any_of = json.find("any_of");
  std::vector<core::Alternative> poses;
  std::optional<core::Goal> pose;
  if (any_of) {
    poses = parse_any_of(json, any_of, frame, quota);
    if (!poses.empty()) pose = core::Goal{poses.front().position, poses.front().theta};
  } else {
    pose = parse_pose(json, frame);
  }
  const auto choice = parse_choice(json, poses.size());
  if (choice) pose = core::Goal{poses[*choice].position, poses[*choice].theta};
  std::optional<core::OpenGoal> near = parse_tolerance(json, pose.value_or(core::Goal()), frame);
  if (near && pose) pose->position = near->choice().position;
  core::Goal goal = pose.value_or(core::Goal());
  const auto service = json.find("service").number(kDuration);
  const auto not_before = json.find("not_before").number(kDuration);
  if (service && *service > 0.0) goal.service = std::max(*service, core::kShortestWait);
  goal.not_before = not_before.value_or(0.0);
  const JsonReader due = json.find("due");
  goal.due = due.number(kDue);
  if (goal.due) check_due(due, *goal.due, goal.not_before);
  parse_load(json, goal);
  GoalTexts texts{parse_metadata(json), parse_goal_actions(json),
                  poses.empty() ? std::string() : text_of_any_of(any_of)};
  const bool has_texts = !texts.empty();
  if (!pose || member.fault_count() != before) return;
  if (service || not_before || goal.due || goal.changes_load() || has_texts || near) read.lists_visits = true;
  if (has_texts) {
    read.texts.resize(read.goals.size());
    read.texts.push_back(std::move(texts));
  }
  if (!poses.empty()) {
    read.open.push_back({.goal = read.goals.size(),
                         .poses = std::move(poses),
                         .chosen = choice.value_or(0),
                         .is_told = choice.has_value()});
  }
  if (near) {
    near->goal = read.goals.size();
    read.open.push_back(std::move(*near));
  }
  read.goals.push_back(goal);
  read.places.push_back(member);
}

}  // namespace

void parse_place(const JsonReader& member, const WorldFrame& frame, core::OpenGoal& open) {
  constexpr std::array<std::string_view, 2> kMembers{"x", "y"};
  if (!member || member.is_null()) return;
  const auto place = parse_pose(member.object(kMembers), frame);
  if (!place || core::take_place(open, place->position)) return;
  member.fault(fault::kOutOfRange, [&] {
    return "The place is " + number_text((place->position - open.own).norm()) +
           " m from the goal, whose tolerance is " + number_text(open.tolerance) + " m.";
  });
}

std::optional<core::Goal> parse_pose(const JsonReader& pose, const WorldFrame& frame) {
  const std::size_t before = pose.fault_count();
  const auto x = pose.require("x").number(kCoordinate);
  const auto y = pose.require("y").number(kCoordinate);
  const auto theta = pose.find("theta").number(kAnyAngle);
  if (!x || !y || pose.fault_count() != before) return std::nullopt;
  core::Goal read;
  read.position = frame.to_map({*x, *y});
  if (theta) read.theta = core::normalize_angle(*theta);
  return read;
}

std::optional<core::Goal> parse_plain_pose(const JsonReader& pose, const WorldFrame& frame) {
  constexpr std::array<std::string_view, 3> kMembers{"x", "y", "theta"};
  return parse_pose(pose.object(kMembers), frame);
}

ParsedGoals parse_goals(const JsonReader& robot, const WorldFrame& frame, Quota& quota) {
  ParsedGoals read;
  const JsonReader single = robot.find("goal");
  const JsonReader several = robot.find("goals");
  if (single && several) {
    several.fault(fault::kDuplicate,
                  "The robot has both goal and goals; give one of them: goal is short for a list of one.");
  }
  if (single) add_goal(single, frame, quota, read);
  const JsonReader list = several.array();
  if (single || !list || !quota.take(list)) return read;
  read.lists_visits = true;
  for (const JsonReader item : list.items()) add_goal(item, frame, quota, read);
  return read;
}

void check_loads(const std::vector<JsonReader>& goals, const core::Robot& robot) {
  if (robot.linear_inertia().is_limited) return;
  // Bounded: the goals that were read.
  for (const JsonReader& goal : goals) {
    for (const std::string_view name : {"linear_acceleration_after", "linear_deceleration_after"}) {
      const JsonReader member = goal.find(name);
      if (!member) continue;
      member.fault(fault::kOutOfRange, [&] {
        return "The robot has no linear_acceleration, so it changes its speed at once, and a load cannot "
               "change that; give it linear_acceleration, or leave " +
               std::string(name) + " out.";
      });
    }
  }
}

namespace {

// What `robot_defaults` can give as well.
constexpr std::array<std::string_view, 11> kTraits{"radius",
                                                   "linear_speed",
                                                   "angular_speed",
                                                   "linear_acceleration",
                                                   "linear_deceleration",
                                                   "angular_acceleration",
                                                   "may_reverse",
                                                   "vicinity",
                                                   "execution_margin",
                                                   "stop_distance",
                                                   "body_radius"};

/// Returns the names of `id`, all traits, and then these members.
template <std::size_t count>
constexpr std::array<std::string_view, 1 + kTraits.size() + count> members_of_robot(
    const std::array<std::string_view, count>& others) {
  std::array<std::string_view, 1 + kTraits.size() + count> members{"id"};
  std::copy(kTraits.begin(), kTraits.end(), members.begin() + 1);
  std::copy(others.begin(), others.end(), members.begin() + 1 + kTraits.size());
  return members;
}

constexpr auto kRobotMembers = members_of_robot(std::array<std::string_view, 9>{
    "start", "goal", "goals", "goal_age", "weight", "idle", "committed", "previous", "metadata"});
constexpr auto kLoneRobotMembers = members_of_robot(std::array<std::string_view, 1>{"metadata"});
constexpr std::array<std::string_view, 4> kStartMembers{"x", "y", "theta", "speed"};
constexpr std::array<std::string_view, 3> kIdle{"stay", "yield", "return"};  // see Idle

/// A number that `robot_defaults` can give as well.
struct Trait {
  bool given = false;
  std::optional<double> value;  // its value if it is valid
};

struct Traits {
  Trait radius;
  Trait linear_speed;
  Trait angular_speed;
  Trait linear_acceleration;
  Trait linear_deceleration;
  Trait angular_acceleration;
  Trait vicinity;
  Trait execution_margin;
  Trait stop_distance;
  std::optional<bool> may_reverse;
  std::optional<double> body_radius;
};

struct TraitRow {
  std::string_view name;
  Range range;
  Trait Traits::*field;
  bool required;
};

constexpr std::array<TraitRow, 9> kTraitTable{{
    {.name = "radius", .range = kLength, .field = &Traits::radius, .required = true},
    {.name = "linear_speed", .range = kLinearSpeed, .field = &Traits::linear_speed, .required = true},
    {.name = "angular_speed", .range = kAngularSpeed, .field = &Traits::angular_speed, .required = true},
    {.name = "linear_acceleration",
     .range = kLinearAcceleration,
     .field = &Traits::linear_acceleration,
     .required = false},
    {.name = "linear_deceleration",
     .range = kLinearAcceleration,
     .field = &Traits::linear_deceleration,
     .required = false},
    {.name = "angular_acceleration",
     .range = kAngularAcceleration,
     .field = &Traits::angular_acceleration,
     .required = false},
    {.name = "vicinity", .range = kLengthOrZero, .field = &Traits::vicinity, .required = false},
    {.name = "execution_margin",
     .range = kLengthOrZero,
     .field = &Traits::execution_margin,
     .required = false},
    {.name = "stop_distance", .range = kLengthOrZero, .field = &Traits::stop_distance, .required = false},
}};

Traits parse_traits(const JsonReader& json) {
  Traits traits;
  for (const TraitRow& row : kTraitTable) {
    const JsonReader member = json.find(row.name);
    traits.*row.field = {.given = static_cast<bool>(member), .value = member.number(row.range)};
  }
  traits.may_reverse = json.find("may_reverse").boolean();
  traits.body_radius = json.find("body_radius").number(kLength);
  return traits;
}

/// Returns a robot's traits, completed by the defaults. A trait that neither gives is missing; an invalid
/// default is a fault already.
Traits parse_traits(const JsonReader& robot, const Traits& defaults) {
  Traits traits = parse_traits(robot);
  if (!traits.may_reverse) traits.may_reverse = defaults.may_reverse;
  if (!traits.body_radius) traits.body_radius = defaults.body_radius;
  for (const TraitRow& row : kTraitTable) {
    Trait& trait = traits.*row.field;
    const Trait& standard = defaults.*row.field;
    if (trait.given) continue;
    if (standard.given) {
      trait.value = standard.value;
    } else if (row.required) {
      robot.require(row.name, ", here and in robot_defaults; give it in one of them");
    }
  }
  return traits;
}

/// What the core has to know of the traits; what is missing is a fault already.
void take_traits(const Traits& traits, core::Robot& robot) {
  robot.radius = traits.radius.value.value_or(1.0);
  robot.linear_speed = traits.linear_speed.value.value_or(1.0);
  robot.angular_speed = traits.angular_speed.value.value_or(1.0);
  robot.linear_acceleration = traits.linear_acceleration.value.value_or(core::Robot::kNoLimit);
  robot.linear_deceleration = traits.linear_deceleration.value.value_or(robot.linear_acceleration);
  robot.angular_acceleration = traits.angular_acceleration.value.value_or(core::Robot::kNoLimit);
  robot.vicinity = traits.vicinity.value.value_or(0.0);
  robot.may_reverse = traits.may_reverse.value_or(false);
}

/// Reads one robot after the other; counts their goals and actions.
class RobotReader {
 public:
  RobotReader(const Traits& defaults, const WorldFrame& frame, const Limits& limits)
      : defaults_(defaults),
        frame_(frame),
        goals_(limits.max_goals, "goals"),
        actions_(limits.max_actions, "actions in committed and previous") {}

  ParsedRobot read(const JsonReader& item) {
    const JsonReader json = item.object(kRobotMembers);
    ParsedRobot read;
    if (!json) return read;
    core::Robot& robot = read.robot;
    robot.id = json.require("id").name().value_or("");
    const Traits traits = parse_traits(json, defaults_);
    take_traits(traits, robot);
    read.execution_margin = traits.execution_margin.value;
    read.stop_distance = traits.stop_distance.value.value_or(0.0);
    read.body_radius = traits.body_radius;
    robot.goal_age = json.find("goal_age").number(kDuration).value_or(0.0);
    robot.weight = json.find("weight").number(kWeight).value_or(1.0);
    read.metadata = parse_metadata(json);
    ActionsOwner owner{.robot = robot,
                       .start = std::nullopt,
                       .linear_speed = traits.linear_speed.value,
                       .angular_speed = traits.angular_speed.value,
                       .may_reverse = robot.may_reverse,
                       .open = &read.open};
    read.start = json.require("start", "; give {\"x\", \"y\"} and optionally \"theta\"");
    if (const auto start = parse_pose(read.start.object(kStartMembers), frame_)) {
      robot.start = {start->position, start->theta.value_or(0.0)};
      owner.start = robot.start;
    }
    read.placed = owner.start && traits.radius.value;
    read_goals(json, read);
    // With its goals, the last of which its actions may serve; without any, where they end.
    read_idle(json.find("idle"), read);
    if (read.robot.goal) make_way(read);
    read_actions(json, owner, read);
    check_speed(read);
    if (!read.robot.goal) make_way(read);
    return read;
  }

 private:
  void read_goals(const JsonReader& json, ParsedRobot& read) {
    ParsedGoals goals = parse_goals(json, frame_, goals_);
    check_loads(goals.places, read.robot);
    read.goals = std::move(goals.places);
    read.lists_visits = goals.lists_visits;
    read.goal_texts = std::move(goals.texts);
    read.open = std::move(goals.open);
    if (goals.goals.empty()) return;
    read.robot.goal = goals.goals.back();
    goals.goals.pop_back();
    read.robot.via = std::move(goals.goals);
  }

  static void read_idle(const JsonReader& json, ParsedRobot& read) {
    if (const auto word = json.word(kIdle)) read.idle = static_cast<Idle>(*word);
  }

  /// A robot that comes back without a goal of its own has one where its plan begins.
  static void make_way(ParsedRobot& read) {
    core::Robot& robot = read.robot;
    if (read.idle == Idle::yield) robot.let_yield();
    if (read.idle != Idle::come_back || robot.goal) return;
    robot.goal = core::Goal{robot.committed_end().position, robot.committed_end().theta};
    read.goals = {read.start};
    read.returns_to_start = true;
  }

  void read_actions(const JsonReader& json, const ActionsOwner& owner, ParsedRobot& read) {
    read.committed = json.find("committed");
    if (auto committed = parse(read.committed, owner)) {
      read.robot.committed = std::move(committed->actions);
      read.received_committed = std::move(committed->received);
    }
    ActionsOwner of_previous = owner;
    of_previous.measured = read.robot.committed.size();
    if (auto previous = parse(json.find("previous"), of_previous)) {
      read.robot.previous = std::move(previous->actions);
      read.received_previous = std::move(previous->received);
    }
  }

  /// A robot whose acceleration is limited is under way only if it is committed to go on so.
  static void check_speed(const ParsedRobot& read) {
    const JsonReader member = read.start.find("speed");
    const auto speed = member.number(kMeasuredSpeed);
    const core::Robot& robot = read.robot;
    if (!speed || !robot.linear_inertia().is_limited) return;
    const bool is_at_fault = robot.committed.empty() && read.committed && read.committed.array().size() > 0;
    const bool is_measured = !robot.committed.empty() && !robot.committed.front().profile &&
                             robot.committed.front().type == core::Action::Type::translate;
    if (is_at_fault || is_measured) return;
    const double begins = robot.committed_speed();
    if (std::abs(*speed - begins) <= core::kContactTolerance) return;
    member.fault(fault::kProfile, [&] {
      return "The robot starts at a speed of " + number_text(*speed) + ", but " +
             (begins == 0.0 ? "its committed actions do not begin with a translation at speed"
                            : "its committed actions begin at " + number_text(begins)) +
             "; give the motion that it cannot leave out as committed, as /v1/advance does, from this speed "
             "on.";
    });
  }

  std::optional<ParsedActions> parse(const JsonReader& member, const ActionsOwner& owner) {
    const JsonReader list = member.array();
    if (!list || !actions_.take(list)) return std::nullopt;
    return parse_actions(list, owner, frame_);
  }

  const Traits& defaults_;
  const WorldFrame& frame_;
  Quota goals_;
  Quota actions_;
};

}  // namespace

std::vector<ParsedRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                      const WorldFrame& frame, const Limits& limits, UniqueIds& ids) {
  if (!robots) return {};
  const Traits common = parse_traits(defaults.object(kTraits));
  const JsonReader items = robots.array();
  if (!items) return {};
  if (items.size() == 0) items.fault(fault::kEmpty, "robots must contain at least one robot.");
  if (items.size() > limits.max_robots) {
    items.fault(fault::kOutOfRange, "There are " + std::to_string(items.size()) +
                                        " robots; this service accepts at most " +
                                        std::to_string(limits.max_robots) + ".");
    return {};
  }
  std::vector<ParsedRobot> read;
  read.reserve(items.size());
  RobotReader reader(common, frame, limits);
  for (const JsonReader item : items.items()) {
    read.push_back(reader.read(item));
    ids.check(UniqueIds::Kind::robot, read.back().robot.id, read.size() - 1, item);
  }
  return read;
}

std::optional<core::Robot> parse_lone_robot(const JsonReader& robot) {
  const std::size_t before = robot.fault_count();
  const JsonReader json = robot.object(kLoneRobotMembers);
  if (!json) return std::nullopt;
  core::Robot read;
  read.id = json.find("id").name().value_or("");
  const Traits traits = parse_traits(json);
  for (const TraitRow& row : kTraitTable) {
    if (row.required) json.require(row.name);
  }
  take_traits(traits, read);
  parse_metadata(json);
  if (robot.fault_count() != before) return std::nullopt;
  return read;
}

RobotNames::RobotNames(const std::vector<core::Robot>& robots, std::string_view place) : place_(place) {
  for (std::size_t index = 0; index < robots.size(); ++index) robots_.emplace(robots[index].id, index);
}

RobotNames::RobotNames(const std::vector<ParsedRobot>& robots, std::string_view place) : place_(place) {
  for (std::size_t index = 0; index < robots.size(); ++index) robots_.emplace(robots[index].robot.id, index);
}

std::optional<std::size_t> RobotNames::find(const JsonReader& id) const {
  const auto name = id.name();
  if (!name) return std::nullopt;
  if (const auto index = index_of(*name)) return index;
  id.fault(fault::kUnknownRobot,
           [&] { return "There is no robot " + in_quotes(*name) + " in " + place_ + "."; });
  return std::nullopt;
}

std::optional<std::size_t> RobotNames::index_of(std::string_view id) const {
  const auto found = robots_.find(std::string(id));
  return found != robots_.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace fleetplan::api
