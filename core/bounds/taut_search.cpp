#include "core/bounds/taut_search.h"

#include <algorithm>
#include <functional>
#include <span>

#include "core/bounds/lower_bound.h"

namespace fleetplan::core {
namespace {

/// Rounding of a place on a bend (radians): where two tangents touch it at the same place, one leads on to
/// the other.
constexpr double kSamePlace = 1e-6;
/// What rounding may add to the cost of a path, as a part of it and in seconds.
constexpr double kRounding = 1e-9;
/// Expansions between two looks at the clock.
constexpr int kStopStride = 16;

}  // namespace

TautResult TautSearch::run(const Robot& robot, const Motion& motion, double at_most, std::int64_t most_work,
                           const StopCondition& stop) {
  robot_ = &robot;
  motion_ = &motion;
  bend_time_ = motion.translation_time(tangents_.radius()) + 1.0 / motion.angular_speed;
  limit_ = at_most * (1.0 + kRounding) + kRounding;
  const std::int64_t last_work = work() + most_work;
  reset();
  const double straight = lower_bound(robot, motion);
  for (const int corner : corners_.seen_from(robot.goal->position)) {
    sees_goal_[static_cast<std::size_t>(corner)] = 1;
  }
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
  from_start_.clear();
  arrivals_at_.assign(static_cast<std::size_t>(tangents_.bend_count()), -1);
  sees_goal_.assign(static_cast<std::size_t>(corners_.count()), 0);
}

void TautSearch::leave_start() {
  const Pose& start = robot_->start;
  for (const int corner : corners_.seen_from(start.position)) {
    for (const bool left : {false, true}) {
      const Bend bend{corner, left};
      const auto tangent = tangents_.from_point(start.position, bend);
      if (!tangent) continue;
      ++steps_;
      const double seconds = motion_->rotation_time(start.theta, tangent->heading) +
                             motion_->translation_time(tangent->length) + 2.0 * motion_->wait_before_move;
      const int number = static_cast<int>(from_start_.size());
      if (!push({seconds, tangent->arrive, bend, number, -1, false}, *tangent)) continue;
      from_start_.push_back(*tangent);
    }
  }
}

void TautSearch::expand(int index) {
  const Arrival arrival = arrivals_[static_cast<std::size_t>(index)];
  if (better_known(arrival.bend, arrival.place, arrival.seconds, index)) return;
  if (arrival.untested >= 0) {
    if (!tangents_.is_free(from_start_[static_cast<std::size_t>(arrival.untested)])) return;
    enlist(index);
  }
  go_on(arrival);
  if (sees_goal_[static_cast<std::size_t>(arrival.bend.corner)] != 0) reach_goal(arrival);
}

/// Puts what can be reached by a tangent from the bend on the open list.
void TautSearch::go_on(const Arrival& arrival) {
  const std::span<const Tangent> tangents = tangents_.from(arrival.bend);
  for (std::size_t k = 0; k < tangents.size(); ++k) {
    const Tangent& tangent = tangents[k];
    if (tangent.leave < arrival.place - kSamePlace) break;  // the rest leaves before the robot arrives
    ++steps_;
    double seconds = seconds_after(arrival, tangent);
    if (tangent.to.left != arrival.bend.left) seconds += motion_->wait_before_move;
    if (too_far(seconds, tangent.end) || better_known(tangent.to, tangent.arrive, seconds, -1)) continue;
    if (!tangents_.may_bend(arrival.bend, arrival.place, tangent.leave)) continue;
    if (!tangents_.is_free(arrival.bend, k)) continue;
    if (push({seconds, tangent.arrive, tangent.to, -1, -1, false}, tangent)) {
      enlist(static_cast<int>(arrivals_.size()) - 1);
    }
  }
}

/// Puts the goal on the open list.
void TautSearch::reach_goal(const Arrival& arrival) {
  const auto tangent = tangents_.to_point(arrival.bend, robot_->goal->position);
  if (!tangent || tangent->leave < arrival.place - kSamePlace) return;
  ++steps_;
  const double seconds = seconds_after(arrival, *tangent);
  if (!tangents_.may_bend(arrival.bend, arrival.place, tangent->leave)) return;
  if (tangents_.is_free(*tangent)) push({seconds, 0.0, {}, -1, -1, true}, *tangent);
}

/// Along the bend and then along the tangent.
double TautSearch::seconds_after(const Arrival& arrival, const Tangent& tangent) const {
  const double turn = std::max(0.0, tangent.leave - arrival.place);
  return arrival.seconds + turn * bend_time_ + motion_->translation_time(tangent.length);
}

/// Is the goal too far from `end` to be reached within the limit, turns left out?
bool TautSearch::too_far(double seconds, const Position& end) const {
  const double left = (limit_ - seconds) * motion_->linear_speed;
  return left < 0.0 || (robot_->goal->position - end).squaredNorm() > left * left;
}

/// Puts an arrival on the open list, unless the goal is too far from there, turns included.
bool TautSearch::push(const Arrival& arrival, const Tangent& by) {
  const double f = arrival.seconds + straight_cost({by.end, by.heading}, *robot_->goal, *motion_);
  if (f > limit_) return false;
  arrivals_.push_back(arrival);
  open_.push_back({f, static_cast<int>(arrivals_.size()) - 1});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
  return true;
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
