#include "core/prioritized/triage.h"

#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

class Triage {
 public:
  Triage(PlanState& state, const StopCondition& stop)
      : state_(state),
        instance_(state.instance()),
        stop_(stop),
        unplanned_(instance_.size()),
        stays_(instance_.size(), false) {}

  std::vector<std::optional<Unplanned>> run() {
    for (std::size_t i = 0; i < instance_.size(); ++i) {
      if (!instance_.robot(i).goal) stay(i);
    }
    for (std::size_t i = 0; i < instance_.size(); ++i) check_start(i);
    for (std::size_t i = 0; i < instance_.size(); ++i) check_goal(i);
    for (std::size_t i = 0; i < instance_.size(); ++i) check_path(i);
    // A robot that stays may block the goal of another one, which then stays as well.
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < instance_.size(); ++i) changed = check_goal_occupied(i) || changed;
    }
    return std::move(unplanned_);
  }

 private:
  void stay(std::size_t robot) {
    stays_[robot] = true;
    state_.stay_at_start(robot);
  }
  void give_up(std::size_t robot, Reason reason, const char* detail,
               std::vector<std::size_t> blocked_by = {}) {
    unplanned_[robot] = Unplanned{robot, reason, detail, std::move(blocked_by)};
    stay(robot);
  }
  bool overlap(std::size_t a, const Position& p, std::size_t b, const Position& q) const {
    const double reach = instance_.motion(a).radius + instance_.motion(b).radius - kContactTolerance;
    return (p - q).squaredNorm() < reach * reach;
  }
  template <class Condition>
  std::vector<std::size_t> others(std::size_t robot, Condition&& condition) const {
    std::vector<std::size_t> found;
    for (std::size_t j = 0; j < instance_.size(); ++j) {
      if (j != robot && condition(j)) found.push_back(j);
    }
    return found;
  }

  void check_start(std::size_t i) {
    if (stays_[i]) return;
    if (!instance_.fits_at_start(i) && !state_.can_leave_start(i)) {
      return give_up(
          i, Reason::start_blocked,
          "The inflated robot does not fit between the obstacles at its start, and no straight move "
          "leads from there to where it fits.");
    }
    if (!instance_.contacts().too_many(i)) return;
    give_up(i, Reason::start_blocked, "The inflated robot overlaps too many others at its start to leave it.",
            instance_.contacts().at_start(i));
  }

  void check_goal(std::size_t i) {
    if (stays_[i]) return;
    const Position& goal = instance_.robot(i).goal->position;
    if (!instance_.fits_at_goal(i)) {
      return give_up(i, Reason::goal_blocked,
                     "The inflated robot does not fit between the obstacles at its goal.");
    }
    // Of two robots whose inflated goals overlap, the first in the list is planned.
    auto overlapping = others(i, [&](std::size_t j) {
      return j < i && !stays_[j] && overlap(i, goal, j, instance_.robot(j).goal->position);
    });
    if (overlapping.empty()) return;
    give_up(i, Reason::goal_blocked, "The inflated robot overlaps another one's goal at its goal.",
            std::move(overlapping));
  }

  void check_path(std::size_t i) {
    if (stays_[i]) return;
    if (state_.goal_reachable(i, stop_)) {
      if (!stop_.met() && state_.takes_too_long(i, stop_)) {
        give_up(
            i, Reason::goal_unreachable,
            "The way to the goal takes longer than the longest plan: 1e8 s, or 1e9 m at the robot's speed.");
      }
      return;
    }
    give_up(i, Reason::goal_unreachable,
            "No way leads from the start to the goal that is wide enough for the robot.");
  }

  bool check_goal_occupied(std::size_t i) {
    if (stays_[i]) return false;
    const Position& goal = instance_.robot(i).goal->position;
    auto overlapping = others(i, [&](std::size_t j) {
      return stays_[j] && overlap(i, goal, j, instance_.robot(j).start.position);
    });
    if (overlapping.empty()) return false;
    give_up(i, Reason::goal_blocked, "A robot that stays where it is stands in the way at the goal.",
            std::move(overlapping));
    return true;
  }

  PlanState& state_;
  const Instance& instance_;
  const StopCondition& stop_;
  std::vector<std::optional<Unplanned>> unplanned_;
  std::vector<bool> stays_;
};

}  // namespace

std::vector<std::optional<Unplanned>> triage(PlanState& state, const StopCondition& stop) {
  return Triage(state, stop).run();
}

}  // namespace fleetplan::core
