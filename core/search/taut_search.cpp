#include "core/search/taut_search.h"

#include <algorithm>
#include <functional>

#include "core/search/lower_bound.h"

namespace fleetplan::core {
namespace {

/// Rounding of a place on a bend (radians): where two tangents touch it at the same place, one leads on to
/// the other.
constexpr double kSamePlace = 1e-6;
/// Expansions between two looks at the clock.
constexpr int kStopStride = 16;

}  // namespace

TautResult TautSearch::run(const Robot& robot, const Motion& motion, std::int64_t most_steps,
                           const StopCondition& stop) {
  robot_ = &robot;
  motion_ = &motion;
  bend_time_ = motion.translation_time(tangents_.radius()) + 1.0 / motion.angular_speed;
  reset();
  const double straight = lower_bound(robot, motion);
  sees_goal_ = corners_.seen_from(robot.goal->position);
  leave_start();
  TautResult result{straight, false};
  for (int expansion = 1; !open_.empty(); ++expansion) {
    const Open best = open_.front();
    result.seconds = std::max(straight, best.f);
    const Arrival arrival = arrivals_[static_cast<std::size_t>(best.arrival)];
    if (arrival.at_goal) return result;
    if (steps_ > most_steps) return result;
    if (expansion % kStopStride == 0 && stop.met()) {
      result.cut_off = true;
      return result;
    }
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    open_.pop_back();
    expand(arrival);
  }
  return {straight, false};
}

void TautSearch::reset() {
  steps_ = 0;
  arrivals_.clear();
  open_.clear();
  passed_.clear();
  passed_at_.assign(static_cast<std::size_t>(tangents_.bend_count()), -1);
}

void TautSearch::leave_start() {
  const Pose& start = robot_->start;
  for (const int corner : corners_.seen_from(start.position)) {
    for (const bool left : {false, true}) {
      ++steps_;
      const Bend bend{corner, left};
      const auto tangent = tangents_.from_point(start.position, bend);
      if (!tangent) continue;
      const double seconds = motion_->rotation_time(start.theta, tangent->heading) +
                             motion_->translation_time(tangent->length) + 2.0 * motion_->wait_before_move;
      push({seconds, tangent->arrive, bend, *tangent, false, false},
           straight_cost({tangent->end, tangent->heading}, *robot_->goal, *motion_));
    }
  }
}

void TautSearch::expand(const Arrival& arrival) {
  if (passed(arrival.bend, arrival.place, arrival.seconds)) return;
  if (!arrival.tested && !tangents_.is_free(arrival.by)) return;
  int& last = passed_at_[static_cast<std::size_t>(Tangents::index(arrival.bend))];
  passed_.push_back({arrival.place, arrival.seconds, last});
  last = static_cast<int>(passed_.size()) - 1;

  for (const Tangent& tangent : tangents_.from(arrival.bend)) leave(arrival, tangent, false);
  if (!std::binary_search(sees_goal_.begin(), sees_goal_.end(), arrival.bend.corner)) return;
  const auto last_one = tangents_.to_point(arrival.bend, robot_->goal->position);
  if (last_one && tangents_.is_free(*last_one)) leave(arrival, *last_one, true);
}

/// Puts the way along the bend and then along the tangent on the open list.
void TautSearch::leave(const Arrival& arrival, const Tangent& tangent, bool at_goal) {
  ++steps_;
  if (tangent.leave < arrival.place - kSamePlace) return;
  const double turn = std::max(0.0, tangent.leave - arrival.place);
  double seconds = arrival.seconds + turn * bend_time_ + motion_->translation_time(tangent.length);
  if (!at_goal) {
    if (tangent.to.left != arrival.bend.left) seconds += motion_->wait_before_move;
    if (passed(tangent.to, tangent.arrive, seconds)) return;
  }
  if (!tangents_.may_bend(arrival.bend, arrival.place, tangent.leave)) return;
  push({seconds, tangent.arrive, tangent.to, tangent, true, at_goal},
       straight_cost({tangent.end, tangent.heading}, *robot_->goal, *motion_));
}

void TautSearch::push(const Arrival& arrival, double to_go) {
  arrivals_.push_back(arrival);
  open_.push_back({arrival.seconds + to_go, static_cast<int>(arrivals_.size()) - 1});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

/// Was the bend passed at this place at no greater cost?
bool TautSearch::passed(const Bend& bend, double place, double seconds) const {
  for (int p = passed_at_[static_cast<std::size_t>(Tangents::index(bend))]; p >= 0;) {
    const Passed& other = passed_[static_cast<std::size_t>(p)];
    if (other.place <= place && other.seconds + (place - other.place) * bend_time_ <= seconds) return true;
    p = other.next;
  }
  return false;
}

}  // namespace fleetplan::core
