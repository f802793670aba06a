#include "core/execution/simulation/executed_motion.h"

#include <cmath>
#include <limits>
#include <span>

#include "core/geometry/position.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kPiecesBetweenPolls = 256;

/// The position and heading of a robot in each part of an action, with its offset from the path.
class DisturbedPath {
 public:
  DisturbedPath(const Action& action, std::span<const double> offsets)
      : action_(action), way_(action.to.position - action.from.position), offsets_(offsets) {
    const double length = way_.norm();
    if (length > 0.0) left_ = Position(-way_.y(), way_.x()) / length;
  }

  Position position(double fraction) const {
    if (fraction <= 0.0) return action_.from.position;
    if (fraction >= 1.0) return action_.to.position;
    const Position on_path = action_.from.position + fraction * way_;
    return offsets_.empty() ? on_path : Position(on_path + offset(fraction) * left_);
  }

  Pose pose(double fraction) const {
    if (fraction <= 0.0) return action_.from;
    if (fraction >= 1.0) return action_.to;
    const double turn = rotation_between(action_.from.theta, action_.to.theta);
    return {position(fraction), normalize_angle(action_.from.theta + fraction * turn)};
  }

  bool bends() const { return !offsets_.empty(); }

  /// The fraction of the first bend of the path strictly between two fractions, if there is one.
  std::optional<double> next_bend(double from, double to) const {
    // The place of `from` among the bends is rounded, so the search begins one earlier.
    const double place = from * static_cast<double>(offsets_.size()) - 1.5;
    auto k = place > 0.0 ? static_cast<std::size_t>(place) : 0;
    while (k < offsets_.size() && bend(k) <= from) ++k;
    if (k >= offsets_.size() || bend(k) >= to) return std::nullopt;
    return bend(k);
  }

 private:
  double bend(std::size_t k) const {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(offsets_.size());
  }

  /// Returns the offset at a fraction of the path, metres to the left: linear between the bends, 0 at both
  /// ends.
  double offset(double fraction) const {
    const std::size_t count = offsets_.size();
    const double place = fraction * static_cast<double>(count) - 0.5;  // bend k is at k
    if (place <= 0.0) return offsets_.front() * fraction / bend(0);
    const auto before = std::min(static_cast<std::size_t>(place), count - 1);
    if (before + 1 == count) return offsets_.back() * (1.0 - fraction) / (1.0 - bend(before));
    const double part = place - static_cast<double>(before);
    return (1.0 - part) * offsets_[before] + part * offsets_[before + 1];
  }

  const Action& action_;
  Position way_;
  Position left_{0.0, 0.0};
  std::span<const double> offsets_;
};

/// Returns the ramp of a part of the motion between two knots.
double ramp_between(const ExecutionKnot& from, const ExecutionKnot& to, double begin, double end) {
  if (to.ramp == 0.0 || (begin == from.t && end == to.t)) return to.ramp;
  const double share = (end - begin) / (to.t - from.t);
  const double middle = (0.5 * (begin + end) - from.t) / (to.t - from.t);
  return to.ramp * share / (1.0 - to.ramp * (1.0 - 2.0 * middle));
}

/// Calls `visit(planned action, path, from, to)` for each piece of time, in order, in which a robot moves
/// straight or stands. `from` and `to` are knots of the same action. Returns false if `stop` is met first, or
/// if `visit` returns false.
template <typename Visit>
bool visit_pieces(const std::vector<Action>& planned, const DisturbedActions& disturbed,
                  const ExecutedProgress& progress, const StopCondition& stop, Visit visit) {
  StopStride stride(stop, kPiecesBetweenPolls);
  for (std::size_t k = 1; k < progress.knots.size(); ++k) {
    const ExecutionKnot& from = progress.knots[k - 1];
    const ExecutionKnot& to = progress.knots[k];
    if (stride.met_at_step()) return false;
    if (from.action != to.action || (from.t == to.t && from.fraction == to.fraction)) continue;
    const Action& action = planned[from.action];
    const DisturbedPath path(action, disturbed.offsets(from.action));
    ExecutionKnot last = from;
    while (const auto bend = path.next_bend(last.fraction, to.fraction)) {
      if (stride.met_at_step()) return false;
      const double part = (*bend - from.fraction) / (to.fraction - from.fraction);
      const double elapsed = elapsed_share(part, to.ramp);
      ExecutionKnot at{from.t + elapsed * (to.t - from.t), from.action, *bend};
      at.ramp = ramp_between(from, to, last.t, at.t);
      if (!visit(action, path, last, at)) return false;
      last = at;
    }
    ExecutionKnot end = to;
    end.ramp = ramp_between(from, to, last.t, to.t);
    if (!visit(action, path, last, end)) return false;
  }
  return true;
}

}  // namespace

std::optional<std::vector<Leg>> executed_legs(const Robot& robot, const std::vector<Action>& planned,
                                              const DisturbedActions& disturbed,
                                              const ExecutedProgress& progress, const StopCondition& stop) {
  std::vector<Leg> legs;
  double now = 0.0;
  Position here = planned.empty() ? robot.start.position : planned.front().from.position;
  const auto stand = [&](double until) {
    if (until > now) legs.push_back({now, until, here, here});
    now = std::max(now, until);
  };
  const bool finished =
      visit_pieces(planned, disturbed, progress, stop,
                   [&](const Action& action, const DisturbedPath& path, const ExecutionKnot& from,
                       const ExecutionKnot& to) {
                     if (action.type != Action::Type::translate || from.fraction == to.fraction) return true;
                     stand(from.t);
                     const Position there = path.position(to.fraction);
                     const Position start = path.position(from.fraction);
                     legs.push_back({from.t, to.t, start, there, to.ramp * (there - start)});
                     now = to.t;
                     here = there;
                     return true;
                   });
  if (!finished) return std::nullopt;
  legs.push_back({now, std::numeric_limits<double>::infinity(), here, here});
  return legs;
}

ExecutedProgress by_profiles(const std::vector<Action>& planned, ExecutedProgress by_time) {
  ExecutedProgress progress;
  progress.arrived = by_time.arrived;
  // Bounded: the knots that there are, and at most two more of each pair.
  for (const ExecutionKnot& to : by_time.knots) {
    const Action& action = planned[to.action];
    if (!action.profile || to.fraction <= 0.0) {
      progress.knots.push_back(to);
      continue;
    }
    const ExecutionKnot& from = by_time.knots[static_cast<std::size_t>(&to - by_time.knots.data()) - 1];
    const SpeedProfile& profile = *action.profile;
    const double duration = action.t_end - action.t_start;
    double begin = from.fraction;
    for (const double bend :
         {profile.rise_time() / duration, 1.0 - profile.fall_time() / duration, to.fraction}) {
      const double end = std::min(bend, to.fraction);
      if (end <= begin && end < to.fraction) continue;
      const double start_speed = speed_after(profile, duration, begin * duration);
      const double end_speed = speed_after(profile, duration, end * duration);
      ExecutionKnot knot = to;
      if (end < to.fraction) {
        const double share = (end - from.fraction) / (to.fraction - from.fraction);
        knot.t = from.t + share * (to.t - from.t);
      }
      knot.fraction = end < 1.0 ? share_covered(action, end) : 1.0;
      knot.ramp = start_speed == end_speed ? 0.0 : (end_speed - start_speed) / (end_speed + start_speed);
      progress.knots.push_back(knot);
      begin = end;
      if (end >= to.fraction) break;
    }
  }
  return progress;
}

namespace {

/// Speeds that differ by less are the same (metres or radians per second).
constexpr double kSameSpeed = 1e-6;

/// Seconds: drives may have pieces as short as rounding, which are left out.
constexpr double kNoTime = 1e-9;

/// How the speed changes in an action, in the order of a profile.
enum class Change { rises, stays, falls };

Change change_of(double ramp) {
  if (ramp == 0.0) return Change::stays;
  return ramp > 0.0 ? Change::rises : Change::falls;
}

/// Returns the profile of a motion at constant acceleration. The acceleration may differ from the robot's,
/// because of offsets from the path or because of a clock. Then the profile has the robot's acceleration and
/// the same mean speed; none if there is no such profile.
std::optional<SpeedProfile> profile_of(const Action& motion, double ramp, const Inertia& inertia) {
  const double duration = motion.t_end - motion.t_start;
  const double mean = amount_of(motion) / duration;
  const Change change = change_of(ramp);
  double half = ramp * mean;  // of the difference of speeds
  if (change != Change::stays) {
    const double inverse = change == Change::rises ? inertia.rise : inertia.fall;
    if (inverse <= 0.0) return std::nullopt;
    const double limited = 0.5 * duration / inverse;
    if (std::abs(std::abs(half) - limited) > kSameSpeed) half = std::copysign(limited, ramp);
  }
  if (!(duration > 0.0) || std::abs(half) > mean * (1.0 + kSameSpeed)) return std::nullopt;
  const double start = std::max(0.0, mean - half);
  const double end = std::max(0.0, mean + half);
  return SpeedProfile{start, std::max(start, end), end, inertia};
}

/// Adds executed actions one after the other.
class ActionJoiner {
 public:
  /// Adds what was done of a planned action between two knots.
  void add(const Action& planned, const DisturbedPath& path, const ExecutionKnot& from,
           const ExecutionKnot& to) {
    const bool moves = planned.type != Action::Type::wait && from.fraction != to.fraction;
    if (!moves && from.t == to.t) return;
    if (planned.profile && to.t - from.t < kNoTime) return;
    const bool waits_on = !moves && !executed_.empty() && executed_.back().type == Action::Type::wait &&
                          executed_.back().goal == planned.goal;
    if (waits_on) {
      executed_.back().t_end = to.t;
      return;
    }
    Action piece;
    piece.type = moves ? planned.type : Action::Type::wait;
    piece.t_start = from.t;
    piece.t_end = to.t;
    piece.from = path.pose(from.fraction);
    piece.to = path.pose(to.fraction);
    piece.goal = planned.goal;
    piece.reverse = moves && planned.reverse;
    if (moves && planned.profile) piece.profile = profile_of(piece, to.ramp, planned.profile->inertia);
    const Change change = change_of(to.ramp);
    if (moves && &planned == latest_ && goes_on(piece, change, path)) {
      Action& last = executed_.back();
      last.t_end = to.t;
      last.to = piece.to;
      last.profile->cruise = std::max(last.profile->cruise, piece.profile->cruise);
      last.profile->end = piece.profile->end;
    } else {
      executed_.push_back(piece);
    }
    latest_ = moves ? &planned : nullptr;
    change_ = change;
  }

  std::size_t count() const { return executed_.size(); }
  std::vector<Action> take() { return std::move(executed_); }

 private:
  /// Whether a piece of the same planned action goes on with the profile of the one before.
  bool goes_on(const Action& piece, Change change, const DisturbedPath& path) const {
    const std::optional<SpeedProfile>& before = executed_.back().profile;
    if (!piece.profile || !before || path.bends() || change < change_) return false;
    return std::abs(before->end - piece.profile->start) <= kSameSpeed;
  }

  std::vector<Action> executed_;
  const Action* latest_ = nullptr;  // that the last piece belongs to, if it moves
  Change change_ = Change::rises;   // in the last piece
};

}  // namespace

std::optional<std::vector<Action>> disturbed_actions(const std::vector<Action>& planned,
                                                     const DisturbedActions& disturbed,
                                                     const ExecutedProgress& progress,
                                                     std::size_t max_actions, const StopCondition& stop) {
  ActionJoiner joiner;
  const auto add = [&](const Action& action, const DisturbedPath& path, const ExecutionKnot& from,
                       const ExecutionKnot& to) {
    joiner.add(action, path, from, to);
    return joiner.count() <= max_actions;
  };
  if (!visit_pieces(planned, disturbed, progress, stop, add)) return std::nullopt;
  return joiner.take();
}

}  // namespace fleetplan::core
