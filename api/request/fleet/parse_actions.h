#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/shared_members.h"
#include "core/geometry/tolerance.h"
#include "core/model/action.h"
#include "core/model/loads.h"
#include "core/model/open_goal.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Reads one action, in the world and with its headings as given. Values with a fault are 0. A profile has
/// only its speeds until the robot is known.
core::Action parse_action(const JsonReader& item, const Range& times);

/// Returns the action in the map frame, with normalised headings.
core::Action to_map(const core::Action& world, const WorldFrame& frame);

/// The robot that executes actions, as far as it is known. Parts that could not be read are not compared.
struct ActionsOwner {
  const core::Robot& robot;             // its accelerations and its goals are known
  std::optional<core::Pose> start;      // in the map frame
  std::optional<double> linear_speed;   // metres per second
  std::optional<double> angular_speed;  // radians per second
  std::optional<bool> may_reverse = {};
  /// The number of first actions that may be measured motion, which has no profiles.
  std::size_t measured = std::numeric_limits<std::size_t>::max();
  const std::vector<core::OpenGoal>* open = nullptr;  // its goals that are open; null: none
};

/// The actions of a robot from t = 0 in its start. Each begins exactly when and where the previous action
/// ends.
struct ParsedActions {
  std::vector<core::Action> actions;  // in the map frame
  ReceivedMotion received;
};

/// Reads `committed` or `previous` of a robot. Actions that are not contiguous in time and space, contradict
/// their types or are faster than the robot are faults. Then no actions are returned.
std::optional<ParsedActions> parse_actions(const JsonReader& list, const ActionsOwner& owner,
                                           const WorldFrame& frame);

/// Joins the actions of a robot one after the other, in the map frame, and reports actions that do not fit.
/// Differences up to core::kContactTolerance (metres, seconds, radians) are accepted and removed, so that the
/// core gets actions without gaps.
class ActionChain {
 public:
  explicit ActionChain(const ActionsOwner& owner);

  /// Returns the action as it continues the previous action. Faults are reported at `item`.
  core::Action append(core::Action action, const JsonReader& item);
  /// Skips an action that could not be read. The actions before and after it are not compared.
  void skip();
  bool ends_at_rest() const { return speed_.value_or(0.0) <= core::kContactTolerance; }

 private:
  void check_times(const core::Action& action, const JsonReader& item) const;
  void check_begin(const core::Action& action, const JsonReader& item) const;
  void check_type(const core::Action& action, const JsonReader& item) const;
  void check_speed(const core::Action& action, const JsonReader& item) const;
  /// `off`: how far a translation leads off the line of its heading, metres.
  void check_direction(const core::Action& action, double off, const JsonReader& item) const;
  void check_profile(const core::Action& action, const JsonReader& item) const;
  void check_has_profile(const core::Action& action, const JsonReader& item) const;
  void check_speeds_meet(const core::Action& action, const JsonReader& item) const;
  void check_reverse(const core::Action& action, const JsonReader& item) const;
  core::Action joined(core::Action action) const;
  core::Load load() const { return loads_ ? loads_->load() : core::first_load(robot_); }
  /// The greatest speed of this action, metres (or radians) per second; none: unknown.
  std::optional<double> greatest_speed(const core::Action& action) const;
  std::string name() const;

  const core::Robot& robot_;
  std::optional<double> linear_speed_;
  std::optional<double> angular_speed_;
  std::optional<bool> may_reverse_;
  std::size_t measured_;
  std::optional<double> now_ = 0.0;  // seconds; none: unknown, as is the pose
  std::optional<core::Pose> pose_;
  std::optional<double> speed_;                  // at the end of the action before; none: unknown
  std::size_t count_ = 0;                        // number of the actions before
  std::optional<core::OpenLoadOnTheWay> loads_;  // of a robot that changes its load
};

}  // namespace fleetplan::api
