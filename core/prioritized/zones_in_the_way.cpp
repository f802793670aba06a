#include "core/prioritized/zones_in_the_way.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <variant>

#include "core/instance/instance.h"
#include "core/prioritized/plan_state.h"

namespace fleetplan::core {
namespace {

/// The most ways that are looked for: for one robot, and for all of them.
constexpr int kMostTestsOfRobot = 40;
constexpr int kMostTests = 120;
/// The most expansions for one way.
constexpr std::int64_t kMostWayExpansions = 50'000;
constexpr std::size_t kMostNamed = 5;

using ZoneIndices = std::vector<std::size_t>;

/// Finds the zones that leave a robot no way, on a map without other robots.
class ZonesInTheWay {
 public:
  ZonesInTheWay(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : problem_(problem), options_(options), stop_(stop) {}

  /// Returns the zones that close the robot's way. Empty if there are none, or if that is not found out.
  ZoneIndices of(std::size_t robot) {
    const ZoneIndices all = zones_of(robot);
    if (all.empty() || !has_way(robot, {})) return {};
    tests_of_robot_ = 0;
    if (is_closed_by_latest(robot)) return latest_;
    ZoneIndices closing = all;
    for (const std::size_t zone : all) {
      const std::string& id = problem_.zones()[zone].id;
      if (zone > 0 && problem_.zones()[zone - 1].id == id) continue;  // parts of a mask belong together
      if (++tests_of_robot_ > kMostTestsOfRobot || is_over()) break;
      ZoneIndices others = closing;
      std::erase_if(others, [&](std::size_t other) { return problem_.zones()[other].id == id; });
      if (!has_way(robot, others)) closing = std::move(others);
    }
    if (is_over()) return {};
    latest_ = closing;
    return closing;
  }

 private:
  bool is_over() const { return tests_ > kMostTests || stop_.met(); }

  ZoneIndices zones_of(std::size_t robot) const {
    ZoneIndices zones;
    for (std::size_t k = 0; k < problem_.zones().size(); ++k) {
      const Zone& zone = problem_.zones()[k];
      if (zone.type != Zone::Type::speed && zone.is_for(robot)) zones.push_back(k);
    }
    return zones;
  }

  /// Whether the zones that closed the way of the robot before, which are often the same, close this robot's
  /// way.
  bool is_closed_by_latest(std::size_t robot) {
    const bool are_its = std::all_of(latest_.begin(), latest_.end(),
                                     [&](std::size_t zone) { return problem_.zones()[zone].is_for(robot); });
    return !latest_.empty() && are_its && !has_way(robot, latest_) && !is_over();
  }

  /// Whether the robot, alone on the map with these zones, may leave its start and has a way to its goal.
  /// True also if that takes too long to find out.
  bool has_way(std::size_t robot, const ZoneIndices& zones) {
    ++tests_;
    if (is_over()) return true;
    ProblemConditions conditions = conditions_of(options_);
    for (const std::size_t zone : zones) {
      conditions.zones.push_back(problem_.zones()[zone]);
      conditions.zones.back().robots.clear();
    }
    const auto made =
        Problem::create(problem_.map(), {problem_.robots()[robot]}, std::move(conditions), stop_);
    const auto* alone = std::get_if<Problem>(&made);
    if (alone == nullptr) return true;
    const Instance instance(*alone, options_, stop_);
    PlanState state(instance);
    if (!instance.fits_at_start(0) && !state.can_leave_start(0, stop_)) return false;
    return instance.fits_at_goal(0) && !state.way_to_goal(0, kMostWayExpansions, stop_).none();
  }

  const Problem& problem_;
  const PlanOptions& options_;
  const StopCondition& stop_;
  ZoneIndices latest_;  // the zones of the robot before
  int tests_of_robot_ = 0;
  int tests_ = 0;
};

bool may_be_because_of_zones(const Unplanned& robot) {
  const bool is_geometry = robot.reason == Unplanned::Reason::start_blocked ||
                           robot.reason == Unplanned::Reason::goal_blocked ||
                           robot.reason == Unplanned::Reason::goal_unreachable;
  return is_geometry && robot.blocked_by.empty();
}

/// Returns a sentence such as: Without the zones "a" and "b", it would have a way.
std::string sentence(ZoneIndices closing, const std::vector<Zone>& zones) {
  const auto same = [&](std::size_t a, std::size_t b) { return zones[a].id == zones[b].id; };
  closing.erase(std::unique(closing.begin(), closing.end(), same), closing.end());
  std::string names;
  const std::size_t named = std::min(closing.size(), kMostNamed);
  for (std::size_t k = 0; k < named; ++k) {
    if (k > 0) names += k + 1 == closing.size() ? " and " : ", ";
    names += '"' + zones[closing[k]].id + '"';
  }
  if (named < closing.size()) names += " and " + std::to_string(closing.size() - named) + " more";
  return std::string("Without the ") + (closing.size() == 1 ? "zone " : "zones ") + names +
         ", the robot would have a way.";
}

}  // namespace

std::vector<std::optional<Unplanned>> with_zones_named(const Problem& problem, const PlanOptions& options,
                                                       std::vector<std::optional<Unplanned>> unplanned,
                                                       const StopCondition& stop) {
  if (problem.zones().empty()) return unplanned;
  ZonesInTheWay zones(problem, options, stop);
  for (std::optional<Unplanned>& robot : unplanned) {
    if (!robot || !may_be_because_of_zones(*robot)) continue;
    try {
      const ZoneIndices closing = zones.of(robot->robot);
      if (!closing.empty()) robot->detail += ' ' + sentence(closing, problem.zones());
    } catch (const std::bad_alloc&) {  // not granted to the job: the others keep their details
      break;
    }
  }
  return unplanned;
}

}  // namespace fleetplan::core
