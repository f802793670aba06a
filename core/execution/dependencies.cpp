#include "core/execution/dependencies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "core/execution/executed_actions.h"
#include "core/execution/pair_dependencies.h"
#include "core/geometry/bucket_grid.h"
#include "core/geometry/disk_motion.h"

namespace fleetplan::core {

namespace {

constexpr std::size_t kLooksBetweenPolls = 1024;
/// The most buckets, which bounds memory on huge maps.
constexpr double kMaxBuckets = 2.5e5;

double largest_radius(const std::vector<std::vector<PlannedStretch>>& by_robot) {
  double largest = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) largest = std::max(largest, stretch.radius);
  }
  return largest;
}

/// Returns a grid that covers all places of all robots.
BucketGrid grid_of(const std::vector<std::vector<PlannedStretch>>& by_robot, double radius) {
  double width = 0.0;
  double height = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) {
      width = std::max(width, stretch.planned.path.to.x());
      height = std::max(height, stretch.planned.path.to.y());
    }
  }
  const double size = std::max(
      {2.0 * radius, std::sqrt(width * height / kMaxBuckets), width / kMaxBuckets, height / kMaxBuckets});
  return {width, height, size};
}

/// A robot with stretches that are near stretches of another robot, which was added before.
struct NearRobot {
  std::size_t other = 0;
  std::vector<NearPair> pairs;
};

/// Finds the stretches of robots that are near stretches of other robots, by buckets of the plane.
class NearStretches {
 public:
  /// Indexes the stretches of robots, which are given by robot. The arguments must outlive this object.
  NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot, const StopCondition& stop)
      : by_robot_(by_robot),
        largest_radius_(largest_radius(by_robot)),
        grid_(grid_of(by_robot, largest_radius_)),
        buckets_(grid_.count()),
        stride_(stop, kLooksBetweenPolls) {}

  /// Returns the robots added before that are near this one somewhere, ascending. Returns none if the stop
  /// condition is met.
  std::optional<std::vector<NearRobot>> near(std::size_t robot) {
    std::vector<std::vector<NearPair>> by_other(by_robot_.size());
    for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
      if (!find_near(robot, index, by_other)) return std::nullopt;
    }
    std::vector<NearRobot> found;
    for (std::size_t other = 0; other < by_other.size(); ++other) {
      if (!by_other[other].empty()) found.push_back({other, std::move(by_other[other])});
    }
    return found;
  }

  /// Adds a robot's stretches to the index. Returns false if the stop condition is met.
  bool add(std::size_t robot) {
    for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
      const Segment& path = by_robot_[robot][index].planned.path;
      const auto id = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({robot, index});
      const bool added = grid_.walk(path.from, path.to, [&](std::size_t bucket, double, double) {
        buckets_[bucket].push_back(id);
        return !stride_.met_at_step();
      });
      if (!added) return false;
    }
    return true;
  }

 private:
  /// Finds the stretches near one stretch, by robot. Returns false if the stop condition is met.
  bool find_near(std::size_t robot, std::size_t stretch, std::vector<std::vector<NearPair>>& by_other) {
    const PlannedStretch& mine = by_robot_[robot][stretch];
    ++asked_;
    const auto look_into = [&](std::size_t bucket, double, double) {
      if (stride_.met_after(1 + buckets_[bucket].size())) return;
      for (const std::uint32_t id : buckets_[bucket]) {
        Entry& entry = entries_[id];
        if (entry.asked == asked_) continue;
        entry.asked = asked_;
        const PlannedStretch& other = by_robot_[entry.robot][entry.stretch];
        const NearestShares nearest = nearest_shares(other.planned.path, mine.planned.path);
        if (nearest.distance >= other.radius + mine.radius) continue;
        by_other[entry.robot].push_back(
            {static_cast<std::uint32_t>(entry.stretch), static_cast<std::uint32_t>(stretch)});
      }
    };
    // Only the place matters, so the stretch is given a duration of one second.
    grid_.cover(MovingDisk({mine.planned.path, 0.0, 1.0}), mine.radius + largest_radius_, look_into);
    return !stride_.met();
  }

  struct Entry {
    std::size_t robot = 0;
    std::size_t stretch = 0;
    std::uint64_t asked = 0;  // number of the last stretch that met this entry
  };

  const std::vector<std::vector<PlannedStretch>>& by_robot_;
  double largest_radius_ = 0.0;
  BucketGrid grid_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // indices of entries_
  std::vector<Entry> entries_;
  std::uint64_t asked_ = 0;
  StopStride stride_;  // over the entries that are examined
};

/// A dependency by whole progress: robot `waits` may not pass `gate` until robot `leads` has reached `until`.
struct WholeDependency {
  std::size_t waits = 0;
  std::size_t leads = 0;
  double gate = 0.0;
  double until = 0.0;
  double t_until = 0.0;  // the planned time of `until`, seconds
};

/// Comparisons, each of two binary searches, between two checks of the stop condition.
constexpr std::size_t kComparisonsBetweenPolls = 256;

/// The dependencies of one robot on another: a range of the list.
struct PairRange {
  std::size_t waits = 0;
  std::size_t leads = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

class Implications {
 public:
  explicit Implications(std::vector<WholeDependency> all) : all_(std::move(all)) {
    std::stable_sort(all_.begin(), all_.end(), [](const WholeDependency& a, const WholeDependency& b) {
      return std::tie(a.waits, a.leads) < std::tie(b.waits, b.leads);
    });
    for (std::size_t k = 0; k < all_.size(); ++k) {
      const bool is_same =
          !pairs_.empty() && pairs_.back().waits == all_[k].waits && pairs_.back().leads == all_[k].leads;
      if (!is_same) pairs_.push_back({all_[k].waits, all_[k].leads, k, k});
      pairs_.back().end = k + 1;
    }
  }

  const std::vector<WholeDependency>& all() const { return all_; }
  const std::vector<PairRange>& pairs() const { return pairs_; }

  /// The pairs in which this robot waits.
  std::pair<std::size_t, std::size_t> waiting(std::size_t robot) const {
    const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), robot,
                                        [](const PairRange& pair, std::size_t r) { return pair.waits < r; });
    auto end = begin;
    while (end != pairs_.end() && end->waits == robot) ++end;
    return {static_cast<std::size_t>(begin - pairs_.begin()), static_cast<std::size_t>(end - pairs_.begin())};
  }

  /// Whether the dependency follows from two others, of which the first is on a robot of `neighbours`.
  bool is_implied(const WholeDependency& one, std::pair<std::size_t, std::size_t> neighbours) const {
    for (std::size_t k = neighbours.first; k < neighbours.second; ++k) {
      if (pairs_[k].leads == one.leads) continue;
      // The last one of this pair whose gate comes first.
      const WholeDependency* between =
          last_in(pairs_[k], [&](const WholeDependency& other) { return other.gate <= one.gate; });
      if (between == nullptr || between->t_until <= one.t_until) continue;
      if (reaches(between->leads, between->until, one)) return true;
    }
    return false;
  }

 private:
  template <class Holds>
  const WholeDependency* last_in(const PairRange& pair, const Holds& holds) const {
    const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(pair.begin);
    const auto end = all_.begin() + static_cast<std::ptrdiff_t>(pair.end);
    const auto after = std::partition_point(begin, end, holds);
    return after == begin ? nullptr : &*(after - 1);
  }

  /// Whether the robot in the middle can only have made this progress after `one` is met.
  bool reaches(std::size_t middle, double progress, const WholeDependency& one) const {
    const auto pair = std::lower_bound(
        pairs_.begin(), pairs_.end(), std::pair(middle, one.leads),
        [](const PairRange& range, const auto& key) { return std::pair(range.waits, range.leads) < key; });
    if (pair == pairs_.end() || pair->waits != middle || pair->leads != one.leads) return false;
    const WholeDependency* second =
        last_in(*pair, [&](const WholeDependency& other) { return other.gate < progress; });
    return second != nullptr && second->until >= one.until;
  }

  std::vector<WholeDependency> all_;
  std::vector<PairRange> pairs_;
};

/// Returns the dependencies that no two others imply. A waits for C if A waits for B, which must first pass
/// its own gate to C. The progress of B that A waits for must be strictly beyond this gate. `all` contains
/// the dependencies of each pair of robots in ascending order of both progresses. Returns none if the stop
/// condition is met.
std::optional<std::vector<WholeDependency>> without_implied(std::vector<WholeDependency> all,
                                                            const StopCondition& stop) {
  std::vector<WholeDependency> kept;
  StopStride stride(stop, kComparisonsBetweenPolls);
  const Implications implications(std::move(all));
  for (const PairRange& pair : implications.pairs()) {
    const auto neighbours = implications.waiting(pair.waits);
    for (std::size_t k = pair.begin; k < pair.end; ++k) {
      const WholeDependency& one = implications.all()[k];
      if (stride.met_after(1 + neighbours.second - neighbours.first)) return std::nullopt;
      if (!implications.is_implied(one, neighbours)) kept.push_back(one);
    }
  }
  return kept;
}

/// Compares each robot with the robots near it, and leaves out dependencies that others imply.
class DependencyMaker {
 public:
  DependencyMaker(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                  const DependencyRules& rules, const StopCondition& stop)
      : robots_(robots), rules_(rules), stop_(stop), actions_(executed_actions(robots, plans)) {}

  std::optional<Dependencies> run() {
    if (!find_stretches()) return std::nullopt;
    NearStretches index(stretches_, stop_);
    for (std::size_t robot = 0; robot < stretches_.size(); ++robot) {
      const auto near = index.near(robot);
      if (!near || !compare(robot, *near) || !index.add(robot)) return std::nullopt;
    }
    const auto kept = without_implied(std::move(found_), stop_);
    if (!kept || kept->size() + dependencies_.tight.size() > max_count()) return std::nullopt;
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

  /// Adds the dependencies between a robot and the robots that are near it somewhere. Returns false if the
  /// stop condition is met, or if too many are found.
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
      if (found_.size() + dependencies_.tight.size() > kMaxFound) return false;
    }
    return true;
  }

  std::size_t max_count() const {
    std::size_t actions = 0;
    for (const Actions& of_robot : actions_) actions += of_robot.size();
    return std::min(kMaxDependencies, kDependenciesOfAny + kDependenciesOfAnAction * actions);
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

  /// Writes the kept dependencies to the result, by the planned times of their gates, and sorts the tight
  /// pairs.
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

std::optional<Dependencies> dependencies_in_memory(const std::vector<Robot>& robots,
                                                   const std::vector<RobotPlan>& plans,
                                                   const DependencyRules& rules, const StopCondition& stop) {
  try {
    return make_dependencies(robots, plans, rules, stop);
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

}  // namespace fleetplan::core
