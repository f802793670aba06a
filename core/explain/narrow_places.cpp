#include "core/explain/narrow_places.h"

#include <cstdint>
#include <new>
#include <utility>
#include <variant>

#include "core/compile/instance.h"

namespace fleetplan::core {
namespace {

/// Steps of Enclosure for one flood, and for all robots together: about 50 ms.
constexpr std::int64_t kStepsOfAFlood = 50'000;
constexpr std::int64_t kMaxSteps = 1'000'000;
/// The most robots that are examined.
constexpr int kMaxRobots = 20;

std::optional<NarrowPlace> narrow_place(const Problem& problem, const PlanOptions& options, std::size_t robot,
                                        std::int64_t& left, const StopCondition& stop) {
  const auto made = Problem::create(problem.map(), {problem.robots()[robot]}, conditions_of(options), stop);
  const auto* alone = std::get_if<Problem>(&made);
  if (alone == nullptr) return std::nullopt;
  const Instance instance(*alone, options, stop);
  return Enclosure(instance, 0, {}, stop).narrowest_place(kStepsOfAFlood, left);
}

}  // namespace

std::vector<std::optional<NarrowPlace>> narrow_places(const Problem& problem, const PlanOptions& options,
                                                      const std::vector<Unplanned>& unplanned,
                                                      const StopCondition& stop) {
  std::vector<std::optional<NarrowPlace>> found(unplanned.size());
  std::int64_t left = kMaxSteps;
  int robots = 0;
  for (std::size_t k = 0; k < unplanned.size(); ++k) {
    const Robot& robot = problem.robots()[unplanned[k].robot];
    if (unplanned[k].reason != Unplanned::Reason::goal_unreachable || !robot.goal || robot.is_idle())
      continue;
    if (left <= 0 || ++robots > kMaxRobots || stop.met()) break;
    try {
      found[k] = narrow_place(problem, options, unplanned[k].robot, left, stop);
    } catch (const std::bad_alloc&) {  // not granted to the job: the others have no places
      break;
    }
  }
  return found;
}

}  // namespace fleetplan::core
