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

TautResult TautSearch::run(const Robot& robot, const Motion& motion, std::int64_t most_work,
                           const StopCondition& stop) {
  robot_ = &robot;
  motion_ = &motion;
  bend_time_ = motion.translation_time(tangents_.radius()) + 1.0 / motion.angular_speed;
  const std::int64_t last_work = work() + most_work;
  reset();
  const double straight = lower_bound(robot, motion);
  sees_goal_ = corners_.seen_from(robot.goal->position);
  leave_start();
  TautResult result{straight, false};
  for (int expansion = 1; !open_.empty(); ++expansion) {
    const Open best = open_.front();
    result.seconds = std::max(straight, best.f);
    if (arrivals_[static_cast<std::size_t>(best.arrival)].at_goal) return result;
    if (work() > last_work) return result;
    if (expansion % kStopStride == 0 && stop.met()) {
      result.cut_off = true;
      return result;
    }
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    open_.pop_back();
    expand(best.arrival);
  }
  return {straight, false};
}

void TautSearch::reset() {
  arrivals_.clear();
  open_.clear();
  arrivals_at_.assign(static_cast<std::size_t>(tangents_.bend_count()), -1);
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
      push({seconds, tangent->arrive, bend, *tangent, false, false, -1});
    }
  }
}

void TautSearch::expand(int index) {
  Arrival& arrival = arrivals_[static_cast<std::size_t>(index)];
  const Bend bend = arrival.bend;
  if (better_known(bend, arrival.place, arrival.seconds, index)) return;
  if (!arrival.tested) {
    if (!tangents_.is_free(arrival.by)) return;
    enlist(index);
  }
  const double place = arrival.place;
  for (const Tangent& tangent : tangents_.from(bend)) {
    if (tangent.leave < place - kSamePlace) break;  // the rest leaves before the robot arrives
    leave(index, tangent, false);
  }
  if (!std::binary_search(sees_goal_.begin(), sees_goal_.end(), bend.corner)) return;
  const auto last = tangents_.to_point(bend, robot_->goal->position);
  if (last && last->leave >= place - kSamePlace && tangents_.is_free(*last)) leave(index, *last, true);
}

/// Puts the way along the bend and then along the tangent on the open list.
void TautSearch::leave(int index, const Tangent& tangent, bool at_goal) {
  ++steps_;
  const Arrival& arrival = arrivals_[static_cast<std::size_t>(index)];
  const double turn = std::max(0.0, tangent.leave - arrival.place);
  double seconds = arrival.seconds + turn * bend_time_ + motion_->translation_time(tangent.length);
  if (!at_goal) {
    if (tangent.to.left != arrival.bend.left) seconds += motion_->wait_before_move;
    if (better_known(tangent.to, tangent.arrive, seconds, -1)) return;
  }
  if (!tangents_.may_bend(arrival.bend, arrival.place, tangent.leave)) return;
  push({seconds, tangent.arrive, tangent.to, tangent, true, at_goal, -1});
  if (!at_goal) enlist(static_cast<int>(arrivals_.size()) - 1);
}

void TautSearch::push(const Arrival& arrival) {
  const double to_go = straight_cost({arrival.by.end, arrival.by.heading}, *robot_->goal, *motion_);
  arrivals_.push_back(arrival);
  open_.push_back({arrival.seconds + to_go, static_cast<int>(arrivals_.size()) - 1});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

void TautSearch::enlist(int index) {
  Arrival& arrival = arrivals_[static_cast<std::size_t>(index)];
  int& last = arrivals_at_[static_cast<std::size_t>(Tangents::index(arrival.bend))];
  arrival.next = last;
  last = index;
}

/// Is an arrival known, other than `except`, that is at this place of the bend at no greater cost?
bool TautSearch::better_known(const Bend& bend, double place, double seconds, int except) const {
  for (int a = arrivals_at_[static_cast<std::size_t>(Tangents::index(bend))]; a >= 0;) {
    const Arrival& other = arrivals_[static_cast<std::size_t>(a)];
    const bool before = other.place <= place;
    if (before && a != except && other.seconds + (place - other.place) * bend_time_ <= seconds) return true;
    a = other.next;
  }
  return false;
}

}  // namespace fleetplan::core
