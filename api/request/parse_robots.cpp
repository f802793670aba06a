#include "api/request/parse_robots.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/request/motion/parse_actions.h"
#include "api/request/motion/parse_goals.h"
#include "api/request/motion/quota.h"
#include "api/request/parse_metadata.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 14> kRobotMembers{
    "id",          "radius", "linear_speed", "angular_speed", "vicinity",  "execution_margin", "may_reverse",
    "body_radius", "start",  "goal",         "goals",         "committed", "previous",         "metadata"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};

// The members that `robot_defaults` can give as well.
constexpr std::array<std::string_view, 5> kTraits{"radius", "linear_speed", "angular_speed", "vicinity",
                                                  "execution_margin"};
constexpr std::array<Range, 5> kTraitRanges{kLength, kLinearSpeed, kAngularSpeed, kLengthOrZero,
                                            kLengthOrZero};
constexpr std::size_t kRequiredTraits = 3;  // the first ones
constexpr std::array<std::string_view, 7> kDefaults{
    "radius", "linear_speed", "angular_speed", "vicinity", "execution_margin", "may_reverse", "body_radius"};

/// Which traits are given, and the valid ones among them.
struct Traits {
  std::array<bool, kTraits.size()> given{};
  std::array<std::optional<double>, kTraits.size()> values;
  std::optional<bool> may_reverse;
  std::optional<double> body_radius;
};

Traits parse_traits(const JsonReader& json) {
  Traits traits;
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    const JsonReader member = json.find(kTraits[trait]);
    traits.given[trait] = static_cast<bool>(member);
    traits.values[trait] = member.number(kTraitRanges[trait]);
  }
  traits.may_reverse = json.find("may_reverse").boolean();
  traits.body_radius = json.find("body_radius").number(kLength);
  return traits;
}

/// A robot's traits, completed by the defaults. What neither gives is missing; an invalid default is a fault
/// already.
Traits parse_traits(const JsonReader& robot, const Traits& defaults) {
  Traits traits = parse_traits(robot);
  if (!traits.may_reverse) traits.may_reverse = defaults.may_reverse;
  if (!traits.body_radius) traits.body_radius = defaults.body_radius;
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    if (traits.given[trait]) continue;
    if (defaults.given[trait]) {
      traits.values[trait] = defaults.values[trait];
    } else if (trait < kRequiredTraits) {
      robot.require(kTraits[trait], ", here and in robot_defaults; give it in one of them");
    }
  }
  return traits;
}

/// Reads one robot after the other; counts their goals and actions.
class RobotReader {
 public:
  RobotReader(const Traits& defaults, const WorldFrame& frame, const Limits& limits)
      : defaults_(defaults),
        frame_(frame),
        goals_(limits.max_goals, "goals"),
        actions_(limits.max_actions, "actions in committed and previous") {}

  ReadRobot read(const JsonReader& item) {
    const JsonReader json = item.object(kRobotMembers);
    ReadRobot read;
    if (!json) return read;
    core::Robot& robot = read.robot;
    robot.id = json.require("id").name().value_or("");
    const Traits traits = parse_traits(json, defaults_);
    robot.radius = traits.values[0].value_or(1.0);
    robot.linear_speed = traits.values[1].value_or(1.0);
    robot.angular_speed = traits.values[2].value_or(1.0);
    robot.vicinity = traits.values[3].value_or(0.0);
    read.execution_margin = traits.values[4];
    robot.may_reverse = traits.may_reverse.value_or(false);
    read.body_radius = traits.body_radius;
    read.metadata = parse_metadata(json);
    ActionsOwner owner{std::nullopt, traits.values[1], traits.values[2], robot.may_reverse};
    read.start = json.require("start", "; give {\"x\", \"y\"} and optionally \"theta\"");
    if (const auto start = parse_pose(read.start.object(kPoseMembers), frame_)) {
      robot.start = {start->position, start->theta.value_or(0.0)};
      owner.start = robot.start;
    }
    read.placed = owner.start && traits.values[0];
    read_goals(json, read);
    read_actions(json, owner, read);
    return read;
  }

 private:
  void read_goals(const JsonReader& json, ReadRobot& read) {
    ReadGoals goals = parse_goals(json, frame_, goals_);
    read.goals = std::move(goals.places);
    read.lists_visits = goals.lists_visits;
    read.goal_metadata = std::move(goals.metadata);
    if (goals.goals.empty()) return;
    read.robot.goal = goals.goals.back();
    goals.goals.pop_back();
    read.robot.via = std::move(goals.goals);
  }

  void read_actions(const JsonReader& json, const ActionsOwner& owner, ReadRobot& read) {
    read.committed = json.find("committed");
    if (auto committed = parse(read.committed, owner)) {
      read.robot.committed = std::move(committed->actions);
      read.received_committed = std::move(committed->received);
    }
    if (auto previous = parse(json.find("previous"), owner)) {
      read.robot.previous = std::move(previous->actions);
      read.received_previous = std::move(previous->received);
    }
  }

  std::optional<ReadActions> parse(const JsonReader& member, const ActionsOwner& owner) {
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

std::vector<ReadRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                    const WorldFrame& frame, const Limits& limits, UniqueIds& ids) {
  if (!robots) return {};
  const Traits common = parse_traits(defaults.object(kDefaults));
  const JsonReader items = robots.array();
  if (!items) return {};
  if (items.size() == 0) items.fault(fault::kEmpty, "robots must contain at least one robot.");
  if (items.size() > limits.max_robots) {
    items.fault(fault::kOutOfRange, "There are " + std::to_string(items.size()) +
                                        " robots; this service accepts at most " +
                                        std::to_string(limits.max_robots) + ".");
    return {};
  }
  std::vector<ReadRobot> read;
  read.reserve(items.size());
  RobotReader reader(common, frame, limits);
  for (const JsonReader item : items.items()) {
    read.push_back(reader.read(item));
    ids.check(UniqueIds::Kind::robot, read.back().robot.id, read.size() - 1, item);
  }
  return read;
}

}  // namespace fleetplan::api
