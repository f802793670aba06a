#include "core/moves/making_room.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// The expansions of each search: a robot that moves aside is seldom far from its way.
constexpr std::int64_t kMaxSearchExpansions = 20'000;
/// The places along the way of a robot where it may move aside, for each of its moves and in all. They are as
/// far from each other as the two robots in contact.
constexpr int kSitesOfAMove = 6;  // to both sides of the nearest one
constexpr std::size_t kMaxSites = 12;
/// How much farther than in contact the two robots pass, where there is room for it. In contact, each would
/// have to wait until the other robot is beside it.
constexpr double kPassingDistance = 1.1;
/// Bisections of the distance to a wall: more exact than a millimetre, for robots of up to a kilometre.
constexpr int kBisections = 20;
/// How often each robot is planned again for less cost.
constexpr int kMaxReplans = 4;
/// Seconds: a gain below this is rounding.
constexpr double kLeastGain = 1e-6;

/// A place on the way of a robot, and the direction of the way there.
struct Site {
  Position at{0.0, 0.0};
  Position ahead{0.0, 0.0};  // of length 1
};

/// The places of two robots, one on each side of a way.
struct PassingPlaces {
  Position first{0.0, 0.0};
  Position second{0.0, 0.0};
};

Position left_of(const Position& direction) { return {-direction.y(), direction.x()}; }

class MakingRoom {
 public:
  MakingRoom(PlanState& state, const std::vector<std::size_t>& robots, const StopCondition& stop,
             ProgressReport& progress)
      : state_(state),
        instance_(state.instance()),
        reservations_(state.reservations()),
        robots_(robots),
        stop_(stop),
        progress_(progress) {}

  bool run() {
    const FleetReservations::Snapshot before = reservations_.snapshot();
    if (make_room_for_any_two()) {
      replan_for_less(state_, robots_, stop_);
      progress_.next_attempt();
      progress_.update();
      return true;
    }
    reservations_.restore(before);
    return false;
  }

 private:
  bool make_room_for_any_two() {
    std::vector<Trajectory> alone;
    for (const std::size_t robot : robots_) alone.push_back(state_.plan_alone(robot, stop_));
    // Bounded: few robots.
    for (std::size_t first = 0; first < robots_.size(); ++first) {
      for (std::size_t second = 0; second < robots_.size(); ++second) {
        if (first == second || !moves_aside(robots_[first]) || !moves_aside(robots_[second])) continue;
        for (const Site& site : sites_of_meeting(first, second, alone)) {
          for (const double side : {-1.0, 1.0}) {
            const auto places = places_beside(site, side, robots_[first], robots_[second]);
            if (places && pass(robots_[first], robots_[second], *places)) return true;
            if (stop_.met()) return false;
          }
        }
      }
    }
    return false;
  }

  bool moves_aside(std::size_t robot) const {
    return !instance_.views(robot).change() && !instance_.itinerary(robot).yields();
  }

  double reach(std::size_t a, std::size_t b) const {
    return instance_.body(a).pair_radius + instance_.body(b).pair_radius;
  }

  /// Where two robots that ignore each other first meet, as seen by the first robot. None if they do not
  /// meet.
  std::optional<Site> meeting(std::size_t first, std::size_t second, const std::vector<Trajectory>& alone) {
    const double required = reach(robots_[first], robots_[second]) - kSearchSlack;
    const std::vector<TimedSegment> mine = timed_segments(alone[first]);
    const std::vector<TimedSegment> theirs = timed_segments(alone[second]);
    // Bounded: each step leaves one segment behind.
    for (std::size_t i = 0, k = 0; i < mine.size() && k < theirs.size();) {
      const MovingDisk a(mine[i]);
      const MovingDisk b(theirs[k]);
      if (const auto hit = overlap(a, b, required)) {
        const Position from = a.at(hit->begin);
        const Position to = b.at(hit->begin);
        const double distance = (to - from).norm();
        if (!(distance > kSamePosition)) return std::nullopt;
        return Site{0.5 * (from + to), (to - from) / distance};
      }
      if (a.t_end < b.t_end) {
        ++i;
      } else {
        ++k;
      }
    }
    return std::nullopt;
  }

  /// The places along the way of the first robot where the two may pass each other, the nearest to where they
  /// meet first.
  std::vector<Site> sites_of_meeting(std::size_t first, std::size_t second,
                                     const std::vector<Trajectory>& alone) {
    const std::optional<Site> met = meeting(first, second, alone);
    if (!met) return {};
    const double distance = reach(robots_[first], robots_[second]);
    std::vector<Site> sites;
    // Bounded: the moves of one trajectory, and a few places along each.
    for (const TimedMove& move : alone[first].moves) {
      const double length = move.path.length();
      if (!(length > kSamePosition)) continue;
      const Position ahead = (move.path.to - move.path.from) / length;
      const double nearest = std::clamp((met->at - move.path.from).dot(ahead), 0.0, length);
      for (int k = -kSitesOfAMove; k <= kSitesOfAMove; ++k) {
        const double along = nearest + k * distance;
        if (along >= 0.0 && along <= length) sites.push_back({move.path.from + along * ahead, ahead});
      }
    }
    std::stable_sort(sites.begin(), sites.end(), [&](const Site& a, const Site& b) {
      return (a.at - met->at).squaredNorm() < (b.at - met->at).squaredNorm();
    });
    if (sites.size() > kMaxSites) sites.resize(kMaxSites);
    sites.insert(sites.begin(), *met);
    return sites;
  }

  /// Where the first robot stands on the left of the way (`side` 1) or on the right (-1), and the second
  /// robot on the other side, so that they do not touch. None if there is no room.
  std::optional<PassingPlaces> places_beside(const Site& site, double side, std::size_t first,
                                             std::size_t second) const {
    const Position aside = side * left_of(site.ahead);
    const double required = reach(first, second);
    const std::optional<double> mine = room(first, site.at, aside, kPassingDistance * required);
    const std::optional<double> theirs = room(second, site.at, -aside, kPassingDistance * required);
    if (!mine || !theirs || *mine + *theirs < required) return std::nullopt;
    const double share = std::min(1.0, kPassingDistance * required / (*mine + *theirs));
    return PassingPlaces{site.at + share * *mine * aside, site.at - share * *theirs * aside};
  }

  /// How far a robot may move aside from a place, metres, up to `max`; none if it does not fit there.
  std::optional<double> room(std::size_t robot, const Position& from, const Position& aside,
                             double max) const {
    const View& view = instance_.views(robot)[0];
    if (!view.free_space->may_sweep(from, from, view.body.wall_radius)) return std::nullopt;
    return room_towards(view, from, aside, max);
  }

  /// Plans the two robots through their places, and the others after them.
  bool pass(std::size_t first, std::size_t second, const PassingPlaces& places) {
    const double reserved = instance_.options().start_safe_interval;
    for (const std::size_t robot : robots_) reservations_.reserve_place(robot, reserved);
    const bool both = drive_through(first, places.first) &&
                      (drive_through(second, places.second) ||
                       (wait_in(first, places.first) && drive_through(second, places.second) &&
                        drive_through(first, places.first)));
    if (!both) return false;
    for (const std::size_t robot : robots_) {
      if (robot == first || robot == second) continue;
      reservations_.remove(robot);
      SearchResult result = state_.plan(robot, {.max_expansions = kMaxSearchExpansions}, stop_);
      if (!result.trajectory) return false;
      reservations_.follow(robot, std::move(*result.trajectory));
    }
    return true;
  }

  /// Lets a robot follow the way through a place to its goals, if there is one.
  bool drive_through(std::size_t robot, const Position& place) {
    std::vector<Goal> goals = instance_.itinerary(robot).goals;
    goals.insert(goals.begin(), Goal{place, std::nullopt});
    return follow_to(robot, std::move(goals));
  }

  /// Lets a robot follow the way to a place, and stay there.
  bool wait_in(std::size_t robot, const Position& place) {
    return follow_to(robot, {Goal{place, std::nullopt}});
  }

  bool follow_to(std::size_t robot, std::vector<Goal> goals) {
    const double held_for = reservations_.holds_place_for(robot);
    reservations_.remove(robot);
    SearchResult result =
        state_.plan_to(robot, std::move(goals), {.max_expansions = kMaxSearchExpansions}, stop_);
    if (!result.trajectory) {
      reservations_.reserve_place(robot, held_for);
      return false;
    }
    leave_out_place(robot, *result.trajectory);
    reservations_.follow(robot, std::move(*result.trajectory));
    return true;
  }

  /// The place is no goal of the robot: the visit to it does not count.
  void leave_out_place(std::size_t robot, Trajectory& trajectory) const {
    const std::size_t place = instance_.itinerary(robot).first_goal;
    std::erase_if(trajectory.visits, [&](const Visit& visit) { return visit.goal == place; });
    for (Visit& visit : trajectory.visits) {
      if (visit.goal > place) --visit.goal;
    }
  }

  PlanState& state_;
  const Instance& instance_;
  FleetReservations& reservations_;
  const std::vector<std::size_t>& robots_;
  const StopCondition& stop_;
  ProgressReport& progress_;
};

}  // namespace

double room_towards(const View& view, const Position& from, const Position& direction, double max) {
  const auto is_free = [&](double distance) {
    return view.free_space->may_sweep(from, from + distance * direction, view.body.wall_radius);
  };
  if (is_free(max)) return max;
  double least = 0.0;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (least + max);
    (is_free(middle) ? least : max) = middle;
  }
  return least;
}

bool make_room(PlanState& state, const std::vector<std::size_t>& robots, const StopCondition& stop,
               ProgressReport& progress) {
  return MakingRoom(state, robots, stop, progress).run();
}

void replan_for_less(PlanState& state, const std::vector<std::size_t>& robots, const StopCondition& stop) {
  bool is_any_better = true;
  for (int k = 0; k < kMaxReplans && is_any_better; ++k) {
    is_any_better = false;
    for (const std::size_t robot : robots) {
      if (stop.met()) return;
      const SearchSettings settings{.bound = state.reservations().trajectory(robot)->cost - kLeastGain,
                                    .max_expansions = kMaxSearchExpansions};
      is_any_better = state.replan(robot, settings, stop).trajectory.has_value() || is_any_better;
    }
  }
}

}  // namespace fleetplan::core
