#include "core/bounds/taut_path_bounds.h"

#include <algorithm>
#include <cstdint>
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

bool sees_goal(const Instance& instance, std::size_t robot, double radius) {
  return instance.sight().may_sweep(instance.itinerary(robot).pose.position,
                                    instance.robot(robot).goal->position, radius);
}

/// Whether the robot's disk is clear of obstacles at both ends. Elsewhere it always is.
bool fits_at_ends(const Instance& instance, std::size_t robot) {
  return instance.fits_at_start(robot) &&
         instance.radius_at_goal(robot, instance.robot(robot).goal->position) ==
             instance.motion(robot).radius;
}

}  // namespace

TautPathBounds::TautPathBounds(const Instance& instance, const std::vector<std::size_t>& robots,
                               const std::vector<double>& costs, const StopCondition& stop)
    : seconds_(instance.size(), 0.0) {
  RobotsByRadius out_of_sight;  // to share tangents
  for (const std::size_t robot : robots) {
    seconds_[robot] = lower_bound(instance.robot(robot), instance.motion(robot));
    if (!instance.robot(robot).committed.empty() || !instance.robot(robot).via.empty()) continue;
    const double reduced = instance.motion(robot).radius - 2.0 * TangentGraph::kRadiusReduction;
    if (reduced <= 0.0 || sees_goal(instance, robot, reduced) || !fits_at_ends(instance, robot)) continue;
    out_of_sight[instance.motion(robot).radius].push_back(robot);
  }
  if (out_of_sight.empty()) return;
  if (stop.met()) {
    cut_off_ = true;
    return;
  }
  try {
    improve(instance, out_of_sight, costs, stop);
  } catch (const std::bad_alloc&) {  // not granted to the job: the bounds so far remain
    cut_off_ = true;
  }
}

void TautPathBounds::improve(const Instance& instance, const RobotsByRadius& out_of_sight,
                             const std::vector<double>& costs, const StopCondition& stop) {
  std::int64_t work = kMaxWork;
  CornerVisibility corners(instance.problem().grid(), out_of_sight.begin()->first,
                           out_of_sight.rbegin()->first);
  for (const auto& [radius, group] : out_of_sight) {
    TautPathSearch search(corners, instance.sight(), radius);
    work -= corners.count();  // for the memory that the search allocates
    for (const std::size_t robot : group) {
      if (stop.met()) {
        cut_off_ = true;
        return;
      }
      if (work <= 0) return;
      const std::int64_t before = search.work();
      const TautPathResult result =
          search.run(instance.robot(robot), instance.motion(robot), costs[robot], work / kWorkDivisor, stop);
      work -= search.work() - before;
      seconds_[robot] = result.seconds;
      cut_off_ = cut_off_ || result.cut_off;
    }
  }
}

}  // namespace fleetplan::core
