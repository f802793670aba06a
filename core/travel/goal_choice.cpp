#include "core/travel/goal_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <variant>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/travel/assignment.h"
#include "core/travel/travel_times.h"

namespace fleetplan::core {
namespace {

/// Seconds: the cost of a pose that a robot without a way to it, or one that is parked there, makes useless,
/// but which is better than none.
constexpr double kUseless = 1e9;
/// Seconds: the cost of leaving the pose to which the robot has been going. It is no reason to crowd others
/// out.
constexpr double kChangeOfMind = 1e6;
/// How many of the goals that follow an open one count when a pose is chosen for it.
constexpr std::size_t kGoalsAhead = 8;
/// How often two last goals that overlap are told apart by forbidding one of them.
constexpr int kMostConflicts = 64;
/// How many positions are tried after that, one robot after the other.
constexpr int kMostTries = 20'000;

/// When a robot that takes a pose would rest there, and when it would rest at the last goal before its next
/// open one; seconds.
struct Times {
  double arrives = kForever;
  double ends = kForever;
};

/// Returns the times of each place, by its poses; none if it is stopped.
using TimesOf =
    std::function<std::optional<std::vector<std::vector<Times>>>(const std::vector<OpenPlace>& places)>;

/// Goals from `first` to the next open one that is not settled, or to the end of those with a pose; the first
/// kGoalsAhead of them.
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

/// The pose at which the previous plan of a robot ends, or its commitment, by its index; none if there are
/// none, or if they end elsewhere.
std::optional<std::size_t> pose_so_far(const Robot& robot, const OpenGoal& open) {
  if (!robot.previous && robot.committed.empty()) return std::nullopt;
  const bool goes_on = robot.previous && !robot.previous->empty();
  const Pose end = goes_on ? robot.previous->back().to : robot.committed_end();
  for (std::size_t k = 0; k < open.poses.size(); ++k) {
    if (is_in_pose(end, {open.poses[k].position, open.poses[k].theta})) return k;
  }
  return std::nullopt;
}

/// Chooses poses with given times.
class Chooser {
 public:
  Chooser(std::vector<Robot>& robots, OpenGoals& open, const TimesOf& times_of, const StopCondition& stop)
      : robots_(robots), open_(open), times_of_(times_of), stop_(stop) {}

  /// Returns the places that get no pose; none if it is stopped.
  std::optional<std::vector<OpenPlace>> run() {
    std::vector<std::size_t> next(robots_.size(), 0);
    while (true) {
      const std::vector<OpenPlace> places = next_places(next);
      if (places.empty()) break;
      if (stop_.met() || !choose_in_turn(places)) return std::nullopt;
    }
    return choose_last();
  }

 private:
  OpenGoal& open_of(const OpenPlace& place) { return open_[place.robot][place.open]; }
  Robot& robot_of(const OpenPlace& place) { return robots_[place.robot]; }
  const Goal& goal_of(const OpenPlace& place) { return robot_of(place).goal_at(open_of(place).goal); }

  /// The next open goal of each robot at which it does not stay.
  std::vector<OpenPlace> next_places(std::vector<std::size_t>& next) {
    // Bounded: the goals of all robots, each once in all.
    std::vector<OpenPlace> places;
    for (std::size_t robot = 0; robot < robots_.size(); ++robot) {
      std::size_t& at = next[robot];
      while (at < open_[robot].size() && open_[robot][at].is_settled) ++at;
      if (at == open_[robot].size() || stays_at(robots_[robot], open_[robot][at].goal)) continue;
      places.push_back({robot, at++});
    }
    return places;
  }

  /// One robot after the other, the one that ends first by the best of its poses first. Each waits where one
  /// before it is served.
  bool choose_in_turn(const std::vector<OpenPlace>& places) {
    const auto times = times_of_(places);
    if (!times) return false;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < places.size(); ++k) {
      double best = kForever;
      for (const Times& time : (*times)[k]) best = std::min(best, time.ends);
      order.emplace_back(best, k);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [ends, k] : order) {
      if (stop_.met()) return false;
      take_earliest(places[k], (*times)[k]);
    }
    return true;
  }

  void take_earliest(const OpenPlace& place, const std::vector<Times>& times) {
    OpenGoal& open = open_of(place);
    const auto key = [&](std::size_t pose) { return key_of(open.poses[pose].position); };
    const auto wait = [&](std::size_t pose) {
      const auto free = free_from_.find(key(pose));
      return free == free_from_.end() ? 0.0 : std::max(0.0, free->second - times[pose].arrives);
    };
    std::size_t best = 0;
    double least = kForever;
    for (std::size_t pose = 0; pose < open.poses.size(); ++pose) {
      const double cost = std::min(times[pose].ends, kUseless) + open.poses[pose].bias +
                          (times[pose].arrives < kForever ? wait(pose) : 0.0);
      if (!(cost < least)) continue;
      least = cost;
      best = pose;
    }
    choose(robot_of(place), open, best);
    if (times[best].arrives == kForever) return;
    const Goal& goal = goal_of(place);
    double& free = free_from_[key(best)];
    free = std::max({times[best].arrives, free, goal.not_before}) + goal.service;
  }

  /// All at once, for robots that stay.
  std::optional<std::vector<OpenPlace>> choose_last() {
    for (std::size_t robot = 0; robot < robots_.size(); ++robot) {
      const std::vector<OpenGoal>& open = open_[robot];
      if (open.empty() || open.back().is_settled || !stays_at(robots_[robot], open.back().goal)) continue;
      last_.push_back({robot, open.size() - 1});
    }
    if (last_.empty()) return std::vector<OpenPlace>();
    const auto times = times_of_(last_);
    if (!times || !make_costs(*times)) return std::nullopt;
    bool overlaps = true;
    for (int round = 0; round < kMostConflicts && overlaps; ++round) {
      auto columns = assign(costs_, std::vector<std::int64_t>(last_.size(), 1), stop_);
      if (!columns) return std::nullopt;
      columns_of_ = std::move(*columns);
      overlaps = forbid_overlap();
    }
    if (overlaps || std::count(columns_of_.begin(), columns_of_.end(), std::nullopt) > 0) {
      for (const auto& [row, column, cost] : forbidden_) costs_[row][column] = cost;
      if (auto apart = first_apart()) columns_of_ = std::move(*apart);
    }
    std::vector<OpenPlace> without;
    for (std::size_t row = 0; row < last_.size(); ++row) {
      if (columns_of_[row]) {
        choose(robot_of(last_[row]), open_of(last_[row]), pose_at_[row][*columns_of_[row]]);
      } else {
        without.push_back(last_[row]);
      }
    }
    return without;
  }

  using Key = std::pair<double, double>;
  static Key key_of(const Position& position) { return {position.x(), position.y()}; }

  /// The costs of all places in all positions that any robot may take. False if it is stopped.
  bool make_costs(const std::vector<std::vector<Times>>& times) {
    find_others();
    std::map<Key, std::size_t> column_of;
    for (const OpenPlace& place : last_) {
      for (const Alternative& pose : open_of(place).poses) {
        if (column_of.emplace(key_of(pose.position), positions_.size()).second) {
          positions_.push_back(pose.position);
        }
      }
    }
    for (std::size_t row = 0; row < last_.size(); ++row) {
      const OpenGoal& open = open_of(last_[row]);
      const auto so_far = pose_so_far(robot_of(last_[row]), open);
      costs_.emplace_back(positions_.size(), kForever);
      pose_at_.emplace_back(positions_.size(), 0);
      for (std::size_t pose = 0; pose < open.poses.size(); ++pose) {
        if (stop_.met()) return false;
        const std::size_t column = column_of.at(key_of(open.poses[pose].position));
        const double seconds = std::min(times[row][pose].ends, kUseless) + open.poses[pose].bias;
        const double cost = robot_of(last_[row]).weight * seconds +
                            (so_far && *so_far != pose ? kChangeOfMind : 0.0) +
                            cost_of_others(last_[row], positions_[column]);
        if (!(cost < costs_[row][column])) continue;
        costs_[row][column] = cost;
        pose_at_[row][column] = pose;
      }
    }
    return true;
  }

  /// A robot that stays elsewhere than at an open goal.
  struct Other {
    std::size_t robot = 0;
    Position position{0.0, 0.0};
    double radius = 0.0;     // metres
    bool is_parked = false;  // and has no goal
  };

  void find_others() {
    std::vector<bool> is_open(robots_.size(), false);
    for (const OpenPlace& place : last_) is_open[place.robot] = true;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      const Robot& robot = robots_[k];
      if (is_open[k] || (robot.yields() && !robot.invalid)) continue;
      const bool is_parked = !robot.goal || robot.invalid;
      others_.push_back({k, is_parked ? robot.committed_end().position : robot.goal->position,
                         last_radius(robot), is_parked});
    }
  }

  /// Returns the cost of a position because of other robots: kForever at a last goal, kUseless where a robot
  /// is parked.
  double cost_of_others(const OpenPlace& place, const Position& position) {
    const double radius = last_radius(robot_of(place));
    double cost = 0.0;
    for (const Other& other : others_) {
      if (other.robot == place.robot || !overlap(position, other.position, radius + other.radius)) continue;
      if (!other.is_parked) return kForever;
      cost = kUseless;
    }
    return cost;
  }

  static bool overlap(const Position& a, const Position& b, double sum) {
    const double allowed = sum - kContactTolerance;
    return allowed > 0.0 && (a - b).squaredNorm() < allowed * allowed;
  }

  /// Forbids one of two positions that are taken and overlap. Returns whether there are such two.
  bool forbid_overlap() {
    for (std::size_t row = 0; row < last_.size(); ++row) {
      if (stop_.met()) return false;
      for (std::size_t other = 0; other < row && columns_of_[row]; ++other) {
        if (!columns_of_[other]) continue;
        if (!overlap_at(row, *columns_of_[row], other, *columns_of_[other])) continue;
        // The one that loses less, by its next best position.
        const std::size_t loser = loss(row) < loss(other) ? row : other;
        forbidden_.emplace_back(loser, *columns_of_[loser],
                                std::exchange(costs_[loser][*columns_of_[loser]], kForever));
        return true;
      }
    }
    return false;
  }

  /// Tries positions one robot after the other, the one with the fewest first, the cheapest first. None if
  /// that finds none for all of them that do not overlap.
  std::optional<std::vector<std::optional<std::size_t>>> first_apart() const {
    std::vector<std::vector<std::size_t>> options(last_.size());
    std::vector<std::size_t> order;
    for (std::size_t row = 0; row < last_.size(); ++row) {
      if (stop_.met()) return std::nullopt;
      const std::vector<double>& costs = costs_[row];
      for (std::size_t column = 0; column < costs.size(); ++column) {
        if (costs[column] < kForever) options[row].push_back(column);
      }
      std::sort(options[row].begin(), options[row].end(), [&](std::size_t a, std::size_t b) {
        return std::pair(costs[a], a) < std::pair(costs[b], b);
      });
      order.push_back(row);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return options[a].size() < options[b].size(); });
    std::vector<std::optional<std::size_t>> taken(last_.size());
    std::vector<std::size_t> next(last_.size(), 0);  // option by rank in the order
    std::size_t rank = 0;
    for (int tries = 0; rank < order.size(); ++tries) {
      if (tries == kMostTries || stop_.met()) return std::nullopt;
      const std::size_t row = order[rank];
      if (next[rank] == options[row].size()) {
        if (rank == 0) return std::nullopt;
        next[rank--] = 0;
        continue;
      }
      const std::size_t column = options[row][next[rank]++];
      const bool is_free =
          std::none_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(rank),
                       [&](std::size_t other) { return overlap_at(row, column, other, *taken[other]); });
      if (!is_free) continue;
      taken[row] = column;
      ++rank;
    }
    return taken;
  }

  bool overlap_at(std::size_t row, std::size_t column, std::size_t other, std::size_t other_column) const {
    const double sum = last_radius(robots_[last_[row].robot]) + last_radius(robots_[last_[other].robot]);
    return overlap(positions_[column], positions_[other_column], sum);
  }

  double loss(std::size_t row) const {
    double next_best = kForever;
    for (std::size_t column = 0; column < positions_.size(); ++column) {
      if (column != *columns_of_[row]) next_best = std::min(next_best, costs_[row][column]);
    }
    return next_best - costs_[row][*columns_of_[row]];
  }

  std::vector<Robot>& robots_;
  OpenGoals& open_;
  const TimesOf& times_of_;
  const StopCondition& stop_;
  std::map<Key, double> free_from_;  // by position, seconds: after those that are served there before
  // The members below are about robots that stay.
  std::vector<OpenPlace> last_;
  std::vector<Other> others_;
  std::vector<Position> positions_;
  std::vector<std::vector<double>> costs_;                               // by place and position
  std::vector<std::vector<std::size_t>> pose_at_;                        // by place and position
  std::vector<std::optional<std::size_t>> columns_of_;                   // by place: index of the position
  std::vector<std::tuple<std::size_t, std::size_t, double>> forbidden_;  // place, position, its cost before
};

/// The way in straight lines, without rotations, from where the plan of a robot begins.
std::vector<Times> straight_times(const Robot& robot, const std::vector<OpenGoal>& open, std::size_t index) {
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
  std::vector<Times> times;
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

/// The robot with the goals before this one only. One that has goals does not stand for ever after them.
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

  std::optional<std::vector<std::vector<Times>>> operator()(const std::vector<OpenPlace>& places) const {
    const auto alone = problem_until(places);
    if (!alone) return std::nullopt;
    std::vector<Task> tasks;
    for (const OpenPlace& place : places) {
      if (stop_.met()) return std::nullopt;
      add_tasks(place, tasks);
    }
    const auto arrivals = core::arrivals(*alone, options_, tasks, stop_, executor_, {});
    if (!arrivals) return std::nullopt;
    std::vector<std::vector<Times>> times;
    auto next = arrivals->begin();
    for (const OpenPlace& place : places) {
      std::vector<Times>& of_place = times.emplace_back();
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

/// The zones for robots of which each stands for one of others, see leave_out_blocked_poses().
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
  PoseCheck(const std::shared_ptr<const StaticMap>& map, const std::vector<Zone>& zones,
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
        }
      }
    }
    zones_ = zones_of(zones, stands_for_, stop);
  }

  /// By pose: the disk overlaps an obstacle or a blocked zone that nobody may leave.
  std::vector<bool> blocked() const {
    return faulty(disks_, zones_, [](const ProblemFault&) { return true; });
  }

  /// By pose: a goal there would be put off, because of a zone that nobody enters.
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
  std::vector<Zone> zones_;              // for the disks
};

}  // namespace

std::vector<OpenPlace> leave_out_blocked_poses(const std::shared_ptr<const StaticMap>& map,
                                               const std::vector<Zone>& zones, std::vector<Robot>& robots,
                                               OpenGoals& open, const StopCondition& stop) {
  const PoseCheck check(map, zones, robots, open, stop);
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
      choose(robots[robot], goal, 0);
    }
  }
  return without;
}

std::vector<OpenPlace> choose_by_distance(std::vector<Robot>& robots, OpenGoals& open,
                                          const StopCondition& stop) {
  const TimesOf times_of = [&](const std::vector<OpenPlace>& places) {
    std::vector<std::vector<Times>> times;
    for (const OpenPlace& place : places) {
      if (stop.met()) return std::optional<std::vector<std::vector<Times>>>();
      times.push_back(straight_times(robots[place.robot], open[place.robot], place.open));
    }
    return std::optional(std::move(times));
  };
  return Chooser(robots, open, times_of, stop).run().value_or(std::vector<OpenPlace>());
}

std::optional<Problem> choose_by_arrival(const Problem& problem, const PlanOptions& options,
                                         std::vector<Robot>& robots, OpenGoals& open, bool& finished,
                                         const StopCondition& stop, Executor& executor) {
  std::vector<Robot> chosen = robots;
  OpenGoals choices = open;
  const TimesAlone times_alone(problem, options, chosen, choices, stop, executor);
  const auto without = Chooser(chosen, choices, times_alone, stop).run();
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
