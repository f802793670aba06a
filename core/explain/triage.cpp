#include "core/explain/triage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "core/compile/instance.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

/// The most expansions of all robots together for paths on the map: about a tenth of a second. Other paths
/// are tested when a robot is planned for the first time.
constexpr std::int64_t kMaxMapExpansions = 50'000;

/// Disks of robots, inflation and vicinity included, by place. Finds disks that overlap another disk.
class DiskIndex {
 public:
  /// The robots' disks where their plans begin, or where they rest at their last goals.
  enum class At : std::uint8_t { start, goal };
  DiskIndex(const Instance& instance, At at);

  /// Adds the disk of a robot; at most one for each robot.
  void add(std::size_t robot, const Position& center);

  /// Returns the robots, other than `robot`, whose disks overlap the disk that `robot` has `at` this
  /// position, ascending. Contact is no overlap.
  std::vector<std::size_t> overlapping(std::size_t robot, At at, const Position& center) const;

 private:
  struct Disk {
    std::size_t robot;
    Position center;
  };

  std::int64_t bucket(double coordinate) const;
  static std::uint64_t key(std::int64_t column, std::int64_t row);

  double radius(std::size_t robot, At at) const;

  const Instance& instance_;
  const At at_;
  double size_;  // metres: side of a bucket; disks that overlap are in the same or in neighbouring buckets
  std::unordered_map<std::uint64_t, std::vector<Disk>> buckets_;
};

DiskIndex::DiskIndex(const Instance& instance, At at) : instance_(instance), at_(at), size_(0.0) {
  for (std::size_t i = 0; i < instance.size(); ++i) {
    size_ = std::max(size_, 2.0 * instance.views(i).largest_disk().pair_radius);
  }
}

double DiskIndex::radius(std::size_t robot, At at) const {
  const std::size_t stage = at == At::start ? 0 : instance_.itinerary(robot).goals.size();
  return instance_.views(robot)[stage].body.pair_radius;
}

std::int64_t DiskIndex::bucket(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / size_));
}

std::uint64_t DiskIndex::key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(column) << 32) ^ static_cast<std::uint64_t>(row);
}

void DiskIndex::add(std::size_t robot, const Position& center) {
  buckets_[key(bucket(center.x()), bucket(center.y()))].push_back({robot, center});
}

std::vector<std::size_t> DiskIndex::overlapping(std::size_t robot, At at, const Position& center) const {
  std::vector<std::size_t> found;
  const double mine = radius(robot, at);
  // Bounded: the robots, each at most once.
  for (std::int64_t column = bucket(center.x()) - 1; column <= bucket(center.x()) + 1; ++column) {
    for (std::int64_t row = bucket(center.y()) - 1; row <= bucket(center.y()) + 1; ++row) {
      const auto disks = buckets_.find(key(column, row));
      if (disks == buckets_.end()) continue;
      for (const Disk& disk : disks->second) {
        const double reach = mine + radius(disk.robot, at_) - kContactTolerance;
        const bool overlap = (disk.center - center).squaredNorm() < reach * reach;
        if (overlap && disk.robot != robot) found.push_back(disk.robot);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

class Triage {
 public:
  Triage(PlanState& state, const StopCondition& stop, const std::vector<bool>& kept)
      : reservations_(state.reservations()),
        ways_(state.ways()),
        instance_(state.instance()),
        stop_(stop),
        kept_(kept),
        unplanned_(instance_.size()),
        stays_(instance_.size(), false),
        starts_(instance_, DiskIndex::At::start),
        goals_(instance_, DiskIndex::At::goal) {}

  std::vector<std::optional<Unplanned>> run() {
    for (std::size_t i = 0; i < instance_.size(); ++i) {
      starts_.add(i, place(i));
      const Itinerary& itinerary = instance_.itinerary(i);
      if (!itinerary.is_parked() && !itinerary.is_idle) goals_.add(i, itinerary.last_goal().position);
      if (itinerary.is_invalid) {
        unplanned_[i] = unplanned_invalid(i);
        stay(i);
      } else if (itinerary.is_parked() || (itinerary.is_idle && !may_leave(i))) {
        stay(i);
      }
    }
    for_each_robot([&](std::size_t i) { check_start(i); });
    for_each_robot([&](std::size_t i) { check_goal(i); });
    for_each_robot([&](std::size_t i) { check_path(i); });
    check_goals_occupied();
    return std::move(unplanned_);
  }

 private:
  template <class Check>
  void for_each_robot(Check&& check) {
    for (std::size_t i = 0; i < instance_.size() && !stop_.met(); ++i) {
      if (!stays_[i] && !is_kept(i) && !instance_.itinerary(i).is_idle) check(i);
    }
  }
  bool may_leave(std::size_t robot) {
    const bool is_free = fits_at_start(instance_, robot) || ways_.can_leave_place(robot, stop_);
    return is_free && !instance_.contacts().too_many(robot);
  }
  bool is_kept(std::size_t robot) const { return !kept_.empty() && kept_[robot]; }
  /// The place where the robot is when its plan begins, and where it stays without one.
  const Position& place(std::size_t robot) const { return instance_.itinerary(robot).pose.position; }
  void stay(std::size_t robot) {
    stays_[robot] = true;
    reservations_.stay_in_place(robot);
  }
  void give_up(std::size_t robot, Reason reason, const char* detail,
               std::vector<std::size_t> blocked_by = {}) {
    unplanned_[robot] = Unplanned{robot, reason, detail, std::move(blocked_by)};
    stay(robot);
  }
  /// Returns the robots whose disks in the index overlap robot i at its goal and meet the condition,
  /// ascending.
  template <class Condition>
  std::vector<std::size_t> overlapping_at_goal(const DiskIndex& index, std::size_t i,
                                               Condition&& condition) const {
    std::vector<std::size_t> found =
        index.overlapping(i, DiskIndex::At::goal, instance_.itinerary(i).last_goal().position);
    std::erase_if(found, [&](std::size_t j) { return !condition(j); });
    return found;
  }

  void check_start(std::size_t i) {
    if (!fits_at_start(instance_, i) && !ways_.can_leave_place(i, stop_)) {
      return give_up(
          i, Reason::start_blocked,
          "The inflated robot does not fit between the obstacles at its start, and no straight move "
          "leads from there to where it fits.");
    }
    if (!instance_.contacts().too_many(i)) return;
    give_up(i, Reason::start_blocked, "The inflated robot overlaps too many others at its start to leave it.",
            starts_.overlapping(i, DiskIndex::At::start, place(i)));
  }

  void check_goal(std::size_t i) {
    if (!fits_at_goals(instance_, i)) {
      return give_up(i, Reason::goal_blocked,
                     "The inflated robot does not fit between the obstacles at its goal.");
    }
    if (enters_last_goal(instance_, i) && !ways_.can_enter_last_goal(i, stop_)) {
      return give_up(i, Reason::goal_blocked,
                     "The inflated robot overlaps an obstacle at its last goal, and no straight move leads "
                     "there from where it fits.");
    }
    // If the inflated goals of two robots overlap, the one with a plan is planned, or the first one in the
    // list.
    // A robot that yields leaves its last goal again.
    if (instance_.itinerary(i).yields()) return;
    auto others = overlapping_at_goal(goals_, i, [&](std::size_t j) {
      return (j < i || is_kept(j)) && !stays_[j] && !instance_.itinerary(j).yields();
    });
    if (others.empty()) return;
    give_up(i, Reason::goal_blocked, "The inflated robot overlaps another one's goal at its goal.",
            std::move(others));
  }

  void check_path(std::size_t i) {
    const std::int64_t left = kMaxMapExpansions - ways_.map_expansions();
    if (left <= 0) return;
    const Way& way = ways_.way_to_goal(i, left, stop_);
    if (way.none()) return give_up_without_way(i, way);
    if (way.kind == Way::Kind::on_lattice && !stop_.met() && ways_.takes_too_long(i, stop_)) {
      give_up(
          i, Reason::goal_unreachable,
          "The way to the goal takes longer than the longest plan: 1e8 s, or 1e9 m at the robot's speed.");
    }
  }

  void give_up_without_way(std::size_t i, const Way& way) {
    unplanned_[i] = unplanned_without_way(i, instance_.body(i).wall_radius, way);
    stay(i);
  }

  /// Makes robots stay whose goal is occupied by a robot that stays, until nothing changes.
  void check_goals_occupied() {
    for (std::size_t i = 0; i < instance_.size(); ++i) {
      if (!stays_[i] && !is_kept(i) && !instance_.itinerary(i).is_idle) next_.insert(i);
    }
    while (!next_.empty() && !stop_.met()) {
      current_ = std::exchange(next_, {});
      while (!current_.empty() && !stop_.met()) {
        const std::size_t i = *current_.begin();
        current_.erase(current_.begin());
        check_goal_occupied(i);
      }
    }
  }

  void check_goal_occupied(std::size_t i) {
    if (stays_[i] || is_kept(i)) return;
    auto others = overlapping_at_goal(starts_, i, [&](std::size_t j) { return stays_[j]; });
    if (others.empty()) return;
    give_up(i, Reason::goal_blocked, "A robot that stays where it is stands in the way at the goal.",
            std::move(others));
    // The robots whose goal it occupies are examined in the order of the list, again and again.
    for (const std::size_t j : goals_.overlapping(i, DiskIndex::At::start, place(i))) {
      if (!stays_[j]) (j > i ? current_ : next_).insert(j);
    }
  }

  FleetReservations& reservations_;
  StaticWays& ways_;
  const Instance& instance_;
  const StopCondition& stop_;
  const std::vector<bool>& kept_;  // by robot; may be empty
  std::vector<std::optional<Unplanned>> unplanned_;
  std::vector<bool> stays_;
  DiskIndex starts_;
  DiskIndex goals_;
  std::set<std::size_t> current_;  // robots whose goals are examined in this round
  std::set<std::size_t> next_;     // robots whose goals are examined in the next round
};

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

std::string missed_by_lattice(double radius, const Way& way) {
  std::string text = "The lattice has no way from the start to the goal for this robot";
  if (way.widest) {
    text += ", which needs " + metres(2.0 * radius) + "; the widest way between the obstacles has " +
            metres(*way.widest);
  }
  return text + ". A finer resolution, a smaller radius or connectivity 16 or 32 may give it one.";
}

/// The most ways that are looked for: for one robot, and for all of them.
constexpr int kMaxTestsOfRobot = 40;
constexpr int kMaxTests = 120;
/// The most expansions for one way.
constexpr std::int64_t kMaxWayExpansions = 50'000;
constexpr std::size_t kMaxNamed = 5;

using ZoneIndices = std::vector<std::size_t>;

/// Finds the zones that leave a robot no way, on a map without other robots.
class ZonesInTheWay {
 public:
  ZonesInTheWay(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : problem_(problem), options_(options), stop_(stop) {}

  /// Returns the zones that close the robot's way. Empty if there are none, or if that is not found out.
  ZoneIndices of(std::size_t robot) {
    const ZoneIndices all = zones_of(robot);
    if (all.empty() || !has_way(robot, {})) return {};
    tests_of_robot_ = 0;
    if (is_closed_by_latest(robot)) return latest_;
    ZoneIndices closing = all;
    for (const std::size_t zone : all) {
      const std::string& id = problem_.zones()[zone].id;
      if (zone > 0 && problem_.zones()[zone - 1].id == id) continue;  // parts of a mask belong together
      if (++tests_of_robot_ > kMaxTestsOfRobot || is_over()) break;
      ZoneIndices others = closing;
      std::erase_if(others, [&](std::size_t other) { return problem_.zones()[other].id == id; });
      if (!has_way(robot, others)) closing = std::move(others);
    }
    if (is_over()) return {};
    latest_ = closing;
    return closing;
  }

 private:
  bool is_over() const { return tests_ > kMaxTests || stop_.met(); }

  ZoneIndices zones_of(std::size_t robot) const {
    ZoneIndices zones;
    for (std::size_t k = 0; k < problem_.zones().size(); ++k) {
      const Zone& zone = problem_.zones()[k];
      if (zone.type != Zone::Type::speed && zone.is_for(robot)) zones.push_back(k);
    }
    return zones;
  }

  /// Whether the zones that closed the way of the robot before, which are often the same, close this robot's
  /// way.
  bool is_closed_by_latest(std::size_t robot) {
    const bool are_its = std::all_of(latest_.begin(), latest_.end(),
                                     [&](std::size_t zone) { return problem_.zones()[zone].is_for(robot); });
    return !latest_.empty() && are_its && !has_way(robot, latest_) && !is_over();
  }

  /// Whether the robot, alone on the map with these zones, may leave its start and has a way to its goal.
  /// True also if that takes too long to find out.
  bool has_way(std::size_t robot, const ZoneIndices& zones) {
    ++tests_;
    if (is_over()) return true;
    ProblemConditions conditions = conditions_of(options_);
    for (const std::size_t zone : zones) {
      conditions.zones.push_back(problem_.zones()[zone]);
      conditions.zones.back().robots.clear();
    }
    const auto made =
        Problem::create(problem_.map(), {problem_.robots()[robot]}, std::move(conditions), stop_);
    const auto* alone = std::get_if<Problem>(&made);
    if (alone == nullptr) return true;
    const Instance instance(*alone, options_, stop_);
    PlanState state(instance);
    if (!fits_at_start(instance, 0) && !state.ways().can_leave_place(0, stop_)) return false;
    return fits_at_goals(instance, 0) && !state.ways().way_to_goal(0, kMaxWayExpansions, stop_).none();
  }

  const Problem& problem_;
  const PlanOptions& options_;
  const StopCondition& stop_;
  ZoneIndices latest_;  // the zones of the robot before
  int tests_of_robot_ = 0;
  int tests_ = 0;
};

bool may_be_because_of_zones(const Unplanned& robot) {
  const bool is_geometry = robot.reason == Unplanned::Reason::start_blocked ||
                           robot.reason == Unplanned::Reason::goal_blocked ||
                           robot.reason == Unplanned::Reason::goal_unreachable;
  return is_geometry && robot.blocked_by.empty();
}

/// Returns a sentence such as: Without the zones "a" and "b", it would have a way.
std::string sentence(ZoneIndices closing, const std::vector<Zone>& zones) {
  const auto same = [&](std::size_t a, std::size_t b) { return zones[a].id == zones[b].id; };
  closing.erase(std::unique(closing.begin(), closing.end(), same), closing.end());
  std::string names;
  const std::size_t named = std::min(closing.size(), kMaxNamed);
  for (std::size_t k = 0; k < named; ++k) {
    if (k > 0) names += k + 1 == closing.size() ? " and " : ", ";
    names += '"' + zones[closing[k]].id + '"';
  }
  if (named < closing.size()) names += " and " + std::to_string(closing.size() - named) + " more";
  return std::string("Without the ") + (closing.size() == 1 ? "zone " : "zones ") + names +
         ", the robot would have a way.";
}

}  // namespace

Unplanned unplanned_without_way(std::size_t robot, double radius, const Way& way) {
  if (!way.closed_by.empty()) {
    return {robot, Reason::blocked_by_robots,
            "Robots that stay where they are leave no way from the start to the goal.", way.closed_by};
  }
  const bool closed = way.kind == Way::Kind::closed;
  return {robot,
          Reason::goal_unreachable,
          closed ? "No way leads from the start to the goal that is wide enough for the robot."
                 : missed_by_lattice(radius, way),
          {}};
}

std::vector<std::optional<Unplanned>> triage(PlanState& state, const StopCondition& stop,
                                             const std::vector<bool>& kept) {
  return Triage(state, stop, kept).run();
}

std::vector<std::optional<Unplanned>> with_zones_named(const Problem& problem, const PlanOptions& options,
                                                       std::vector<std::optional<Unplanned>> unplanned,
                                                       const StopCondition& stop) {
  if (problem.zones().empty()) return unplanned;
  ZonesInTheWay zones(problem, options, stop);
  for (std::optional<Unplanned>& robot : unplanned) {
    if (!robot || !may_be_because_of_zones(*robot)) continue;
    try {
      const ZoneIndices closing = zones.of(robot->robot);
      if (!closing.empty()) robot->detail += ' ' + sentence(closing, problem.zones());
    } catch (const std::bad_alloc&) {  // not granted to the job: the others keep their details
      break;
    }
  }
  return unplanned;
}

}  // namespace fleetplan::core
