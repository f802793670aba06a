#pragma once

// Robots can pick up loads or put them down at their goals (Goal::radius_after and its companions). A load
// changes the disk that others must avoid, and how fast the robot drives.

#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "core/geometry/segment.h"
#include "core/geometry/speed_profile.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/served.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// The properties of a robot that a load changes.
struct Load {
  double radius = 0.0;               // metres
  double linear_speed = 0.0;         // metres per second
  double linear_acceleration = 0.0;  // metres per second squared
  double linear_deceleration = 0.0;  // metres per second squared

  bool operator==(const Load&) const = default;
  bool operator<(const Load& other) const {
    return std::tie(radius, linear_speed, linear_acceleration, linear_deceleration) <
           std::tie(other.radius, other.linear_speed, other.linear_acceleration, other.linear_deceleration);
  }

  Inertia linear_inertia() const { return {1.0 / linear_acceleration, 1.0 / linear_deceleration}; }
};

/// Returns the load of a robot that has served no goal, as the request gives it.
Load first_load(const Robot& robot);
/// Returns the load after the service at a goal.
Load load_after(const Load& before, const Goal& goal);
/// Returns the loads by the number of goals served. There is one more load than goals.
std::vector<Load> loads_of(const Robot& robot);

/// The load of a robot that executes its actions one after the other. They are contiguous from t = 0 in its
/// start.
class LoadOnTheWay {
 public:
  /// `robot` outlives this object.
  explicit LoadOnTheWay(const Robot& robot) : loads_(loads_of(robot)), served_(robot) {}

  /// The load with which it executes the next action.
  const Load& load() const { return loads_[served_.count()]; }
  /// The number of goals that it has served.
  std::size_t served() const { return served_.count(); }
  void execute(const Action& action) { served_.execute(action); }

 private:
  std::vector<Load> loads_;  // by the number of goals served
  GoalsOnTheWay served_;
};

/// Returns the load with which a robot executes one of its actions. They are contiguous from t = 0 in its
/// start.
Load load_during(const Robot& robot, std::span<const Action> actions, std::size_t index);
/// Returns how many of these actions a robot can execute with the loads that it has during them. It stops
/// before the first action that is too fast for a load picked up on the way; it stands still there. All
/// actions, if none is too fast.
std::size_t count_of_executable(const Robot& robot, std::span<const Action> actions);
/// Sets the load that the robot has.
void set_load(Robot& robot, const Load& load);
/// Whether the loads of the robot differ.
bool changes_load(const Robot& robot);

/// Adds the robot's accelerations to the profiles of its actions, which are contiguous from t = 0 in its
/// start.
void set_inertia(std::vector<Action>& actions, const Robot& robot);
/// Adds the accelerations with this load to the profile of an action.
void set_inertia(Action& action, const Robot& robot, const Load& load);

/// Returns the robot's radii, metres, by the number of goals served.
std::vector<double> radii_of(const Robot& robot);
/// Whether these radii differ.
bool changes_radius(const Robot& robot);
/// The largest of these radii, and the last one.
double largest_radius(const Robot& robot);
double last_radius(const Robot& robot);

}  // namespace fleetplan::core
