#include "core/model/problem.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/motion_tree.h"
#include "core/geometry/tolerance.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

/// The most pairs of robots whose faults are found.
constexpr std::size_t kMaxPairs = 10'000;
/// Halvings of a move to find out where it meets a wall: below a nanometre.
constexpr int kHalvings = 60;
/// Places of a move where the overlap with a wall is measured, for the message.
constexpr int kMeasured = 16;

using Disk = MotionTree::Disk;

/// What a disk keeps from walls to be clear of them, metres.
double clear(double radius) { return radius - kContactTolerance + kSearchSlack; }

/// What it keeps at least where it may overlap them by so much, metres.
double least_disk(double radius, double overlap) {
  const double full = clear(radius);
  return overlap > 0.0 ? std::max(full - overlap, kSmallestDisk * full) : full;
}

/// Where a robot certainly is: its committed motion, and a robot that never leaves stays at its end.
std::vector<Disk> certain_motion(const Robot& robot) {
  std::vector<Disk> motion;
  if (!robot.goal || robot.invalid) {
    for (const TimedSegment& segment : timed_segments(itinerary_of(robot).committed)) {
      motion.push_back({MovingDisk(segment), robot.radius});
    }
  } else if (robot.committed_until() > 0.0) {
    for (const SizedSegment& segment : certain_segments(itinerary_of(robot))) {
      motion.push_back({MovingDisk(segment), segment.radius});
    }
  }
  return motion;
}

/// The first time and the depth of a collision.
struct Collision {
  double t = kForever;
  double gap = kForever;  // metres, negative

  void add(double begin, double least) {
    t = std::min(t, begin);
    gap = std::min(gap, least);
  }
};

/// The distance that two disks keep, in contact at the nearest.
double reach_of(const Disk& a, const Disk& b) { return a.radius + b.radius - kContactTolerance; }

/// Returns the first collision of a pair that begins too near. The pair may come no nearer until it is clear,
/// and then keeps the whole distance.
std::optional<Collision> collision_after_leaving(const std::vector<Disk>& a, const std::vector<Disk>& b) {
  const double at_first = (a.front().motion.from - b.front().motion.from).norm() - kContactTolerance;
  const double reach_at_first = reach_of(a.front(), b.front());
  bool clear = false;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const MovingDisk& mine = a[i].motion;
    const MovingDisk& theirs = b[j].motion;
    const double reach = reach_of(a[i], b[j]);
    clear = clear || reach > reach_at_first;  // one of them has grown
    const double kept = clear ? reach : at_first;
    if (const auto hit = overlap(mine, theirs, kept))
      return Collision{hit->begin, least_distance(mine, theirs) - a[i].radius - b[j].radius};
    const double end = std::min(mine.t_end, theirs.t_end);
    const auto near = overlap(mine, theirs, reach);
    clear = clear || !near || near->end < end;  // the distance is convex within a segment
    const bool mine_is_over =
        mine.t_end < theirs.t_end || (mine.t_end == theirs.t_end && (i + 1 < a.size() || j + 1 == b.size()));
    (mine_is_over ? i : j) += 1;
  }
  return std::nullopt;
}

class CommittedFaults {
 public:
  CommittedFaults(const ZoneMaps& maps, const std::vector<Robot>& robots, const ProblemConditions& conditions,
                  const StopCondition& stop)
      : maps_(maps), robots_(robots), conditions_(conditions), stop_(stop) {}

  std::vector<ProblemFault> run() {
    for (std::size_t i = 0; i < robots_.size() && !stop_.met(); ++i) {
      if (!is_committed(i)) continue;
      check_walls(i);
      if (!conditions_.zones.empty()) check_zones(i);
    }
    find_pairs();
    for (const auto& [pair, collision] : pairs_) add_pair(pair.first, pair.second, collision);
    std::stable_sort(faults_.begin(), faults_.end(),
                     [](const ProblemFault& a, const ProblemFault& b) { return a.robot < b.robot; });
    return std::move(faults_);
  }

 private:
  bool is_committed(std::size_t robot) const {
    return !robots_[robot].committed.empty() && !robots_[robot].invalid;
  }

  void check_walls(std::size_t index) {
    const Robot& robot = robots_[index];
    const LineOfSight& sight = maps_.while_leaving(index)->sight();
    double full = clear(robot.radius);
    const double least = least_disk(robot.radius, conditions_.wall_overlap);
    if (!sight.disk_fits(robot.start.position, least)) return;  // its start is at fault
    double radius = sight.fitting_radius(robot.start.position, least, full);
    const Itinerary itinerary = itinerary_of(robot);
    const std::vector<RadiusStep> steps = radius_steps(itinerary, itinerary.visited);
    auto step = steps.begin();
    double own = robot.radius;
    for (const Action& action : robot.committed) {
      if (action.type != Action::Type::translate) continue;
      if (stop_.met()) return;
      for (; step != steps.end() && step->t <= action.t_start; ++step) {
        own = step->radius;
        full = clear(own);
        radius = full;  // the goal where it changes fits
      }
      // It may be on the way into a last goal, or out of one.
      const double kept = std::min(radius, least_disk(own, conditions_.wall_overlap_at_goal));
      if (!sight.may_sweep(action.from.position, action.to.position, kept)) {
        return add_wall(index, action, own, kept);
      }
      if (sight.disk_fits(action.to.position, full)) radius = full;
    }
  }

  /// Adds a collision of a translation with a wall. `own` is the robot's radius, `radius` the radius that it
  /// has to keep, metres.
  void add_wall(std::size_t index, const Action& action, double own, double radius) {
    const LineOfSight& sight = maps_.while_leaving(index)->sight();
    const Position way = action.to.position - action.from.position;
    const auto at = [&](double fraction) { return Position(action.from.position + fraction * way); };
    double free = 0.0;
    double blocked = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (free + blocked);
      (sight.may_sweep(action.from.position, at(middle), radius) ? free : blocked) = middle;
    }
    const bool meets_wall = !maps_.map()->sight().may_sweep(action.from.position, at(blocked), radius);
    const auto zone =
        meets_wall ? std::nullopt : nearest_blocked_zone(conditions_.zones, index, at(blocked), kForever);
    const Zone* const in_zone = zone ? &conditions_.zones[zone->index] : nullptr;
    double gap = 0.0;
    for (int k = 0; k <= kMeasured && !stop_.met(); ++k) {
      const Position place = at(blocked + (1.0 - blocked) * k / kMeasured);
      const double distance = in_zone != nullptr ? distance_to_zone(*in_zone, place)
                                                 : obstacle_distance(maps_.map()->grid(), place, own);
      gap = std::min(gap, distance - own);
    }
    const double t = action.t_start + blocked * (action.t_end - action.t_start);
    ProblemFault fault{ProblemFault::Kind::committed_collision, index, index, gap, 0, t};
    if (zone) fault.zone = zone->index;
    faults_.push_back(fault);
  }

  /// Adds the first action that breaks the rule of a zone. An action that is slower than allowed is no fault.
  void check_zones(std::size_t index) {
    const Robot& robot = robots_[index];
    LoadOnTheWay on_the_way(robot);
    DriveZones zones(conditions_.zones, index, robot, on_the_way.load());
    if (zones.empty() && !changes_load(robot)) return;
    for (const Action& action : robot.committed) {
      if (stop_.met()) return;
      const auto zone = zones.broken_by(action);
      const Load before = on_the_way.load();
      on_the_way.execute(action);
      if (on_the_way.load() != before) zones = zones.with(on_the_way.load());
      if (!zone) continue;
      ProblemFault fault{ProblemFault::Kind::committed_in_zone, index, index, 0.0, 0, action.t_start};
      fault.zone = zone;
      faults_.push_back(fault);
      return;
    }
  }

  void find_pairs() {
    std::vector<Disk> disks;
    std::vector<std::uint32_t> owners;
    double largest = 0.0;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      largest = std::max(largest, largest_radius(robots_[i]));
      motions_.push_back(certain_motion(robots_[i]));
      for (const Disk& disk : motions_.back()) {
        disks.push_back(disk);
        owners.push_back(static_cast<std::uint32_t>(i));
      }
    }
    const OccupancyGrid& grid = maps_.map()->grid();
    const MotionTree tree(std::move(disks), {grid.width(), grid.height(), largest}, stop_);
    if (!tree.finished()) return;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (!is_committed(i)) continue;
      for (const Disk& mine : motions_[i]) {
        if (stop_.met() || pairs_.size() >= kMaxPairs) return;
        tree.visit(mine.motion, mine.radius, 0.0, [&](std::size_t k) {
          compare(i, mine, owners[k], tree[k]);
          return true;
        });
      }
    }
  }

  /// Compares the disks of two robots. Each pair of robots with commitments is compared once.
  void compare(std::size_t robot, const Disk& mine, std::size_t other, const Disk& theirs) {
    if (other == robot || (other > robot && is_committed(other))) return;
    const auto hit = overlap(mine.motion, theirs.motion, reach_of(mine, theirs));
    if (!hit) return;
    const double at_start = (robots_[robot].start.position - robots_[other].start.position).norm();
    const double kept = robots_[robot].radius + robots_[other].radius - kContactTolerance;
    if (at_start < kept) return compare_leaving(robot, other, at_start, kept);
    const double gap = least_distance(mine.motion, theirs.motion) - mine.radius - theirs.radius;
    pairs_[{robot, other}].add(hit->begin, gap);
  }

  void compare_leaving(std::size_t robot, std::size_t other, double at_start, double reach) {
    if (at_start < reach - conditions_.pair_overlap) return;  // the starts are at fault
    if (!leaving_.insert({robot, other}).second) return;
    if (const auto found = collision_after_leaving(motions_[robot], motions_[other])) {
      pairs_[{robot, other}] = *found;
    }
  }

  void add_pair(std::size_t robot, std::size_t other, const Collision& collision) {
    faults_.push_back({.kind = ProblemFault::Kind::committed_collision,
                       .robot = robot,
                       .other = other,
                       .gap = collision.gap,
                       .t = collision.t});
  }

  using Pair = std::pair<std::size_t, std::size_t>;  // a robot with a commitment, and another robot

  const ZoneMaps& maps_;
  const std::vector<Robot>& robots_;
  const ProblemConditions& conditions_;
  const StopCondition& stop_;
  std::vector<std::vector<Disk>> motions_;  // by robot
  std::map<Pair, Collision> pairs_;
  std::set<Pair> leaving_;  // pairs that have been compared
  std::vector<ProblemFault> faults_;
};

/// Returns, by robot, the faults of the kinds committed_collision and committed_in_zone: bare disks that
/// overlap by more than kContactTolerance.
///
/// - Two committed motions are compared while both last, to their own ends.
/// - A robot without a goal, or an invalid one, stands at its end for ever.
/// - A robot with a goal but without a commitment may leave, so it blocks no other robot.
/// - Starts that overlap by no more than the conditions allow may part. Until they are clear, such a pair
///   comes no nearer. The same holds for such a robot and a wall or a blocked zone.
/// - Starts that overlap by more are faults of another kind, and are left out.
///
/// The list is incomplete if the stop condition is met.
std::vector<ProblemFault> committed_faults(const ZoneMaps& maps, const std::vector<Robot>& robots,
                                           const ProblemConditions& conditions, const StopCondition& stop) {
  const bool any = std::any_of(robots.begin(), robots.end(),
                               [](const Robot& robot) { return !robot.committed.empty() && !robot.invalid; });
  if (!any) return {};
  return CommittedFaults(maps, robots, conditions, stop).run();
}

/// Goals of a robot between two checks of the stop condition.
constexpr std::size_t kGoalsBetweenPolls = 16;

/// Finds the faults of robot after robot. Exact distances are computed only for faults that are listed.
class FaultSearch {
 public:
  FaultSearch(const ZoneMaps& maps, const std::vector<Robot>& robots, const ProblemConditions& conditions,
              const StopCondition& stop)
      : maps_(maps), robots_(robots), conditions_(conditions), stop_(stop) {
    for (const Robot& robot : robots) last_radii_.push_back(last_radius(robot));
    if (conditions.list_faults_of_every_robot) listed_of_robot_.resize(robots.size(), 0);
  }

  ProblemFaults run() {
    const std::vector<ProblemFault> committed = committed_faults(maps_, robots_, conditions_, stop_);
    auto next = committed.begin();
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (!faults_.finished || stop_.met()) {
        faults_.finished = false;
        break;
      }
      check_obstacles(i);
      for (std::size_t j = 0; j < i && !conditions_.one_at_a_time; ++j) check_pair(j, i);
      for (; next != committed.end() && next->robot == i; ++next) add(*next, [&] { return next->gap; });
    }
    return std::move(faults_);
  }

 private:
  template <typename Gap>
  void add(ProblemFault fault, const Gap& gap) {
    ++faults_.total;
    if (!is_listed(fault.robot, is_of_a_pair(fault.kind) ? fault.other : fault.robot)) return;
    fault.gap = gap();
    faults_.listed.push_back(fault);
  }

  static bool is_of_a_pair(ProblemFault::Kind kind) {
    return kind != ProblemFault::Kind::start_in_obstacle && kind != ProblemFault::Kind::goal_in_obstacle;
  }

  /// Counts a fault of these robots. Returns whether it is to be listed.
  bool is_listed(std::size_t robot, std::size_t other) {
    if (listed_of_robot_.empty()) return faults_.listed.size() < ProblemFaults::kMaxListed;
    std::size_t& of_robot = listed_of_robot_[robot];
    std::size_t& of_other = listed_of_robot_[other];
    if (std::min(of_robot, of_other) >= ProblemFaults::kMaxListedOfARobot) return false;
    ++of_robot;
    if (other != robot) ++of_other;
    return true;
  }

  /// Compares the start and the goals of a robot with obstacles and the edge of the map.
  void check_obstacles(std::size_t index) {
    const Robot& robot = robots_[index];
    if (robot.invalid) return;
    const auto check = [&](const Position& position, double least, ProblemFault fault) {
      if (maps_.while_leaving(index)->sight().disk_fits(position, least)) return;
      const double own = fault.radius;
      if (maps_.map()->sight().disk_fits(position, least)) {
        const auto zone = nearest_blocked_zone(conditions_.zones, index, position, own);
        if (zone) fault.zone = zone->index;
        return add(fault, [&] { return (zone ? zone->distance : own) - own; });
      }
      add(fault, [&] { return obstacle_distance(maps_.map()->grid(), position, own) - own; });
    };
    check(robot.start.position, least_disk(robot.radius, conditions_.wall_overlap),
          {ProblemFault::Kind::start_in_obstacle, index, 0, 0.0, 0, 0.0, robot.radius});
    double arrives = robot.radius;
    StopStride stride(stop_, kGoalsBetweenPolls);
    for (std::size_t k = 0; k < robot.goal_count(); ++k) {
      if (stride.met_at_step()) {
        faults_.finished = false;
        return;
      }
      if (robot.goal_at(k).anywhere) continue;
      const double leaves = robot.goal_at(k).radius_after.value_or(arrives);
      const double larger = std::max(arrives, leaves);
      const bool stays = k + 1 == robot.goal_count() || conditions_.one_at_a_time;
      check(robot.goal_at(k).position, least_disk(larger, stays ? conditions_.wall_overlap_at_goal : 0.0),
            {ProblemFault::Kind::goal_in_obstacle, index, 0, 0.0, k, 0.0, larger});
      arrives = leaves;
    }
  }

  /// Compares the starts and the goals of two robots with each other.
  void check_pair(std::size_t other, std::size_t index) {
    const Robot& a = robots_[other];
    const Robot& b = robots_[index];
    if (a.invalid && b.invalid) return;
    const auto check = [&](const Position& p, const Position& q, double sum, double overlap,
                           ProblemFault::Kind kind) {
      const double allowed = sum - kContactTolerance - overlap;
      if (allowed <= 0.0 || (p - q).squaredNorm() >= allowed * allowed) return;
      add({kind, index, other}, [&] { return (p - q).norm() - sum; });
    };
    check(a.start.position, b.start.position, a.radius + b.radius, conditions_.pair_overlap,
          ProblemFault::Kind::starts_overlap);
    if (a.goal && b.goal && !a.yields() && !b.yields()) {
      check(a.goal->position, b.goal->position, last_radii_[other] + last_radii_[index], 0.0,
            ProblemFault::Kind::goals_overlap);
    }
  }

  const ZoneMaps& maps_;
  const std::vector<Robot>& robots_;
  const ProblemConditions& conditions_;
  const StopCondition& stop_;
  std::vector<double> last_radii_;            // by robot, metres, at rest at its last goal
  std::vector<std::size_t> listed_of_robot_;  // empty: the first faults of all are listed
  ProblemFaults faults_;
};

ProblemFaults unfinished() {
  ProblemFaults faults;
  faults.finished = false;
  return faults;
}

}  // namespace

ProblemConditions conditions_of(const PlanOptions& options) {
  ProblemConditions conditions;
  conditions.pair_overlap = std::max(0.0, options.start_overlap - 2.0 * options.inflation);
  conditions.wall_overlap = std::max(0.0, options.overlap_at_start() - options.inflation);
  conditions.wall_overlap_at_goal = std::max(0.0, options.goal_overlap - options.inflation);
  conditions.inflation = options.inflation;
  return conditions;
}

Problem::Problem(ZoneMaps maps, std::vector<Robot> robots, ProblemConditions conditions,
                 std::vector<Leaving> leaving)
    : maps_(std::move(maps)),
      robots_(std::move(robots)),
      obstacles_(std::move(conditions.obstacles)),
      zones_(std::move(conditions.zones)),
      leaving_(std::move(leaving)),
      one_at_a_time_(conditions.one_at_a_time) {}

std::variant<Problem, ProblemFaults> Problem::create(OccupancyGrid grid, std::vector<Robot> robots,
                                                     ProblemConditions conditions,
                                                     const StopCondition& stop) {
  auto map = static_map(std::move(grid), stop);
  if (!map) return unfinished();
  return create(std::move(map), std::move(robots), std::move(conditions), stop);
}

std::variant<Problem, ProblemFaults> Problem::create(std::shared_ptr<const StaticMap> map,
                                                     std::vector<Robot> robots, ProblemConditions conditions,
                                                     const StopCondition& stop) {
  ZoneMaps maps(std::move(map), conditions.zones, robots.size(), stop);
  if (!maps.finished()) return unfinished();
  ProblemFaults faults = FaultSearch(maps, robots, conditions, stop).run();
  if (faults.total > 0 || !faults.finished) return faults;
  auto leaving = find_ways_out(maps, conditions.zones, conditions.inflation, robots, stop);
  if (!leaving.empty() && stop.met()) return unfinished();
  return Problem(std::move(maps), std::move(robots), std::move(conditions), std::move(leaving));
}

}  // namespace fleetplan::core
