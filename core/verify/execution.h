#pragma once

// How robots execute their plans, valid or not. It tells where each robot is at every time from 0 on, and
// when its motion becomes the planner's own. A robot whose radius changes is a sequence of disks. Obstacles
// move in the same way.

#include <cstddef>
#include <limits>
#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/verify/check_rules.h"

namespace fleetplan::core {

/// A time interval in which a robot's centre stands, or moves straight at constant acceleration, usually 0.
/// Map frame, metres, seconds.
struct Leg {
  double t_begin = 0.0;
  double t_end = 0.0;  // infinity for the final rest; t_begin for a leg that takes no time
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
  /// Half the acceleration times the square of the duration. At a share f of the time, the centre is f (1 -
  /// f) bend behind its position at constant speed.
  Position bend{0.0, 0.0};
};

/// Returns the position of the centre at `t`: exactly `from` up to t_begin, exactly `to` from t_end on.
Position position_at(const Leg& leg, double t);

/// Returns the part of a leg from `begin` to `end`. Both are within the leg, and may be the same.
Leg part_of(const Leg& leg, double begin, double end);

/// The properties of a robot that a load changes, by the checker's own reading of the request.
struct CarriedLoad {
  double radius = 0.0;               // metres
  double linear_speed = 0.0;         // metres per second
  double linear_acceleration = 0.0;  // metres per second squared
  double linear_deceleration = 0.0;  // metres per second squared
};

/// The loads of a robot that executes a plan (null: its commitment). Each goal is served as early as
/// possible, by an uninterrupted rest in its pose after the goals before it.
///
/// The rest at the end of the plan, after the commitment, serves the last goal. A robot without a plan does
/// not serve it. A robot with neither a plan nor a commitment serves no goal.
class CarriedLoads {
 public:
  /// A load that is carried from a time on, seconds.
  struct Step {
    double t = 0.0;
    CarriedLoad load;
  };

  CarriedLoads(const Robot& robot, const RobotPlan* plan, const Tolerance& tolerance);

  /// Ascending, the first one from t = 0 on.
  const std::vector<Step>& steps() const { return steps_; }
  /// During an action that begins at `t`, within the tolerance.
  const CarriedLoad& at(double t) const;

 private:
  std::vector<Step> steps_;
  double seconds_;  // tolerance
};

/// Returns the legs of a robot from t = 0 to infinity, in order. Each begins when the previous leg ends.
/// Without a plan (null), the robot executes its committed actions, unless it is invalid. Without actions, it
/// stays at its start; otherwise, it rests where its last action ends.
///
/// Invalid plans are executed as follows:
///
/// - In a gap between actions, the robot stands.
/// - If an action begins before the previous action has ended (or before 0), the overlapping part is omitted.
/// - An action that ends before it begins takes no time.
///
/// Every number of the plan (and of the committed actions) must be finite.
std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan, const CarriedLoads& loads);
/// Executes with the loads of a robot whose times may be rounded by up to kMaxTolerance.
std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan);

/// Returns the legs of an obstacle from when it appears until it vanishes, or to infinity. An obstacle that
/// appears only for an instant has a leg that takes no time.
std::vector<Leg> legs_of(const MovingObstacle& obstacle);

/// When the motion of a robot passes from its commitment to the planner, seconds.
struct Handover {
  double committed_until = 0.0;  // the end of its commitment
  /// The begin and the end of the first translation after the commitment; infinity if there is none.
  double leaves = std::numeric_limits<double>::infinity();
  double first_move_ends = std::numeric_limits<double>::infinity();

  /// Whether a leg that ends at `t_end` belongs to the commitment. And whether a leg that begins at `t_begin`
  /// follows the stay at the commitment's end.
  bool commits(double t_end) const { return t_end <= committed_until; }
  bool plans(double t_begin) const { return t_begin >= leaves; }
};

/// Returns when the motion of a robot passes to the planner. `plan` is null for a robot without a plan. Every
/// number must be finite.
Handover handover_of(const Robot& robot, const RobotPlan* plan);

/// A disk of constant radius on its way.
struct SizedLegs {
  double radius = 0.0;  // metres
  std::vector<Leg> legs;
};

/// Returns the disks of a robot, in order: the first from t = 0, each from the end of the disk before, the
/// last to infinity. `legs` are the result of execute() with these loads.
std::vector<SizedLegs> sized_legs_of(const CarriedLoads& loads, std::vector<Leg> legs);

/// Robots that execute their plans. All lists are in the same order. A position in them is not the index of
/// the robot. A robot whose radius changes has several positions, one after the other, each for its own time
/// (see sized_legs_of).
struct ExecutedFleet {
  std::vector<std::size_t> robots;  // indices of the robots, ascending
  std::vector<double> radii;        // metres, bare
  std::vector<double> vicinities;   // metres, added to the radii against robots
  std::vector<double> tolerances;   // metres
  std::vector<std::vector<Leg>> legs;
  std::vector<Handover> handovers;
  std::vector<bool> invalid;  // see Robot::invalid
  std::vector<bool> stays;    // it has no plan or no goal: it stays where its commitment ends, for ever

  std::size_t size() const { return robots.size(); }
  /// Whether two positions belong to the same robot.
  bool same_robot(std::size_t one, std::size_t other) const { return robots[one] == robots[other]; }
  double begin_of(std::size_t position) const { return legs[position].front().t_begin; }
  double end_of(std::size_t position) const { return legs[position].back().t_end; }
  /// Returns the distance that two robots keep while neither begins too near nor is committed, metres.
  /// `inflation` is added to each radius.
  double kept_distance(std::size_t one, std::size_t other, double inflation) const {
    return radii[one] + radii[other] + 2.0 * inflation + (vicinities[one] + vicinities[other]);
  }
};

}  // namespace fleetplan::core
