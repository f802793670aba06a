#include "core/meetings.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "core/geometry/overlap.h"
#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/most_meetings.h"
#include "core/reservation/motion_tree.h"

namespace fleetplan::core {
namespace {

/// Seconds; overlaps with a shorter pause are one.
constexpr double kApart = 1e-6;

std::vector<MovingDisk> obstacle_motion(const MovingObstacle& obstacle) {
  std::vector<MovingDisk> motion;
  const auto& entries = obstacle.motion;
  for (std::size_t k = 0; k + 1 < entries.size(); ++k) {
    motion.emplace_back(
        TimedSegment{{entries[k].position, entries[k + 1].position}, entries[k].t, entries[k + 1].t});
  }
  const MovingObstacle::Entry& last = entries.back();
  const double until = obstacle.after == MovingObstacle::After::stays ? kForever : last.t;
  motion.emplace_back(TimedSegment{{last.position, last.position}, last.t, until});
  return motion;
}

class MeetingSearch {
 public:
  MeetingSearch(const Problem& problem, const std::vector<bool>& planned)
      : problem_(problem), planned_(planned) {
    enter_all();
    const OccupancyGrid& grid = problem.grid();
    double largest = 0.0;
    for (const Robot& robot : problem.robots()) largest = std::max(largest, robot.radius);
    tree_ = MotionTree(std::move(disks_), {grid.width(), grid.height(), largest}, {});
  }

  UnavoidableMeetings run() {
    UnavoidableMeetings result;
    result.while_staying.resize(problem_.robots().size(), false);
    for (std::size_t i = 0; i < problem_.robots().size(); ++i) {
      overlaps_.clear();
      meets_while_staying_ = false;
      search(i);
      result.while_staying[i] = meets_while_staying_;
      add_first_of(i, result.meetings);
    }
    std::sort(result.meetings.begin(), result.meetings.end(), [](const Meeting& a, const Meeting& b) {
      return std::tie(a.t, a.robot, a.obstacle, a.other) < std::tie(b.t, b.robot, b.obstacle, b.other);
    });
    return result;
  }

 private:
  struct Owner {
    bool is_obstacle;
    std::size_t index;
    bool operator<(const Owner& other) const {
      return std::tie(is_obstacle, index) < std::tie(other.is_obstacle, other.index);
    }
  };

  void enter(const MovingDisk& disk, double radius, const Owner& owner) {
    disks_.push_back({disk, radius});
    owners_.push_back(owner);
  }

  void enter_all() {
    const auto& obstacles = problem_.obstacles();
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      for (const MovingDisk& disk : obstacle_motion(obstacles[i]))
        enter(disk, obstacles[i].radius, {true, i});
    }
    const auto& robots = problem_.robots();
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const Itinerary itinerary = itinerary_of(robots[i]);
      stays_.push_back({{itinerary.pose.position, itinerary.pose.position}, itinerary.t_begin, kForever});
      committed_.emplace_back();
      for (TimedSegment segment : timed_segments(itinerary.committed)) {
        if (segment.t_start >= itinerary.t_begin) break;
        segment.t_end = std::min(segment.t_end, itinerary.t_begin);
        committed_.back().emplace_back(segment);
        enter(committed_.back().back(), robots[i].radius, {false, i});
      }
    }
  }

  void search(std::size_t robot) {
    for (const MovingDisk& disk : committed_[robot]) {
      visit(robot, disk, [&](const Owner& owner, const OverlapTime& met) {
        if (owner.is_obstacle) overlaps_[owner].push_back(met);
      });
    }
    if (planned_[robot]) return;
    visit(robot, MovingDisk(stays_[robot]), [&](const Owner& owner, const OverlapTime& met) {
      // Robots that begin too near to each other part.
      if (!owner.is_obstacle && met.begin <= 0.0) return;
      meets_while_staying_ = true;
      overlaps_[owner].push_back(met);
    });
  }

  template <class Found>
  void visit(std::size_t robot, const MovingDisk& mine, const Found& found) {
    const double radius = problem_.robots()[robot].radius;
    tree_.visit(mine, radius, 0.0, [&](std::size_t k) {
      const Owner& owner = owners_[k];
      if (!owner.is_obstacle && owner.index == robot) return true;
      const auto met = overlap(mine, tree_[k].motion, radius + tree_[k].radius - kContactTolerance);
      if (met) found(owner, *met);
      return true;
    });
  }

  /// An overlap that lasts through several parts of a motion is one meeting.
  static std::vector<double> begins(std::vector<OverlapTime> overlaps) {
    std::sort(overlaps.begin(), overlaps.end(),
              [](const OverlapTime& a, const OverlapTime& b) { return a.begin < b.begin; });
    std::vector<double> begins;
    double end = -1.0;
    for (const OverlapTime& next : overlaps) {
      if (begins.empty() || next.begin > end + kApart) begins.push_back(next.begin);
      end = std::max(end, next.end);
    }
    return begins;
  }

  void add_first_of(std::size_t robot, std::vector<Meeting>& meetings) const {
    std::vector<Meeting> all;
    for (const auto& [owner, overlaps] : overlaps_) {
      for (const double t : begins(overlaps)) {
        Meeting meeting{robot, std::nullopt, std::nullopt, t};
        (owner.is_obstacle ? meeting.obstacle : meeting.other) = owner.index;
        all.push_back(meeting);
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Meeting& a, const Meeting& b) { return a.t < b.t; });
    if (all.size() > kMostMeetingsOfRobot) all.resize(kMostMeetingsOfRobot);
    meetings.insert(meetings.end(), all.begin(), all.end());
  }

  const Problem& problem_;
  const std::vector<bool>& planned_;
  std::vector<MotionTree::Disk> disks_;  // until they are in the tree
  std::vector<Owner> owners_;            // of the disks
  MotionTree tree_;
  std::vector<TimedSegment> stays_;                     // by robot
  std::vector<std::vector<MovingDisk>> committed_;      // by robot
  std::map<Owner, std::vector<OverlapTime>> overlaps_;  // of one robot
  bool meets_while_staying_ = false;
};

}  // namespace

UnavoidableMeetings unavoidable_meetings(const Problem& problem, const std::vector<bool>& planned) {
  const bool any_committed =
      std::any_of(problem.robots().begin(), problem.robots().end(),
                  [](const Robot& robot) { return !robot.committed.empty() && !robot.invalid; });
  if (problem.obstacles().empty() && !any_committed) return {};
  UnavoidableMeetings result = MeetingSearch(problem, planned).run();
  if (result.meetings.empty()) result.while_staying.clear();
  return result;
}

}  // namespace fleetplan::core
