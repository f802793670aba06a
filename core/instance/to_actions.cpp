#include "core/instance/to_actions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/geometry/angle.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// Radians and seconds; smaller rotations and waits are rounding. Far below the tolerances of the verifier.
constexpr double kNegligible = 1e-12;
/// Seconds: rounding of the end of a rotation before a visit.
constexpr double kRounding = 1e-9;

class ActionList {
 public:
  /// Begins with the committed actions.
  ActionList(const Robot& robot, const DriveZones* zones)
      : robot_(robot),
        zones_(zones),
        pose_(robot.committed_end()),
        now_(robot.committed_until()),
        actions_(robot.committed) {}

  /// Rotates to a heading before a move of no length: a place off the lattice may be one on it, too.
  void turn(double theta, double t_end) { rotate(theta, t_end, kNegligible); }
  /// Rotates to a heading, then waits until `t_end`.
  void rotate_and_wait(double theta, double t_end) {
    rotate(theta, t_end, kNegligible);
    wait(t_end, {});
  }
  /// Rests in the pose of a goal, and waits there until its service ends.
  void visit(const Visit& visit) {
    const auto& theta = robot_.goal_at(visit.goal).theta;
    // A rest that the committed actions have begun goes on, as exactly in the pose as it is.
    if (theta && visit.t_arrive - now_ > kNegligible) rotate(*theta, visit.t_arrive, kRounding);
    wait(visit.t_arrive, {});
    wait(visit.t_leave, visit.goal);
  }
  void visit_last(double t_leave) {
    const Goal& goal = *robot_.goal;
    const bool goes_on = !robot_.committed.empty() && is_at_committed_end() && is_in_pose(pose_, goal);
    if (goal.theta && !goes_on) rotate(*goal.theta, t_leave, kNegligible);
    const bool serves = goal.service > 0.0 || goal.not_before > 0.0;
    if (goal.theta || serves) wait(t_leave, serves ? std::optional(robot_.via.size()) : std::nullopt);
  }
  void translate(const TimedSegment& move, const SpeedProfile* profile, bool reverse) {
    append(Action::Type::translate, move.t_end, {move.path.to, pose_.theta}, {});
    actions_.back().reverse = reverse;
    if (profile != nullptr) actions_.back().profile = *profile;
  }
  void wait(double t_end, std::optional<std::size_t> goal) {
    if (t_end - now_ > kNegligible) append(Action::Type::wait, t_end, pose_, goal);
  }
  std::vector<Action> take() { return std::move(actions_); }

 private:
  bool is_at_committed_end() const { return actions_.size() == robot_.committed.size(); }
  /// The rotation ends at `t_end` if that is right up to `rounding` seconds.
  void rotate(double theta, double t_end, double rounding) {
    const double rotation = std::abs(rotation_between(pose_.theta, theta));
    if (rotation <= kNegligible) return;
    const double speed = zones_ != nullptr ? zones_->angular_speed_at(pose_.position) : robot_.angular_speed;
    const Inertia inertia = robot_.angular_inertia();
    double rotated = now_ + inertia.time(rotation, speed);
    if (std::abs(t_end - rotated) <= rounding) rotated = t_end;
    append(Action::Type::rotate, rotated, {pose_.position, theta}, {});
    if (inertia.is_limited) actions_.back().profile = fastest_profile(rotation, speed, inertia);
  }
  void append(Action::Type type, double t_end, const Pose& to, std::optional<std::size_t> goal) {
    actions_.push_back({type, now_, t_end, pose_, to, goal});
    now_ = t_end;
    pose_ = to;
  }

  const Robot& robot_;
  const DriveZones* zones_;  // null for none
  Pose pose_;
  double now_;
  std::vector<Action> actions_;
};

/// The index of the first one after the committed actions.
std::size_t first_planned_move(const Robot& robot, const Trajectory& trajectory) {
  const double t_begin = robot.committed_until();
  const auto first = std::find_if(trajectory.moves.begin(), trajectory.moves.end(),
                                  [&](const TimedSegment& move) { return move.t_start >= t_begin; });
  return static_cast<std::size_t>(first - trajectory.moves.begin());
}

/// The direction of a move and of those that go on from it.
double heading_from(const Trajectory& trajectory, std::size_t move) {
  std::size_t last = move;
  while (trajectory.continues(last + 1)) ++last;
  const Position direction = trajectory.moves[last].path.to - trajectory.moves[move].path.from;
  return normalize_angle(std::atan2(direction.y(), direction.x()));
}

}  // namespace

std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory, const DriveZones* zones) {
  ActionList list(robot, zones);
  auto visit = trajectory.visits.begin();
  for (std::size_t k = first_planned_move(robot, trajectory); k < trajectory.moves.size(); ++k) {
    const TimedSegment& move = trajectory.moves[k];
    for (; visit != trajectory.visits.end() && visit->t_leave <= move.t_start; ++visit) list.visit(*visit);
    const bool reverse = trajectory.is_reverse(k);
    const bool moves = move.path.from != move.path.to;
    if (!trajectory.continues(k)) {
      const double direction = heading_from(trajectory, k);
      const double heading = reverse ? opposite_heading(direction) : direction;
      moves ? list.rotate_and_wait(heading, move.t_start) : list.turn(heading, move.t_start);
    }
    if (moves) list.translate(move, trajectory.profile(k), reverse);
  }
  for (; visit != trajectory.visits.end(); ++visit) list.visit(*visit);
  if (trajectory.stops_at) {
    list.wait(*trajectory.stops_at, {});
  } else if (robot.goal) {
    list.visit_last(trajectory.cost);
  }
  return list.take();
}

}  // namespace fleetplan::core
