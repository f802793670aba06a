#include "core/execution/make_dependencies.h"

#include <algorithm>
#include <cstddef>
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
      : robots_(robots), rules_(rules), stop_(stop), actions_(executed_actions(robots, plans)) {}

  std::optional<Dependencies> run() {
    if (!find_stretches()) return std::nullopt;
    NearStretches index(stretches_);
    for (std::size_t robot = 0; robot < stretches_.size(); ++robot) {
      const auto near = index.near(robot, stop_);
      if (!near || !compare(robot, *near) || !index.add(robot, stop_)) return std::nullopt;
    }
    const auto kept = without_implied(std::move(found_), stop_);
    if (!kept || kept->size() + dependencies_.tight.size() > most()) return std::nullopt;
    write(*kept);
    if (stop_.met()) return std::nullopt;
    return std::move(dependencies_);
  }

 private:
  bool find_stretches() {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (stop_.met()) return false;
      stretches_.push_back(stretches_of(robots_[k], actions_[k], rules_.margins[k]));
      paces_.emplace_back(actions_[k]);
    }
    return true;
  }

  /// A robot with those that are near it somewhere. False if the stop condition is met, or if too many are
  /// found.
  bool compare(std::size_t robot, const std::vector<NearRobot>& near) {
    for (const auto& [other, pairs] : near) {
      const auto pair =
          pair_dependencies({stretches_[other], paces_[other]}, {stretches_[robot], paces_[robot]}, pairs,
                            rules_.tolerance, rules_.slack, stop_);
      if (!pair) return false;
      for (const Step& step : pair->for_second) keep(robot, other, step);
      for (const Step& step : pair->for_first) keep(other, robot, step);
      for (const Tightness& tight : pair->tight) {
        dependencies_.tight.push_back({other, robot, tight.t, tight.slack});
      }
      if (found_.size() + dependencies_.tight.size() > kMostFound) return false;
    }
    return true;
  }

  std::size_t most() const {
    std::size_t actions = 0;
    for (const Actions& of_robot : actions_) actions += of_robot.size();
    return std::min(kMostDependencies, kDependenciesOfAny + kDependenciesOfAnAction * actions);
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

  /// By the planned times of the gates.
  void write(const std::vector<WholeDependency>& kept) {
    std::vector<std::pair<double, Dependency>> timed;
    timed.reserve(kept.size());
    for (const WholeDependency& one : kept) {
      const Dependency dependency = written(one);
      timed.emplace_back(time_of(dependency.gate), dependency);
    }
    std::sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) {
      return std::tie(a.first, a.second.gate.robot, a.second.until.robot) <
             std::tie(b.first, b.second.gate.robot, b.second.until.robot);
    });
    dependencies_.list.reserve(timed.size());
    for (const auto& one : timed) dependencies_.list.push_back(one.second);
    std::sort(dependencies_.tight.begin(), dependencies_.tight.end(),
              [](const TightPair& a, const TightPair& b) {
                return std::tie(a.t, a.first, a.second) < std::tie(b.t, b.first, b.second);
              });
  }

  const std::vector<Robot>& robots_;
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
