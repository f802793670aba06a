#include "core/execution/simulation/executed_motion.h"

#include <limits>
#include <span>

#include "core/geometry/angle.h"

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

/// Calls `visit(planned action, path, from, to)` for each piece of time, in order, in which a robot moves
/// straight or stands; from and to are knots of the same action. Returns false if `stop` is met first, or if
/// `visit` returns false.
template <typename Visit>
bool visit_pieces(const std::vector<Action>& planned, const DisturbedActions& disturbed,
                  const ExecutedProgress& progress, const StopCondition& stop, Visit visit) {
  std::size_t pieces = 0;
  const auto goes_on = [&] { return ++pieces % kPiecesBetweenPolls != 0 || !stop.met(); };
  for (std::size_t k = 1; k < progress.knots.size(); ++k) {
    const ExecutionKnot& from = progress.knots[k - 1];
    const ExecutionKnot& to = progress.knots[k];
    if (!goes_on()) return false;
    if (from.action != to.action || (from.t == to.t && from.fraction == to.fraction)) continue;
    const Action& action = planned[from.action];
    const DisturbedPath path(action, disturbed.offsets(from.action));
    ExecutionKnot last = from;
    while (const auto bend = path.next_bend(last.fraction, to.fraction)) {
      if (!goes_on()) return false;
      const double part = (*bend - from.fraction) / (to.fraction - from.fraction);
      const ExecutionKnot at{from.t + part * (to.t - from.t), from.action, *bend};
      if (!visit(action, path, last, at)) return false;
      last = at;
    }
    if (!visit(action, path, last, to)) return false;
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
                     legs.push_back({from.t, to.t, path.position(from.fraction), there});
                     now = to.t;
                     here = there;
                     return true;
                   });
  if (!finished) return std::nullopt;
  legs.push_back({now, std::numeric_limits<double>::infinity(), here, here});
  return legs;
}

std::optional<std::vector<Action>> disturbed_actions(const std::vector<Action>& planned,
                                                     const DisturbedActions& disturbed,
                                                     const ExecutedProgress& progress, std::size_t most,
                                                     const StopCondition& stop) {
  std::vector<Action> executed;
  const auto add = [&](const Action& action, const DisturbedPath& path, const ExecutionKnot& from,
                       const ExecutionKnot& to) {
    const bool moves = action.type != Action::Type::wait && from.fraction != to.fraction;
    if (!moves && from.t == to.t) return true;
    const bool goes_on = !moves && !executed.empty() && executed.back().type == Action::Type::wait &&
                         executed.back().goal == action.goal;
    if (goes_on) {
      executed.back().t_end = to.t;
      return true;
    }
    Action piece;
    piece.type = moves ? action.type : Action::Type::wait;
    piece.t_start = from.t;
    piece.t_end = to.t;
    piece.from = path.pose(from.fraction);
    piece.to = path.pose(to.fraction);
    piece.goal = action.goal;
    piece.reverse = moves && action.reverse;
    executed.push_back(piece);
    return executed.size() <= most;
  };
  if (!visit_pieces(planned, disturbed, progress, stop, add)) return std::nullopt;
  return executed;
}

}  // namespace fleetplan::core
