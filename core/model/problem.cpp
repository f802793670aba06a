#include "core/model/problem.h"

#include <algorithm>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/model/committed_faults.h"
#include "core/model/loads.h"

namespace fleetplan::core {
namespace {

/// However much a start may overlap a wall, this fraction of the disk keeps clear of it.
constexpr double kClearOfWalls = 1e-3;
/// Goals of a robot between two checks of the stop condition.
constexpr std::size_t kGoalsBetweenStops = 16;

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
    if (listed_of_robot_.empty()) return faults_.listed.size() < ProblemFaults::kMostListed;
    std::size_t& of_robot = listed_of_robot_[robot];
    std::size_t& of_other = listed_of_robot_[other];
    if (std::min(of_robot, of_other) >= ProblemFaults::kMostListedOfARobot) return false;
    ++of_robot;
    if (other != robot) ++of_other;
    return true;
  }

  /// Compares the start and the goals of a robot with obstacles and the edge of the map.
  void check_obstacles(std::size_t index) {
    const Robot& robot = robots_[index];
    if (robot.invalid) return;
    const auto clear = [](double radius) { return radius - kContactTolerance + kSearchSlack; };
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
    const double overlap = conditions_.wall_overlap;
    const double radius = clear(robot.radius);
    check(robot.start.position, overlap > 0.0 ? std::max(radius - overlap, kClearOfWalls * radius) : radius,
          {ProblemFault::Kind::start_in_obstacle, index, 0, 0.0, 0, 0.0, robot.radius});
    double arrives = robot.radius;
    for (std::size_t k = 0; k < robot.goal_count(); ++k) {
      if (k % kGoalsBetweenStops == kGoalsBetweenStops - 1 && stop_.met()) {
        faults_.finished = false;
        return;
      }
      if (robot.goal_at(k).anywhere) continue;
      const double leaves = robot.goal_at(k).radius_after.value_or(arrives);
      const double larger = std::max(arrives, leaves);
      check(robot.goal_at(k).position, clear(larger),
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
  conditions.wall_overlap = std::max(0.0, options.start_overlap - options.inflation);
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
