#include "core/execution/wait_reasons.h"

#include <algorithm>
#include <utility>

#include "core/execution/executed_actions.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kGatesBetweenPolls = 256;
/// Seconds: times that differ by less are the same.
constexpr double kSameTime = 1e-6;

/// A dependency of the robot that waits.
struct Gate {
  std::size_t action = 0;  // the one that may not end, or not go on, before
  std::size_t leads = 0;   // the robot that it waits for
  double slack = 0.0;      // seconds
};

/// A wait that gives way, and for how long it does no more than that.
struct GivingWait {
  std::size_t action = 0;
  double seconds = 0.0;
};

std::vector<GivingWait> giving_waits(const Robot& robot, Actions actions, double wait_before_move) {
  const std::vector<WaitPurpose> purposes = wait_purposes(robot, actions, wait_before_move);
  std::vector<GivingWait> waits;
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const Action& action = actions[k];
    if (action.type != Action::Type::wait) continue;
    const double needed_until = std::max(action.t_start, purposes[k].not_before) + purposes[k].least;
    const double seconds = action.t_end - std::max(action.t_start, needed_until);
    if (seconds > kSameTime) waits.push_back({k, seconds});
  }
  return waits;
}

/// Returns the robots of the gates without which the wait would be shorter, the least slack first.
std::vector<std::size_t> waited_for(const GivingWait& wait, std::vector<Gate> gates, double margin) {
  std::erase_if(gates, [&](const Gate& gate) { return gate.slack >= wait.seconds + margin - kSameTime; });
  std::sort(gates.begin(), gates.end(), [](const Gate& a, const Gate& b) {
    return a.slack != b.slack ? a.slack < b.slack : a.leads < b.leads;
  });
  std::vector<std::size_t> robots;
  // Bounded: kMaxRobots.
  for (const Gate& gate : gates) {
    if (std::find(robots.begin(), robots.end(), gate.leads) != robots.end()) continue;
    if (robots.size() == WaitReason::kMaxRobots) break;
    robots.push_back(gate.leads);
  }
  return robots;
}

/// The waits of one robot with its gates, which are sorted by their actions.
std::vector<WaitReason> reasons_of(const std::vector<GivingWait>& waits, const std::vector<Gate>& gates,
                                   double margin) {
  std::vector<WaitReason> reasons;
  const auto first_at = [&](std::size_t action) {
    return std::lower_bound(gates.begin(), gates.end(), action,
                            [](const Gate& gate, std::size_t at) { return gate.action < at; });
  };
  for (std::size_t k = 0; k < waits.size(); ++k) {
    const auto begin = first_at(waits[k].action);
    const auto end = k + 1 < waits.size() ? first_at(waits[k + 1].action) : gates.end();
    std::vector<std::size_t> robots = waited_for(waits[k], {begin, end}, margin);
    if (!robots.empty()) reasons.push_back({waits[k].action, std::move(robots)});
  }
  return reasons;
}

}  // namespace

std::optional<std::vector<std::vector<WaitReason>>> wait_reasons(const std::vector<Robot>& robots,
                                                                 const std::vector<RobotPlan>& plans,
                                                                 const Dependencies& dependencies,
                                                                 double wait_before_move, double margin,
                                                                 const StopCondition& stop) {
  std::vector<std::vector<Gate>> gates(robots.size());
  StopStride stride(stop, kGatesBetweenPolls);
  for (const Dependency& one : dependencies.list) {
    if (stride.met_at_step()) return std::nullopt;
    // A gate between two actions belongs to the earlier one, which may not end before.
    const bool is_between = one.gate.fraction == 0.0 && one.gate.action > 0;
    const std::size_t action = one.gate.action - (is_between ? 1 : 0);
    gates[one.gate.robot].push_back({action, one.until.robot, one.slack});
  }
  std::vector<std::vector<WaitReason>> reasons(robots.size());
  const std::vector<Actions> actions = executed_actions(robots, plans);
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    if (stop.met()) return std::nullopt;
    std::stable_sort(gates[robot].begin(), gates[robot].end(),
                     [](const Gate& a, const Gate& b) { return a.action < b.action; });
    const auto waits = giving_waits(robots[robot], actions[robot], wait_before_move);
    reasons[robot] = reasons_of(waits, gates[robot], margin);
  }
  return reasons;
}

}  // namespace fleetplan::core
