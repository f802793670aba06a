#pragma once

// The robots of a request, with their goals, and their names.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/shared_members.h"
#include "core/model/open_goal.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// The valid goals of a robot, in their order, in the map frame.
struct ParsedGoals {
  std::vector<core::Goal> goals;
  std::vector<JsonReader> places;  // place of each goal
  /// Whether they are given as a list, or with a service, a radius or metadata. Then the answer tells when
  /// each is visited.
  bool lists_visits = false;
  std::vector<GoalTexts> texts;  // by goal; shorter if the last ones have none
  /// The goals that are served at one of several poses or near their own pose, ascending. In `goals`, they
  /// have the pose that is told, or the first one.
  std::vector<core::OpenGoal> open;
};

/// Reads `x`, `y` and `theta` (optional) of a pose whose members are known. Returns none if any of them has a
/// fault.
std::optional<core::Goal> parse_pose(const JsonReader& pose, const WorldFrame& frame);

/// Reads a pose that has no other members.
std::optional<core::Goal> parse_plain_pose(const JsonReader& pose, const WorldFrame& frame);

/// Reads `place` of a goal with a tolerance, and sets it. `place` may be absent or null.
void parse_place(const JsonReader& member, const WorldFrame& frame, core::OpenGoal& open);

/// Reads `goal` or `goals` of a robot. Without both, or with an empty list, there are no goals. `quota`
/// limits the goals of the request, and the poses of `any_of`.
ParsedGoals parse_goals(const JsonReader& robot, const WorldFrame& frame, Quota& quota);

/// Reports loads that change accelerations, unless the robot has accelerations. `goals`: the places of the
/// goals of the robot.
void check_loads(const std::vector<JsonReader>& goals, const core::Robot& robot);

/// What a robot does without a goal, or after its last goal.
enum class Idle : std::uint8_t { stay, yield, come_back };

/// A robot as far as it could be read. `placed`: whether its radius and start are valid. Then it can be
/// compared with the map and the other robots, in spite of faults elsewhere.
struct ParsedRobot {
  core::Robot robot;  // in the map frame; goals and actions only if they are valid
  bool placed = false;
  JsonReader start;
  std::vector<JsonReader> goals;  // place of each goal of the robot
  JsonReader committed;
  ReceivedMotion received_committed;
  ReceivedMotion received_previous;
  bool lists_visits = false;          // see ParsedGoals
  std::vector<GoalTexts> goal_texts;  // see ParsedGoals
  std::vector<core::OpenGoal> open;   // see ParsedGoals; the robot's goals have the choices
  /// The first goal that its plan does not serve, if the visits of the plan say so.
  std::optional<std::size_t> first_unserved = {};
  std::string metadata;                    // see parse_metadata
  std::optional<double> execution_margin;  // metres
  double stop_distance = 0.0;              // metres that it drives until it stands, see /v1/advance
  std::optional<double> body_radius = {};  // metres, the robot's own radius, if it is planned with another
                                           // radius
  /// Set if it is given. The goals of the robot say what it means for the plan.
  std::optional<Idle> idle = {};
  bool returns_to_start = false;  // its goal is that it comes back, and not given
};

/// Reads `robots` and `robot_defaults` (may be absent). There must be at least one robot, and not more
/// robots, goals and actions than the limits allow. `ids` receives the ids of the robots.
std::vector<ParsedRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                      const WorldFrame& frame, const Limits& limits, UniqueIds& ids);

/// Reads the robot of a request about one robot: its traits, but no position. `id` is optional. Returns none
/// if any trait has a fault.
std::optional<core::Robot> parse_lone_robot(const JsonReader& robot);

/// The robots of a request by their ids.
class RobotNames {
 public:
  /// Indexes robots. `place`: where a request lists them, for messages.
  explicit RobotNames(const std::vector<core::Robot>& robots, std::string_view place = "robots");
  explicit RobotNames(const std::vector<ParsedRobot>& robots, std::string_view place = "robots");

  /// Returns the index of the robot whose id is the value. Anything else is a fault.
  std::optional<std::size_t> find(const JsonReader& id) const;
  /// Returns the index of the robot of this id, if there is one.
  std::optional<std::size_t> index_of(std::string_view id) const;

 private:
  std::string place_;
  std::unordered_map<std::string, std::size_t> robots_;
};

}  // namespace fleetplan::api
