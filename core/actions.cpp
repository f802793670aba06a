#include "core/actions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/geometry/angle.h"

namespace fleetplan::core {
namespace {

/// Radians and seconds; smaller rotations and waits are rounding. Far below the tolerances of the verifier.
constexpr double kNegligible = 1e-12;

class ActionList {
 public:
  /// Begins with the committed actions.
  explicit ActionList(const Robot& robot)
      : robot_(robot),
        pose_(robot.committed_end()),
        now_(robot.committed_until()),
        actions_(robot.committed) {}

  /// Rotates to a heading, then waits until `t_end`.
  void rotate_and_wait(double theta, double t_end) {
    const double rotation = std::abs(rotation_between(pose_.theta, theta));
    if (rotation > kNegligible) {
      double rotated = now_ + rotation / robot_.angular_speed;
      if (std::abs(t_end - rotated) <= kNegligible) rotated = t_end;
      append(Action::Type::rotate, rotated, {pose_.position, theta});
    }
    if (t_end - now_ > kNegligible) append(Action::Type::wait, t_end, pose_);
  }
  void translate(const TimedSegment& move) {
    append(Action::Type::translate, move.t_end, {move.path.to, pose_.theta});
  }
  double now() const { return now_; }
  std::vector<Action> take() { return std::move(actions_); }

 private:
  void append(Action::Type type, double t_end, const Pose& to) {
    actions_.push_back({type, now_, t_end, pose_, to});
    now_ = t_end;
    pose_ = to;
  }

  const Robot& robot_;
  Pose pose_;
  double now_;
  std::vector<Action> actions_;
};

/// Those after the committed actions.
std::span<const TimedSegment> planned_moves(const Robot& robot, const Trajectory& trajectory) {
  const auto committed = std::count_if(robot.committed.begin(), robot.committed.end(),
                                       [](const Action& a) { return a.type == Action::Type::translate; });
  return std::span(trajectory.moves).subspan(static_cast<std::size_t>(committed));
}

}  // namespace

std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory) {
  ActionList list(robot);
  for (const TimedSegment& move : planned_moves(robot, trajectory)) {
    const Position direction = move.path.to - move.path.from;
    list.rotate_and_wait(normalize_angle(std::atan2(direction.y(), direction.x())), move.t_start);
    list.translate(move);
  }
  if (robot.goal && robot.goal->theta) list.rotate_and_wait(*robot.goal->theta, trajectory.cost);
  return list.take();
}

}  // namespace fleetplan::core
