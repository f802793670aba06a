#include "core/search/taut_bounds.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "core/map/corner_sight.h"
#include "core/map/tangents.h"
#include "core/search/lower_bound.h"
#include "core/search/taut_search.h"

namespace fleetplan::core {
namespace {

/// Tangents that are looked at for all robots of a request together.
constexpr std::int64_t kMostSteps = 20'000'000;

bool sees_goal(const Fleet& fleet, std::size_t robot, double radius) {
  return fleet.sight().may_sweep(fleet.robot(robot).start.position, fleet.robot(robot).goal->position,
                                 radius);
}

}  // namespace

TautBounds::TautBounds(const Fleet& fleet, const std::vector<std::size_t>& robots, const StopCondition& stop)
    : seconds_(fleet.size(), 0.0) {
  std::map<double, std::vector<std::size_t>> out_of_sight;  // by radius, so that tangents are shared
  std::size_t searches = 0;
  for (const std::size_t robot : robots) {
    seconds_[robot] = lower_bound(fleet.robot(robot), fleet.motion(robot));
    const double slim = fleet.motion(robot).radius - 2.0 * Tangents::kShrink;
    if (slim <= 0.0 || sees_goal(fleet, robot, slim)) continue;
    out_of_sight[fleet.motion(robot).radius].push_back(robot);
    ++searches;
  }
  if (searches == 0) return;
  const auto steps = kMostSteps / static_cast<std::int64_t>(searches);
  CornerSight corners(fleet.problem().grid());
  for (const auto& [radius, group] : out_of_sight) {
    TautSearch search(corners, fleet.sight(), radius);
    for (const std::size_t robot : group) {
      if (stop.met()) {
        cut_off_ = true;
        return;
      }
      const TautResult result = search.run(fleet.robot(robot), fleet.motion(robot), steps, stop);
      seconds_[robot] = result.seconds;
      cut_off_ = cut_off_ || result.cut_off;
    }
  }
}

}  // namespace fleetplan::core
