#include "core/travel/pose_choice.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/travel/assignment.h"

namespace fleetplan::core {
namespace {

/// Seconds: the cost of leaving the pose to which the robot has been going. It is no reason to crowd others
/// out, but one not to return to the own pose of a goal with a tolerance.
constexpr double kChangeOfMind = 1e6;
/// How often two last goals that overlap are told apart by forbidding one of them.
constexpr int kMaxConflicts = 64;
/// How many positions are tried after that, one robot after the other.
constexpr int kMaxTries = 20'000;

/// The index of the pose at which a robot's previous plan or its commitment ends. None if there is neither,
/// or if they end elsewhere.
std::optional<std::size_t> pose_so_far(const Robot& robot, const OpenGoal& open) {
  if (!robot.previous && robot.committed.empty()) return std::nullopt;
  const bool goes_on = robot.previous && !robot.previous->empty();
  const Pose end = goes_on ? robot.previous->back().to : robot.committed_end();
  for (std::size_t k = 0; k < open.poses.size(); ++k) {
    if (is_in_pose(end, {open.poses[k].position, open.poses[k].theta})) return k;
  }
  return std::nullopt;
}

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
      while (at < open_[robot].size() && open_[robot][at].is_fixed()) ++at;
      if (at == open_[robot].size() || stays_at(robots_[robot], open_[robot][at].goal)) continue;
      places.push_back({robot, at++});
    }
    return places;
  }

  /// One robot after the other. The robot that ends first at the best of its poses comes first. Each robot
  /// waits while a robot before it is served.
  bool choose_in_turn(const std::vector<OpenPlace>& places) {
    const auto times = times_of_(places);
    if (!times) return false;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < places.size(); ++k) {
      double best = kForever;
      for (const PoseTimes& time : (*times)[k]) best = std::min(best, time.ends);
      order.emplace_back(best, k);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [ends, k] : order) {
      if (stop_.met()) return false;
      take_earliest(places[k], (*times)[k]);
    }
    return true;
  }

  void take_earliest(const OpenPlace& place, const std::vector<PoseTimes>& times) {
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
      if (open.empty() || open.back().is_fixed() || !stays_at(robots_[robot], open.back().goal)) continue;
      last_.push_back({robot, open.size() - 1});
    }
    if (last_.empty()) return std::vector<OpenPlace>();
    const auto times = times_of_(last_);
    if (!times || !make_costs(*times)) return std::nullopt;
    bool overlaps = true;
    for (int round = 0; round < kMaxConflicts && overlaps; ++round) {
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
  bool make_costs(const std::vector<std::vector<PoseTimes>>& times) {
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
        // The row that loses less with its next best position.
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
      if (tries == kMaxTries || stop_.met()) return std::nullopt;
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
  std::map<Key, double> free_from_;  // by position, seconds: after the robots that are served there before
  // The members below are about robots that stay.
  std::vector<OpenPlace> last_;
  std::vector<Other> others_;
  std::vector<Position> positions_;
  std::vector<std::vector<double>> costs_;                               // by place and position
  std::vector<std::vector<std::size_t>> pose_at_;                        // by place and position
  std::vector<std::optional<std::size_t>> columns_of_;                   // by place: index of the position
  std::vector<std::tuple<std::size_t, std::size_t, double>> forbidden_;  // place, position, its cost before
};

}  // namespace

std::optional<std::vector<OpenPlace>> choose_poses(std::vector<Robot>& robots, OpenGoals& open,
                                                   const TimesOf& times_of, const StopCondition& stop) {
  return Chooser(robots, open, times_of, stop).run();
}

}  // namespace fleetplan::core
