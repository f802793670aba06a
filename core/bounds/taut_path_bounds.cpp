#include "core/bounds/taut_path_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>

#include "core/bounds/corner_visibility.h"
#include "core/bounds/lower_bound.h"
#include "core/bounds/tangent_graph.h"
#include "core/bounds/taut_path_search.h"

namespace fleetplan::core {
namespace {

/// The work for all robots of a request together (see TautPathSearch::work),
/// 0.3 to 0.5 s.
constexpr std::int64_t kMaxWork = 30'000'000;
/// One robot may use the remaining work divided by this, since the first ones also compute what others share.
constexpr std::int64_t kWorkDivisor = 64;
/// Legs between two checks of the stop condition while it is found out which ones are straight.
constexpr std::int64_t kLegsBetweenStops = 64;

/// Whether the robot's disk is clear of obstacles at both ends of a leg. Elsewhere it always is.
bool fits_at_ends(const Instance& instance, std::size_t robot, std::size_t leg) {
  const double radius = instance.motion(robot, leg).radius;
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  const auto fits_at = [&](const Goal& goal) {
    return instance.radius_at_goal(robot, goal.position, leg) == radius;
  };
  const bool fits_at_begin = leg == 0 ? instance.fits_at_start(robot) : fits_at(goals[leg - 1]);
  return fits_at_begin && fits_at(goals[leg]);
}

/// A robot that may reverse need not turn as much as a taut path does: only its length and waits, and the
/// difference of the headings at its ends, bound the cost.
Motion without_turns_if_reversing(Motion motion) {
  if (!motion.may_reverse) return motion;
  motion.angular_speed = std::numeric_limits<double>::infinity();
  motion.may_reverse = false;
  return motion;
}

bool is_straight(const Instance& instance, const GoalLeg& leg, double radius) {
  return instance.sight().may_sweep(leg.from, leg.to.position, radius);
}

/// Whether all vertices of the lattice are centres of cells.
bool stops_at_cell_centers(const Instance& instance) {
  const double cells = instance.lattice().spacing() / instance.problem().grid().resolution();
  const double odd = 2.0 * std::round(0.5 * (cells - 1.0)) + 1.0;
  return std::abs(cells - odd) <= 1e-9 * cells;
}

}  // namespace

/// The legs of a robot, and lower bounds of their durations.
struct TautPathBounds::Way {
  std::vector<GoalLeg> legs;
  std::vector<double> seconds;  // by leg

  Way(const Itinerary& itinerary, const Motion& motion) : legs(legs_of(itinerary)) {
    for (const GoalLeg& leg : legs) seconds.push_back(lower_bound(leg, motion));
  }
  /// At most so much does the leg take in the cheapest plan, if there is one of this cost.
  double most_seconds(const Itinerary& itinerary, std::size_t leg, double cost) const {
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
  LegsByRadius out_of_sight;  // to share tangents
  std::vector<Way> ways;
  std::int64_t tested = 0;
  for (const std::size_t robot : robots) {
    const Motion& motion = instance.motion(robot);
    const Way& way = ways.emplace_back(instance.itinerary(robot), motion);
    seconds_[robot] = end_after(instance.itinerary(robot), way.seconds);
    for (std::size_t leg = 0; leg < way.legs.size() && !cut_off_; ++leg) {
      if (++tested % kLegsBetweenStops == 0) cut_off_ = stop.met();
      const double radius = instance.motion(robot, leg).radius;
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
    TautPathSearch search(corners, instance.sight(), radius, stops_at_cell_centers(instance));
    work -= corners.count();  // for the memory that the search allocates
    for (const LegIndex& index : group) {
      if (corners.stopped() || stop.met()) {
        cut_off_ = true;
        return;
      }
      if (work <= 0) return;
      Way& way = ways[index.way];
      const Itinerary& itinerary = instance.itinerary(index.robot);
      const double most = way.most_seconds(itinerary, index.leg, costs[index.robot]);
      const std::int64_t before = search.work();
      const GoalLeg& leg = way.legs[index.leg];
      const Motion motion = without_turns_if_reversing(instance.motion(index.robot, index.leg));
      const TautPathResult result = search.run(leg, motion, most, work / kWorkDivisor, stop);
      work -= search.work() - before;
      const double turn = instance.motion(index.robot).may_reverse && leg.heading && leg.to.theta
                              ? instance.motion(index.robot).rotation_time(*leg.heading, *leg.to.theta)
                              : 0.0;
      // Never below what holds without obstacles.
      way.seconds[index.leg] = std::max(way.seconds[index.leg], result.seconds + turn);
      seconds_[index.robot] = end_after(itinerary, way.seconds);
      cut_off_ = cut_off_ || result.cut_off;
    }
  }
}

}  // namespace fleetplan::core
