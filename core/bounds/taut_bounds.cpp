#include "core/bounds/taut_bounds.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "core/bounds/corner_sight.h"
#include "core/bounds/lower_bound.h"
#include "core/bounds/tangents.h"
#include "core/bounds/taut_search.h"

namespace fleetplan::core {
namespace {

/// Work for all robots of a request together (see TautSearch::work), 0.3 to 0.5 s.
constexpr std::int64_t kMostWork = 30'000'000;
/// One robot may take so much of the work that is left, since the first ones also compute what they share
/// with those that follow.
constexpr std::int64_t kShare = 64;

bool sees_goal(const Instance& instance, std::size_t robot, double radius) {
  return instance.sight().may_sweep(instance.robot(robot).start.position,
                                    instance.robot(robot).goal->position, radius);
}

}  // namespace

TautBounds::TautBounds(const Instance& instance, const std::vector<std::size_t>& robots,
                       const std::vector<double>& costs, const StopCondition& stop)
    : seconds_(instance.size(), 0.0) {
  std::map<double, std::vector<std::size_t>> out_of_sight;  // by radius, so that tangents are shared
  for (const std::size_t robot : robots) {
    seconds_[robot] = lower_bound(instance.robot(robot), instance.motion(robot));
    const double slim = instance.motion(robot).radius - 2.0 * Tangents::kShrink;
    if (slim <= 0.0 || sees_goal(instance, robot, slim)) continue;
    out_of_sight[instance.motion(robot).radius].push_back(robot);
  }
  if (out_of_sight.empty()) return;
  std::int64_t work = kMostWork;
  CornerSight corners(instance.problem().grid(), out_of_sight.begin()->first, out_of_sight.rbegin()->first);
  for (const auto& [radius, group] : out_of_sight) {
    TautSearch search(corners, instance.sight(), radius);
    work -= corners.count();  // the memory that it sets up
    for (const std::size_t robot : group) {
      if (stop.met()) {
        cut_off_ = true;
        return;
      }
      if (work <= 0) return;
      const std::int64_t before = search.work();
      const TautResult result =
          search.run(instance.robot(robot), instance.motion(robot), costs[robot], work / kShare, stop);
      work -= search.work() - before;
      seconds_[robot] = result.seconds;
      cut_off_ = cut_off_ || result.cut_off;
    }
  }
}

}  // namespace fleetplan::core
