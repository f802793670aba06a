#pragma once

// The rules for one robot:
//
// - motion_rules.cpp: how it moves from action to action, within the speeds, after waits, and as committed.
// - visit_rules.cpp: where it begins, calls and ends.
// - place_rules.cpp: where its disk must not be: in obstacles, and in zones against their rules.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/distances.h"

namespace fleetplan::core {

/// Reports a number that is infinite, not a number, or larger than 1e30, as a discontinuity. It looks at the
/// robot, its commitment and its plan (null: none). No other check is possible for such a robot.
std::optional<Violation> find_unusable_number(std::size_t index, const Robot& robot, const RobotPlan* plan);

/// Checks that actions are contiguous in time and space, correspond to their types and end at the cost
/// (`discontinuity`). Checks that the robot keeps to its speeds and moves along its heading (`speed`). All
/// numbers must be usable. The first `given` actions are not judged. Ends early when `stop` is met.
ViolationList check_motion(const Robot& robot, const RobotPlan& plan, std::size_t given,
                           const CarriedLoads& loads, const Tolerance& tolerance, const StopCondition& stop);

/// Reports translations (`speed`) before which the robot, already turned, stands still for less than `wait`
/// seconds. Translations that follow each other in one straight line are one. Committed translations are not
/// judged. A robot that is committed to stand still at t = 0 may have done so for any time before.
ViolationList check_waits(const Robot& robot, const RobotPlan& plan, double wait, const Tolerance& tolerance,
                          const StopCondition& stop);

/// Reports a plan that does not begin with the committed actions (`committed_changed`), once: the first
/// number that differs. If `exact`, any difference counts; otherwise, only differences above the tolerance.
std::optional<Violation> check_commitments(const Robot& robot, const RobotPlan& plan,
                                           const Tolerance& tolerance, bool exact);

/// Checks that a plan begins at the robot's start (`wrong_start`) and rests at its goal (`wrong_goal`).
/// Reports each at most once: the position if it is wrong, otherwise the heading. A parked robot must rest at
/// its start, in any heading. A plan may rest anywhere if goals are left, or if the robot yields.
std::vector<Violation> check_terminals(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                       GoalsLeft goals_left);

/// Checks that the robot visits its goals in their order (`wrong_visit`). It must rest in the pose of each
/// goal, from `not_before` on, for the whole service. At the last goal, this rest must be at the end of its
/// plan. Rests are uninterrupted waits, or the instants between two actions.
///
/// Reports the first goal that is not visited. Also reports each visit that does not take place, and each
/// `goal` of a wait that is not committed and does not serve it. Whether the robot ends at its last goal is
/// not checked here (see check_terminals). With goals left, a plan may end before all are visited.
std::vector<Violation> check_visits(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                    GoalsLeft goals_left, const StopCondition& stop);

/// Returns how many goals before the last one a robot serves if it executes only its commitment.
std::size_t goals_served_by_commitment(const Robot& robot, const Tolerance& tolerance,
                                       const StopCondition& stop);

/// Returns the distance of a position from the nearest obstacle, at most `reach` metres.
double distance_from_walls(const ObstacleField& field, const Position& position, double reach);

/// Returns the distance from obstacles that a robot has to keep during each of its legs, metres. It is the
/// robot's radius, and after its commitment the inflated radius. There are three exceptions:
///
/// - A robot may begin nearer, as the rules allow. It comes no nearer until one of its straight moves ends
///   clear.
/// - A robot may end nearer at its last goal (`ends_in_goal`). It comes no nearer than it is there, from the
///   last straight move that begins clear.
/// - Committed motion may come as near as a last goal may be.
///
/// `distance_from(position, max)` returns the distance of a position from obstacles, at most `max`.
std::vector<double> distances_to_keep(const std::function<double(const Position&, double)>& distance_from,
                                      const std::vector<double>& radii, const std::vector<Leg>& legs,
                                      const Handover& handover, bool ends_in_goal, double tolerance,
                                      const CheckRules& rules);

/// Reports where a disk overlaps obstacles by more than the tolerance. There is one violation for each leg,
/// or for consecutive legs through which the overlap continues. `legs` are a result of `execute`; `radii` are
/// the disk's radii in each leg. Ends early when `stop` is met.
ViolationList check_obstacles(const ObstacleField& field, std::size_t robot, const std::vector<double>& radii,
                              const std::vector<Leg>& legs, double tolerance, const StopCondition& stop);

/// The zones of one robot.
class ZonesOfRobot {
 public:
  /// The zones of the robot with this index. `zones`: null if there are none. Otherwise, they must outlive
  /// this object.
  ZonesOfRobot(const std::vector<Zone>* zones, std::size_t index);

  bool empty() const { return zones_.empty(); }
  bool may_leave_any() const { return may_leave_any_; }

  /// Returns how far a position is from the blocked zones, metres, at most `reach`; 0 inside. Zones that the
  /// robot may leave do not count.
  double distance_to_blocked(const Position& position, double reach) const;

  /// Returns the number of the first goal, from `first` on, that is put off. There, the robot would be inside
  /// a zone that it may leave but not enter. None if there is no such goal. Near the border, within the
  /// tolerance (metres), the goal may be visited or put off: it is put off unless `visits(goal)`.
  std::optional<std::size_t> first_goal_put_off(const Robot& robot, std::size_t first, double tolerance,
                                                const std::function<bool(std::size_t)>& visits) const;

  /// Reports where the disk overlaps a blocked zone by more than the tolerance (metres). For each zone, there
  /// is one violation for consecutive legs through which the overlap continues. `kept` are the distances that
  /// the robot keeps in each leg, `radii` the radii of its disk.
  ///
  /// A robot may be in zones that it may leave while it executes its commitment. It may also be there from
  /// its start or from the end of its commitment, until a leg ends clear of all such zones. Ends early when
  /// `stop` is met.
  ViolationList check_blocked(const std::vector<double>& kept, const std::vector<double>& radii,
                              const std::vector<Leg>& legs, const Handover& handover, double tolerance,
                              const StopCondition& stop) const;

  /// Reports the actions that are faster than a speed zone allows, or against a one-way zone. Ends early when
  /// `stop` is met.
  ViolationList check_driving(const std::vector<Action>& actions, const CarriedLoads& loads,
                              const Tolerance& tolerance, const StopCondition& stop) const;

 private:
  struct ZoneBox {
    std::size_t index = 0;
    const Zone* zone = nullptr;
    Rectangle box;
  };

  double distance_to_leave(const Position& position, double reach) const;
  std::vector<bool> may_be_inside(const std::vector<double>& radii, const std::vector<Leg>& legs,
                                  const Handover& handover, double tolerance,
                                  const StopCondition& stop) const;
  std::optional<Violation> check_translation(const ZoneBox& in, const Action& action, std::size_t number,
                                             const CarriedLoad& load, const Tolerance& tolerance,
                                             const StopCondition& stop) const;
  std::optional<Violation> check_rotation(const ZoneBox& in, const Action& action, std::size_t number,
                                          const Tolerance& tolerance) const;
  Violation broken(const ZoneBox& in, double t, double measured, double required, std::string detail) const;

  std::size_t robot_;
  std::vector<ZoneBox> zones_;
  bool may_leave_any_ = false;  // of the zones
};

}  // namespace fleetplan::core
