#include "api/request/motion/parse_dependencies.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/faults.h"
#include "api/request/ranges.h"
#include "api/request/robot_names.h"
#include "core/execution/executed_actions.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kDependencyMembers{"gate", "until", "slack"};
constexpr std::array<std::string_view, 3> kProgressMembers{"robot", "action", "progress"};
constexpr Range kSlack{-kLongestTime, kLongestTime, "seconds"};

/// Seconds: what a slack that went through decimal text, or was made for rounded times, may be off.
constexpr double kSameSlack = 1e-6;

class DependencyReader {
 public:
  DependencyReader(const std::vector<core::Robot>& robots, const std::vector<core::RobotPlan>& plans)
      : actions_(core::executed_actions(robots, plans)), names_(robots) {}

  std::optional<core::Dependency> read(const JsonReader& item) const {
    const JsonReader json = item.object(kDependencyMembers);
    const JsonReader gate_member = json.require("gate");
    const JsonReader until_member = json.require("until");
    const auto gate = read_progress(gate_member);
    const auto until = read_progress(until_member);
    const JsonReader slack_member = json.find("slack");
    const auto slack = slack_member.number(kSlack);
    if (!gate || !until) return std::nullopt;
    if (gate->robot == until->robot) {
      until_member.find("robot").fault(
          fault::kDependency, "gate and until are of the same robot; a robot depends on others only.");
      return std::nullopt;
    }
    const double planned = time_of(*gate) - time_of(*until);
    if (planned <= 0.0) {
      item.fault(fault::kDependency, [&] {
        return "By the plans, the gate is passed at " + number_text(time_of(*gate)) +
               " s, not after until, which is reached at " + number_text(time_of(*until)) +
               " s: the dependencies belong to other plans; send those made for these.";
      });
    } else if (slack && std::abs(*slack - planned) > kSameSlack) {
      slack_member.fault(fault::kDependency, [&] {
        return "By the plans, the slack is " + number_text(planned) + " s, not " + number_text(*slack) +
               " s: the dependencies belong to other plans; send those made for these.";
      });
    }
    return core::Dependency{*gate, *until, planned};
  }

 private:
  double time_of(const core::ActionProgress& progress) const {
    return core::planned_time(actions_[progress.robot], progress.action, progress.fraction);
  }

  std::optional<core::ActionProgress> read_progress(const JsonReader& member) const {
    const JsonReader json = member.object(kProgressMembers);
    const JsonReader robot_member = json.require("robot");
    const JsonReader action_member = json.require("action");
    const auto robot = names_.find(robot_member);
    const auto action = action_member.natural(kGreatestIndex);
    const auto fraction = json.require("progress").number(kFraction);
    if (!robot || !action || !fraction) return std::nullopt;
    const std::size_t count = actions_[*robot].size();
    if (*action >= count) {
      action_member.fault(fault::kDependency, [&] {
        return "Robot " + in_quotes(*robot_member.string()) + " has " + std::to_string(count) +
               " actions, numbered from 0: the dependencies belong to other plans; send those made for "
               "these.";
      });
      return std::nullopt;
    }
    return core::ActionProgress{*robot, *action, *fraction};
  }

  std::vector<core::Actions> actions_;
  RobotNames names_;
};

}  // namespace

std::vector<core::Dependency> parse_dependencies(const JsonReader& member,
                                                 const std::vector<core::Robot>& robots,
                                                 const std::vector<core::RobotPlan>& plans) {
  std::vector<core::Dependency> dependencies;
  if (!member) return dependencies;
  const DependencyReader reader(robots, plans);
  const std::size_t before = member.fault_count();
  for (const JsonReader item : member.array().items()) {
    const auto dependency = reader.read(item);
    // After the first fault only faults matter.
    if (dependency && member.fault_count() == before) dependencies.push_back(*dependency);
  }
  return dependencies;
}

}  // namespace fleetplan::api
