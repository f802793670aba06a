#include "core/execution/make_dependencies.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "core/execution/executed_actions.h"
#include "core/execution/implied_dependencies.h"
#include "core/execution/near_stretches.h"
#include "core/execution/pace.h"
#include "core/execution/pair_dependencies.h"

namespace fleetplan::core {

namespace {

class DependencyMaker {
 public:
  DependencyMaker(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                  const DependencyRules& rules, const StopCondition& stop)
      : rules_(rules), stop_(stop), actions_(executed_actions(robots, plans)) {
    for (std::size_t k = 0; k < robots.size(); ++k) {
      stretches_.push_back(stretches_of(robots[k], actions_[k], rules.margins[k]));
      paces_.emplace_back(actions_[k]);
    }
  }

  std::optional<Dependencies> run() {
    NearStretches index(stretches_);
    for (std::size_t robot = 0; robot < stretches_.size(); ++robot) {
      if (stop_.met() || !compare(robot, index.near(robot))) return std::nullopt;
      index.add(robot);
    }
    const auto kept = without_implied(std::move(found_), stop_);
    if (!kept) return std::nullopt;
    for (const WholeDependency& one : *kept) dependencies_.list.push_back(written(one));
    sort();
    return std::move(dependencies_);
  }

 private:
  /// A robot with those that are near it somewhere. False if the stop condition is met.
  bool compare(std::size_t robot, const std::vector<NearPair>& near) {
    for (std::size_t begin = 0, end = 0; begin < near.size(); begin = end) {
      const std::size_t other = near[begin].other;
      while (end < near.size() && near[end].other == other) ++end;
      const auto pair = pair_dependencies(
          {stretches_[other], paces_[other]}, {stretches_[robot], paces_[robot]},
          std::span(near).subspan(begin, end - begin), rules_.tolerance, rules_.slack, stop_);
      if (!pair) return false;
      for (const Step& step : pair->for_second) keep(robot, other, step);
      for (const Step& step : pair->for_first) keep(other, robot, step);
      for (const Tightness& tight : pair->tight) {
        dependencies_.tight.push_back({other, robot, tight.t, tight.slack});
      }
    }
    return true;
  }

  void keep(std::size_t waits, std::size_t leads, const Step& step) {
    found_.push_back({waits, leads, step.gate, step.until, paces_[leads].time_at(step.until)});
  }

  Dependency written(const WholeDependency& one) const {
    const ActionProgress gate = paces_[one.waits].gate(one.waits, one.gate);
    const ActionProgress until = paces_[one.leads].until(one.leads, one.until);
    return {gate, until, time_of(gate) - time_of(until)};
  }

  double time_of(const ActionProgress& progress) const {
    return planned_time(actions_[progress.robot], progress.action, progress.fraction);
  }

  void sort() {
    const auto key = [&](const Dependency& one) {
      return std::tuple(time_of(one.gate), one.gate.robot, one.until.robot);
    };
    std::sort(dependencies_.list.begin(), dependencies_.list.end(),
              [&](const Dependency& a, const Dependency& b) { return key(a) < key(b); });
    std::sort(dependencies_.tight.begin(), dependencies_.tight.end(),
              [](const TightPair& a, const TightPair& b) {
                return std::tie(a.t, a.first, a.second) < std::tie(b.t, b.first, b.second);
              });
  }

  const DependencyRules& rules_;
  const StopCondition& stop_;
  std::vector<Actions> actions_;
  std::vector<std::vector<PlannedStretch>> stretches_;
  std::vector<Pace> paces_;
  std::vector<WholeDependency> found_;
  Dependencies dependencies_;
};

}  // namespace

std::optional<Dependencies> make_dependencies(const std::vector<Robot>& robots,
                                              const std::vector<RobotPlan>& plans,
                                              const DependencyRules& rules, const StopCondition& stop) {
  return DependencyMaker(robots, plans, rules, stop).run();
}

}  // namespace fleetplan::core
