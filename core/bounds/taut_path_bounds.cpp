#include "core/bounds/taut_path_bounds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <span>

#include "core/compile/instance.h"

namespace fleetplan::core {
namespace {

/// Rounding of an angle on a bend (radians): tangents that touch it at the same angle are connected.
constexpr double kSameAngle = 1e-6;
/// Rounding of the cost of a path, relative and in seconds.
constexpr double kCostRounding = 1e-9;
/// Expansions between two checks of the stop condition.
constexpr std::size_t kExpansionStride = 16;

}  // namespace

TautPathResult TautPathSearch::run(const GoalLeg& leg, const Body& body, double known_cost,
                                   std::int64_t max_work, const StopCondition& stop) {
  leg_ = &leg;
  // The search is for a robot that starts and stops at once. The way is at least as long as the straight
  // line, so inertia adds at least what it adds there.
  const double loss = body.linear_inertia.loss((leg.to.position - leg.from).norm(), body.linear_speed);
  body_ = body;
  body_.linear_inertia = {};
  bend_time_ = body.cruise_time(graph_.radius()) + 1.0 / body.angular_speed;
  limit_ = known_cost * (1.0 + kCostRounding) + kCostRounding - loss;
  const std::int64_t last_work = work() + max_work;
  reset();
  const double straight = lower_bound(leg, body);
  for (const int corner : corners_.visible_from(leg.to.position)) {
    goal_visible_[corner] = 1;
  }
  expand_start();
  if (corners_.stopped()) return {straight, true};
  TautPathResult result{straight, false};
  StopStride stride(stop, kExpansionStride);
  while (!open_.empty()) {
    const Open best = open_.front();
    result.seconds = std::max(straight, best.f + loss);
    if (arrivals_[best.arrival].at_goal) return result;
    if (work() > last_work) return result;
    if (stride.met_at_step()) {
      result.cut_off = true;
      return result;
    }
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    open_.pop_back();
    expand(best.arrival);
    if (corners_.stopped()) {  // ways may be missing
      result.cut_off = true;
      return result;
    }
  }
  return {straight, false};
}

void TautPathSearch::reset() {
  arrivals_.clear();
  open_.clear();
  from_start_.clear();
  last_arrival_.clear();
  last_arrival_.resize(static_cast<std::size_t>(graph_.bend_count()), -1);
  goal_visible_.clear();
  goal_visible_.resize(static_cast<std::size_t>(corners_.count()), 0);
}

void TautPathSearch::expand_start() {
  for (const int corner : corners_.visible_from(leg_->from)) {
    if (corners_.stopped_at_step()) return;
    for (const bool left : {false, true}) {
      const Bend bend{corner, left};
      const auto tangent = graph_.from_point(leg_->from, bend);
      if (!tangent) continue;
      ++steps_;
      const double rotation = leg_->heading ? body_.rotation_time(*leg_->heading, tangent->heading) : 0.0;
      const double seconds =
          rotation + body_.translation_time(tangent->length) + 2.0 * body_.wait_before_move;
      const Arrival arrival{seconds, tangent->arrive_angle, bend, from_start_.next_index(), -1, false};
      if (push(arrival, *tangent)) from_start_.push_back(*tangent);
    }
  }
}

void TautPathSearch::expand(int index) {
  const Arrival arrival = arrivals_[index];
  if (is_dominated(arrival.bend, arrival.angle, arrival.seconds, index)) return;
  if (arrival.untested >= 0) {
    if (!graph_.is_free(from_start_[arrival.untested])) return;
    add_to_bend(index);
  }
  expand_tangents(arrival);
  if (goal_visible_[arrival.bend.corner] != 0) expand_goal(arrival);
}

/// Puts the arrivals by tangents from the bend on the open list.
void TautPathSearch::expand_tangents(const Arrival& arrival) {
  const std::span<const Tangent> tangents = graph_.from(arrival.bend);
  int k = -1;  // index of the tangent
  for (const Tangent& tangent : tangents) {
    ++k;
    if (tangent.leave_angle < arrival.angle - kSameAngle) break;  // the others leave before the arrival
    ++steps_;
    double seconds = seconds_after(arrival, tangent);
    if (tangent.to.left != arrival.bend.left) seconds += body_.wait_before_move;
    if (exceeds_limit(seconds, tangent.end) || is_dominated(tangent.to, tangent.arrive_angle, seconds, -1))
      continue;
    if (!graph_.is_arc_free(arrival.bend, arrival.angle, tangent.leave_angle)) continue;
    if (!graph_.is_free(arrival.bend, k)) continue;
    if (push({seconds, tangent.arrive_angle, tangent.to, -1, -1, false}, tangent)) {
      add_to_bend(arrivals_.next_index() - 1);
    }
  }
}

/// Puts the goal on the open list.
void TautPathSearch::expand_goal(const Arrival& arrival) {
  const auto tangent = graph_.to_point(arrival.bend, leg_->to.position);
  if (!tangent || tangent->leave_angle < arrival.angle - kSameAngle) return;
  ++steps_;
  const double seconds = seconds_after(arrival, *tangent);
  if (!graph_.is_arc_free(arrival.bend, arrival.angle, tangent->leave_angle)) return;
  if (graph_.is_free(*tangent)) push({seconds, 0.0, {}, -1, -1, true}, *tangent);
}

/// The time at the end of the tangent, after the arc to its beginning.
double TautPathSearch::seconds_after(const Arrival& arrival, const Tangent& tangent) const {
  const double turn = std::max(0.0, tangent.leave_angle - arrival.angle);
  return arrival.seconds + turn * bend_time_ + body_.translation_time(tangent.length);
}

/// Whether the goal cannot be reached from `end` within the limit, turns ignored.
bool TautPathSearch::exceeds_limit(double seconds, const Position& end) const {
  const double left = (limit_ - seconds) * body_.linear_speed;
  return left < 0.0 || (leg_->to.position - end).squaredNorm() > left * left;
}

/// Puts an arrival on the open list and returns true, unless the goal cannot be reached within the limit,
/// turns included.
bool TautPathSearch::push(const Arrival& arrival, const Tangent& by) {
  const double f = arrival.seconds + straight_cost({by.end, by.heading}, leg_->to, body_);
  if (f > limit_) return false;
  open_.push_back({f, arrivals_.push_back(arrival)});
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
  return true;
}

void TautPathSearch::add_to_bend(int index) {
  Arrival& arrival = arrivals_[index];
  int& last = last_arrival_[TangentGraph::index(arrival.bend)];
  arrival.next = last;
  last = index;
}

/// Whether a tested arrival other than `except` is at this angle of the bend at no greater cost.
bool TautPathSearch::is_dominated(const Bend& bend, double angle, double seconds, int except) const {
  for (int a = last_arrival_[TangentGraph::index(bend)]; a >= 0;) {
    const Arrival& other = arrivals_[a];
    const bool before = other.angle <= angle;
    if (before && a != except && other.seconds + (angle - other.angle) * bend_time_ <= seconds) return true;
    a = other.next;
  }
  return false;
}

namespace {

/// The work for all robots of a request together (see TautPathSearch::work),
/// 0.3 to 0.5 s.
constexpr std::int64_t kMaxWork = 30'000'000;
/// A robot may use the remaining work divided by this. The first robots also compute what others share.
constexpr std::int64_t kWorkDivisor = 64;
/// Legs between two checks of the stop condition, while the straight legs are found.
constexpr std::size_t kLegsBetweenPolls = 64;

/// Whether the robot's disk is clear of obstacles at both ends of a leg. Elsewhere it always is.
bool fits_at_ends(const Instance& instance, std::size_t robot, std::size_t leg) {
  const double radius = instance.views(robot)[leg].body.wall_radius;
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  const auto fits_at = [&](const Goal& goal) {
    return radius_at_goal(instance, robot, goal.position, leg, 0.0) == radius;
  };
  const bool fits_at_begin = leg == 0 ? fits_at_start(instance, robot) : fits_at(goals[leg - 1]);
  return fits_at_begin && fits_at(goals[leg]);
}

/// The body for the cost of a taut path that bounds a robot that may reverse. Such a robot need not turn as
/// much as a taut path does. Only the length and waits of the path, and the difference of the headings at its
/// ends, bound its cost.
Body without_turns_if_reversing(Body body) {
  if (!body.may_reverse) return body;
  body.angular_speed = std::numeric_limits<double>::infinity();
  body.angular_inertia = {};
  body.may_reverse = false;
  return body;
}

bool is_straight(const Instance& instance, const GoalLeg& leg, double radius) {
  return instance.sight_past_walls().may_sweep(leg.from, leg.to.position, radius);
}

/// Whether all vertices of the lattice are centres of cells.
bool stops_at_cell_centers(const Lattice& lattice, const OccupancyGrid& grid) {
  const double cells = lattice.spacing() / grid.resolution();
  const double odd = 2.0 * std::round(0.5 * (cells - 1.0)) + 1.0;
  return std::abs(cells - odd) <= 1e-9 * cells;
}

}  // namespace

/// The legs of a robot, and lower bounds of their durations.
struct TautPathBounds::Way {
  std::vector<GoalLeg> legs;
  std::vector<double> seconds;  // by leg

  Way(const Instance& instance, std::size_t robot) : legs(legs_of(instance.itinerary(robot))) {
    for (const GoalLeg& leg : legs) {
      seconds.push_back(lower_bound(leg, instance.views(robot)[seconds.size()].body));
    }
  }
  /// The most seconds that the leg takes in the cheapest plan, if there is a plan of this cost.
  double max_seconds(const Itinerary& itinerary, std::size_t leg, double cost) const {
    double others = itinerary.t_begin - itinerary.service_done;
    for (std::size_t k = 0; k < legs.size(); ++k) {
      others += itinerary.goals[k].service + (k == leg ? 0.0 : seconds[k]);
    }
    return cost - others;
  }
};

TautPathBounds::TautPathBounds(const Instance& instance, const std::vector<std::size_t>& robots,
                               const std::vector<double>& costs, const StopCondition& stop)
    : seconds_(instance.size(), 0.0) {
  try {
    bound(instance, robots, costs, stop);
  } catch (const std::bad_alloc&) {  // not granted to the job: the bounds so far remain
    cut_off_ = true;
  }
}

void TautPathBounds::bound(const Instance& instance, const std::vector<std::size_t>& robots,
                           const std::vector<double>& costs, const StopCondition& stop) {
  LegsByRadius out_of_sight;  // legs of robots of one radius share their tangents
  std::vector<Way> ways;
  StopStride stride(stop, kLegsBetweenPolls);
  for (const std::size_t robot : robots) {
    const Way& way = ways.emplace_back(instance, robot);
    seconds_[robot] = end_after(instance.itinerary(robot), way.seconds);
    for (std::size_t leg = 0; leg < way.legs.size() && !cut_off_; ++leg) {
      cut_off_ = stride.met_at_step();
      const double radius = instance.views(robot)[leg].body.wall_radius;
      const double reduced = radius - 2.0 * TangentGraph::kRadiusReduction;
      if (reduced <= 0.0) continue;
      if (is_straight(instance, way.legs[leg], reduced) || !fits_at_ends(instance, robot, leg)) continue;
      out_of_sight[radius].push_back({robot, ways.size() - 1, leg});
    }
  }
  if (out_of_sight.empty() || cut_off_) return;
  cut_off_ = stop.met();
  if (!cut_off_) improve(instance, out_of_sight, ways, costs, stop);
}

void TautPathBounds::improve(const Instance& instance, const LegsByRadius& out_of_sight,
                             std::vector<Way>& ways, const std::vector<double>& costs,
                             const StopCondition& stop) {
  std::int64_t work = kMaxWork;
  CornerVisibility corners(instance.problem().grid(), out_of_sight.begin()->first,
                           out_of_sight.rbegin()->first, stop);
  cut_off_ = corners.stopped();
  if (cut_off_) return;
  for (const auto& [radius, group] : out_of_sight) {
    // Of all lattices or, if the options ask for one spacing, of the only one.
    const bool at_centers =
        stops_at_cell_centers(instance.lattice(group.front().robot), instance.problem().grid());
    TautPathSearch search(corners, instance.sight_past_walls(), radius, at_centers);
    work -= corners.count();  // the memory that the search allocates counts as work
    for (const LegIndex& index : group) {
      if (corners.stopped() || stop.met()) {
        cut_off_ = true;
        return;
      }
      if (work <= 0) return;
      Way& way = ways[index.way];
      const Itinerary& itinerary = instance.itinerary(index.robot);
      const double max_seconds = way.max_seconds(itinerary, index.leg, costs[index.robot]);
      const std::int64_t before = search.work();
      const GoalLeg& leg = way.legs[index.leg];
      const Body body = without_turns_if_reversing(instance.views(index.robot)[index.leg].body);
      const TautPathResult result = search.run(leg, body, max_seconds, work / kWorkDivisor, stop);
      work -= search.work() - before;
      const double turn = instance.body(index.robot).may_reverse && leg.heading && leg.to.theta
                              ? instance.body(index.robot).rotation_time(*leg.heading, *leg.to.theta)
                              : 0.0;
      // The bound without obstacles holds as well.
      way.seconds[index.leg] = std::max(way.seconds[index.leg], result.seconds + turn);
      seconds_[index.robot] = end_after(itinerary, way.seconds);
      cut_off_ = cut_off_ || result.cut_off;
    }
  }
}

}  // namespace fleetplan::core
