#include "core/travel/goal_choice.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/travel/travel_times.h"

namespace fleetplan::core {
namespace {

/// How many goals of a fleet are widened: each has about a hundred poses then.
constexpr std::size_t kMaxWidened = 100;
/// How many of the goals that follow an open one count when a pose is chosen for it.
constexpr std::size_t kGoalsAhead = 8;

/// Goals from `first` to the next open goal that is not settled, or to the end of the goals with a pose. At
/// most the first kGoalsAhead of them.
std::vector<Goal> goals_until_open(const Robot& robot, const std::vector<OpenGoal>& open, std::size_t first) {
  std::vector<Goal> goals;
  const std::size_t end = std::min(robot.own_goal_count(), first + kGoalsAhead);
  for (std::size_t k = first; k < end; ++k) {
    const auto is_open = [&](const OpenGoal& goal) { return goal.goal == k && !goal.is_settled; };
    if (std::any_of(open.begin(), open.end(), is_open)) break;
    goals.push_back(robot.goal_at(k));
  }
  return goals;
}

/// The way in straight lines, without rotations, from where the plan of a robot begins.
std::vector<PoseTimes> straight_times(const Robot& robot, const std::vector<OpenGoal>& open,
                                      std::size_t index) {
  const std::size_t goal = open[index].goal;
  const Itinerary itinerary = itinerary_of(robot);
  Position at = itinerary.pose.position;
  double t = itinerary.t_begin;
  Load load = loads_of(robot)[itinerary.first_goal];
  const auto serve = [&](const Goal& next) {
    t += (next.position - at).norm() / load.linear_speed;
    load = load_after(load, next);
    at = next.position;
    t = next.service_end(t);
  };
  for (std::size_t k = itinerary.first_goal; k < goal; ++k) serve(robot.goal_at(k));
  const Position before = at;
  const double leaves = t;
  const Load carried = load;
  const std::vector<Goal> after = goals_until_open(robot, open, goal + 1);
  // Bounded: a hundred poses, and kGoalsAhead.
  std::vector<PoseTimes> times;
  for (const Alternative& pose : open[index].poses) {
    const double arrives = leaves + (pose.position - before).norm() / carried.linear_speed;
    load = load_after(carried, robot.goal_at(goal));
    at = pose.position;
    t = robot.goal_at(goal).service_end(arrives);
    for (const Goal& next : after) serve(next);
    times.push_back({arrives, after.empty() ? arrives : t});
  }
  return times;
}

/// The robot with only the goals before this one. A robot that has goals does not stand for ever after them.
Robot until_goal(const Robot& robot, std::size_t goal) {
  Robot until = robot;
  until.previous.reset();
  until.goal.reset();
  until.via.clear();
  for (std::size_t k = 0; k < goal; ++k) until.via.push_back(robot.goal_at(k));
  if (goal > 0) {
    until.goal = until.via.back();
    until.via.pop_back();
  }
  if (robot.goal) until.let_yield();
  return until;
}

/// The times of robots that are alone on the map.
class TimesAlone {
 public:
  TimesAlone(const Problem& problem, const PlanOptions& options, const std::vector<Robot>& robots,
             const OpenGoals& open, const StopCondition& stop, Executor& executor)
      : problem_(problem),
        options_(options),
        robots_(robots),
        open_(open),
        stop_(stop),
        executor_(executor) {}

  std::optional<std::vector<std::vector<PoseTimes>>> operator()(const std::vector<OpenPlace>& places) const {
    const auto alone = problem_until(places);
    if (!alone) return std::nullopt;
    std::vector<Task> tasks;
    for (const OpenPlace& place : places) {
      if (stop_.met()) return std::nullopt;
      add_tasks(place, tasks);
    }
    const auto arrivals = core::arrivals(*alone, options_, tasks, stop_, executor_, {});
    if (!arrivals) return std::nullopt;
    std::vector<std::vector<PoseTimes>> times;
    auto next = arrivals->begin();
    for (const OpenPlace& place : places) {
      std::vector<PoseTimes>& of_place = times.emplace_back();
      const bool goes_on = !goals_after(place).empty();
      for (std::size_t pose = 0; pose < poses(place).size(); ++pose) {
        const double arrives = (next++)->front();
        of_place.push_back({arrives, goes_on ? (next++)->front() : arrives});
      }
    }
    return times;
  }

 private:
  const std::vector<Alternative>& poses(const OpenPlace& place) const {
    return open_[place.robot][place.open].poses;
  }
  std::vector<Goal> goals_after(const OpenPlace& place) const {
    const std::vector<OpenGoal>& open = open_[place.robot];
    return goals_until_open(robots_[place.robot], open, open[place.open].goal + 1);
  }

  /// Each pose is a task, and a second one with the goals that follow it, if there are any.
  void add_tasks(const OpenPlace& place, std::vector<Task>& tasks) const {
    const std::vector<Goal> after = goals_after(place);
    for (const Alternative& pose : poses(place)) {
      Goal goal = robots_[place.robot].goal_at(open_[place.robot][place.open].goal);
      goal.position = pose.position;
      goal.theta = pose.theta;
      tasks.push_back({{goal}, {place.robot}});
      if (after.empty()) continue;
      tasks.push_back(tasks.back());
      tasks.back().goals.insert(tasks.back().goals.end(), after.begin(), after.end());
    }
  }

  /// The robots with the goals before these places.
  std::optional<Problem> problem_until(const std::vector<OpenPlace>& places) const {
    std::vector<Robot> until;
    for (const Robot& robot : robots_) {
      if (stop_.met()) return std::nullopt;
      until.push_back(until_goal(robot, 0));
    }
    for (const OpenPlace& place : places) {
      until[place.robot] = until_goal(robots_[place.robot], open_[place.robot][place.open].goal);
    }
    ProblemConditions conditions = conditions_of(options_);
    conditions.zones = problem_.zones();
    conditions.one_at_a_time = true;
    auto made = Problem::create(problem_.map(), std::move(until), std::move(conditions), stop_);
    auto* valid = std::get_if<Problem>(&made);
    return valid != nullptr ? std::optional(std::move(*valid)) : std::nullopt;
  }

  const Problem& problem_;
  const PlanOptions& options_;
  const std::vector<Robot>& robots_;
  const OpenGoals& open_;
  const StopCondition& stop_;
  Executor& executor_;
};

/// The zones for robots each of which stands for another robot, see leave_out_blocked_poses().
std::vector<Zone> zones_of(const std::vector<Zone>& zones, const std::vector<std::size_t>& stands_for,
                           const StopCondition& stop) {
  std::vector<Zone> all = zones;
  for (Zone& zone : all) {
    if (zone.robots.empty()) continue;
    if (stop.met()) break;
    const std::vector<std::size_t> named = std::exchange(zone.robots, {});
    for (std::size_t k = 0; k < stands_for.size(); ++k) {
      if (std::binary_search(named.begin(), named.end(), stands_for[k])) zone.robots.push_back(k);
    }
    if (zone.robots.empty()) zone.robots.push_back(stands_for.size());  // nobody
  }
  return all;
}

/// Which of all poses of open goals have a place for their robots.
class PoseCheck {
 public:
  PoseCheck(const std::shared_ptr<const StaticMap>& map, const std::vector<Zone>& zones, double overlap,
            const std::vector<Robot>& robots, const OpenGoals& open, const StopCondition& stop)
      : map_(map), stop_(stop) {
    for (std::size_t robot = 0; robot < robots.size(); ++robot) {
      if (open[robot].empty()) continue;
      const std::vector<double> radii = radii_of(robots[robot]);
      for (const OpenGoal& goal : open[robot]) {
        if (stop.met()) return;
        for (const Alternative& pose : goal.poses) {
          Robot& disk = disks_.emplace_back();
          disk.radius = std::max(radii[goal.goal], radii[goal.goal + 1]);
          disk.linear_speed = disk.angular_speed = 1.0;
          disk.start = {pose.position, 0.0};
          stands_for_.push_back(robot);
          const bool may_overlap = overlap > 0.0 && stays_at(robots[robot], goal.goal);
          const double least = std::max(disk.radius - overlap, kSmallestDisk * disk.radius);
          least_radii_.push_back(may_overlap ? least : disk.radius);
        }
      }
    }
    zones_ = zones_of(zones, stands_for_, stop);
  }

  /// By pose: whether the disk overlaps an obstacle, or a blocked zone that may not be left.
  std::vector<bool> blocked() const {
    std::vector<Robot> disks = disks_;
    // Bounded: the poses of open goals.
    for (std::size_t k = 0; k < disks.size(); ++k) disks[k].radius = least_radii_[k];
    return faulty(std::move(disks), zones_, [](const ProblemFault&) { return true; });
  }

  /// By pose: whether a goal there would be put off, because of a zone that no robot may enter.
  std::vector<bool> closed() const {
    std::vector<Zone> zones = zones_;
    std::erase_if(zones,
                  [](const Zone& zone) { return zone.type != Zone::Type::blocked || !zone.may_leave; });
    if (zones.empty()) return std::vector<bool>(disks_.size(), false);
    for (Zone& zone : zones) zone.may_leave = false;
    return faulty(disks_, std::move(zones), [](const ProblemFault& fault) { return fault.zone.has_value(); });
  }

 private:
  template <class Counts>
  std::vector<bool> faulty(std::vector<Robot> disks, std::vector<Zone> zones, const Counts& counts) const {
    std::vector<bool> is_faulty(disks.size(), false);
    ProblemConditions conditions;
    conditions.zones = std::move(zones);
    conditions.one_at_a_time = true;
    conditions.list_faults_of_every_robot = true;
    const auto made = Problem::create(map_, std::move(disks), std::move(conditions), stop_);
    const auto* faults = std::get_if<ProblemFaults>(&made);
    if (faults == nullptr) return is_faulty;
    for (const ProblemFault& fault : faults->listed) {
      if (counts(fault)) is_faulty[fault.robot] = true;
    }
    return is_faulty;
  }

  const std::shared_ptr<const StaticMap>& map_;
  const StopCondition& stop_;
  std::vector<Robot> disks_;             // one for each pose, where it starts
  std::vector<std::size_t> stands_for_;  // by disk: its robot
  std::vector<double> least_radii_;      // by disk, metres: as much of it as may overlap nothing
  std::vector<Zone> zones_;              // for the disks
};

}  // namespace

std::vector<OpenPlace> leave_out_blocked_poses(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, double overlap,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop) {
  const PoseCheck check(map, zones, overlap, robots, open, stop);
  const std::vector<bool> is_blocked = check.blocked();
  const std::vector<bool> is_closed = check.closed();
  if (stop.met()) return {};
  std::vector<OpenPlace> without;
  std::size_t next = 0;
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    for (std::size_t k = 0; k < open[robot].size(); ++k) {
      OpenGoal& goal = open[robot][k];
      std::vector<Alternative> left;
      for (const Alternative& pose : goal.poses) {
        if (!is_blocked[next]) left.push_back(pose);
        if (!is_blocked[next] && is_closed[next]) left.back().bias += kUseless;
        ++next;
      }
      if (left.empty() && !goal.is_settled) without.push_back({robot, k});
      if (left.empty() || goal.is_settled) continue;
      goal.poses = std::move(left);
      goal.is_told = false;
      choose(robots[robot], goal, 0);
    }
  }
  return without;
}

std::vector<OpenPlace> choose_by_distance(std::vector<Robot>& robots, OpenGoals& open,
                                          const StopCondition& stop) {
  const TimesOf times_of = [&](const std::vector<OpenPlace>& places) {
    std::vector<std::vector<PoseTimes>> times;
    for (const OpenPlace& place : places) {
      if (stop.met()) return std::optional<std::vector<std::vector<PoseTimes>>>();
      times.push_back(straight_times(robots[place.robot], open[place.robot], place.open));
    }
    return std::optional(std::move(times));
  };
  return choose_poses(robots, open, times_of, stop).value_or(std::vector<OpenPlace>());
}

bool widen_goals(const std::shared_ptr<const StaticMap>& map, const std::vector<Zone>& zones, double overlap,
                 std::vector<Robot>& robots, OpenGoals& open, const std::vector<OpenPlace>& places,
                 const StopCondition& stop) {
  std::vector<OpenPlace> widened;
  OpenGoals wider(open.size());
  std::size_t wide = 0;
  // Bounded: the goals of the request.
  for (const std::vector<OpenGoal>& goals : open) {
    for (const OpenGoal& goal : goals) wide += goal.is_widened ? 1 : 0;
  }
  for (const OpenPlace& place : places) {
    OpenGoal& goal = open[place.robot][place.open];
    if (!goal.may_widen() || wide++ >= kMaxWidened) continue;
    widen(goal);
    widened.push_back(place);
    wider[place.robot].push_back(goal);
  }
  if (widened.empty()) return false;
  leave_out_blocked_poses(map, zones, overlap, robots, wider, stop);
  std::vector<std::size_t> next(open.size(), 0);
  for (const OpenPlace& place : widened) {
    open[place.robot][place.open] = std::move(wider[place.robot][next[place.robot]++]);
  }
  return true;
}

namespace {

/// Last goals with a tolerance at whose own pose another robot stays; of two of them, the later one.
std::vector<OpenPlace> crowded_goals(const std::vector<Robot>& robots, const OpenGoals& open,
                                     const StopCondition& stop) {
  const auto may_move_on = [&](std::size_t k) {
    return !open[k].empty() && open[k].back().may_widen() && stays_at(robots[k], open[k].back().goal);
  };
  std::vector<double> radii;
  radii.reserve(robots.size());
  for (const Robot& robot : robots) radii.push_back(last_radius(robot));
  std::vector<OpenPlace> crowded;
  const auto place_of = [](const Robot& robot) {
    return robot.goal && !robot.invalid ? robot.goal->position : robot.committed_end().position;
  };
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (!may_move_on(k)) continue;
    if (stop.met()) break;
    const auto is_crowding = [&](const Robot& other) {
      const auto index = static_cast<std::size_t>(&other - robots.data());
      if (index == k || other.yields()) return false;
      const double allowed = radii[k] + radii[index] - kContactTolerance;
      const bool is_later = index > k && may_move_on(index);
      return !is_later && (place_of(other) - place_of(robots[k])).squaredNorm() < allowed * allowed;
    };
    if (std::any_of(robots.begin(), robots.end(), is_crowding)) crowded.push_back({k, open[k].size() - 1});
  }
  return crowded;
}

}  // namespace

std::vector<WithoutPose> choose_without_search(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, const PlanOptions& options,
                                               std::vector<Robot>& robots, OpenGoals& open,
                                               const StopCondition& stop) {
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (stop.met()) return {};
    if (robots[k].invalid) open[k].clear();
    if (open[k].empty()) continue;
    const auto& previous = robots[k].previous;
    settle_by_actions(robots[k], open[k], robots[k].committed, false, stop);
    if (previous) settle_by_actions(robots[k], open[k], *previous, false, stop);
  }
  std::vector<WithoutPose> without;
  const auto add = [&](const std::vector<OpenPlace>& places, bool any_fits) {
    for (const OpenPlace& place : places) {
      const bool keeps_its_own = open[place.robot][place.open].tolerance > 0.0;
      if (!keeps_its_own) without.push_back({place, any_fits});
    }
  };
  const double overlap = conditions_of(options).wall_overlap_at_goal;
  const std::vector<OpenPlace> blocked = leave_out_blocked_poses(map, zones, overlap, robots, open, stop);
  add(blocked, false);
  if (!without.empty() || stop.met()) return without;
  widen_goals(map, zones, overlap, robots, open, blocked, stop);
  std::vector<OpenPlace> taken = choose_by_distance(robots, open, stop);
  const auto widen_crowded = [&] {
    return widen_goals(map, zones, overlap, robots, open, crowded_goals(robots, open, stop), stop);
  };
  // Bounded: each goal is widened once.
  while (!stop.met() && widen_crowded()) {
    taken = choose_by_distance(robots, open, stop);
  }
  add(taken, true);
  return without;
}

std::optional<Problem> choose_by_arrival(const Problem& problem, const PlanOptions& options,
                                         std::vector<Robot>& robots, OpenGoals& open, bool& finished,
                                         const StopCondition& stop, Executor& executor) {
  std::vector<Robot> chosen = robots;
  OpenGoals choices = open;
  const TimesAlone times_alone(problem, options, chosen, choices, stop, executor);
  const auto without = choose_poses(chosen, choices, times_alone, stop);
  finished = without.has_value();
  if (!without || !without->empty()) return std::nullopt;
  const auto is_same = [](const OpenGoal& a, const OpenGoal& b) { return a.chosen == b.chosen; };
  const auto are_same = [&](const std::vector<OpenGoal>& a, const std::vector<OpenGoal>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), is_same);
  };
  if (std::equal(open.begin(), open.end(), choices.begin(), are_same)) return std::nullopt;
  ProblemConditions conditions = conditions_of(options);
  conditions.zones = problem.zones();
  conditions.obstacles = problem.obstacles();
  auto made = Problem::create(problem.map(), chosen, std::move(conditions), stop);
  auto* valid = std::get_if<Problem>(&made);
  if (valid == nullptr) {
    finished = std::get<ProblemFaults>(made).finished;
    return std::nullopt;
  }
  robots = std::move(chosen);
  open = std::move(choices);
  return std::move(*valid);
}

bool give_up_poses(std::vector<OpenGoal>& open) {
  bool has_others = false;
  for (OpenGoal& goal : open) {
    if (goal.is_settled || goal.poses.size() < 2) continue;
    goal.poses[goal.chosen].bias += kUseless;
    has_others = true;
  }
  return has_others;
}

}  // namespace fleetplan::core
