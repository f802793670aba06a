#include "core/explain/unavoidable_collisions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/motion_tree.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Seconds; overlaps with a shorter pause are one.
constexpr double kApart = 1e-6;
/// Metres: disks that overlap by more collide. Slightly more than contact, so that rounding makes no
/// collision of it.
constexpr double kOverlap = kContactTolerance + kSamePosition;
/// Pieces of a motion that are compared with robots by their common box first.
constexpr std::size_t kGroup = 16;
/// Time is divided so that each part has as many pieces as all before. The first one has this share.
constexpr std::size_t kFirstShare = 64;

/// What certainly moves: an obstacle, or a robot that is committed. Its pieces are in the order of time.
struct Passer {
  bool is_obstacle = false;
  std::size_t index = 0;
  double radius = 0.0;  // metres, the largest
  std::vector<MovingDisk> pieces = {};
  std::vector<double> radii = {};  // metres, of each piece of a robot whose radius changes
  std::size_t next = 0;            // the first piece that has not been compared
};

/// A part of what a robot certainly does.
struct Certain {
  std::size_t robot = 0;
  bool is_stay = false;
  MovingDisk disk;
  double radius = 0.0;  // metres
};

std::vector<MovingDisk> obstacle_motion(const MovingObstacle& obstacle) {
  std::vector<MovingDisk> motion;
  const auto& entries = obstacle.motion;
  motion.reserve(entries.size());
  for (std::size_t k = 0; k + 1 < entries.size(); ++k) {
    motion.emplace_back(
        TimedSegment{{entries[k].position, entries[k + 1].position}, entries[k].t, entries[k + 1].t});
  }
  const MovingObstacle::Entry& last = entries.back();
  const double until = obstacle.after == MovingObstacle::After::stays ? kForever : last.t;
  motion.emplace_back(TimedSegment{{last.position, last.position}, last.t, until});
  return motion;
}

/// A disk that stands and covers the others as long as they last. Ends of motion are exact enough for it.
MotionTree::Disk cover(const MovingDisk* begin, const MovingDisk* end, double radius) {
  Position low(kForever, kForever);
  Position high(-kForever, -kForever);
  double t_end = begin->t_end;
  for (const MovingDisk* disk = begin; disk != end; ++disk) {
    const bool stands = disk->velocity.squaredNorm() == 0.0;
    const Position to = stands ? disk->from : disk->at(disk->t_end);
    low = low.cwiseMin(disk->from).cwiseMin(to);
    high = high.cwiseMax(disk->from).cwiseMax(to);
    t_end = std::max(t_end, disk->t_end);
  }
  const Position centre = 0.5 * (low + high);
  return {MovingDisk({{centre, centre}, begin->t_start, t_end}),
          radius + 0.5 * (high - low).norm() + kSamePosition};
}

/// The overlaps of one robot, until it has as many as are listed.
class Overlaps {
 public:
  bool meets_while_staying = false;

  /// Overlaps that touch are joined where that is quick, to save memory.
  void add(std::size_t passer, const OverlapTime& met) {
    if (!all_.empty() && all_.back().passer == passer && all_.back().end + kApart >= met.begin &&
        met.end + kApart >= all_.back().begin) {
      all_.back().begin = std::min(all_.back().begin, met.begin);
      all_.back().end = std::max(all_.back().end, met.end);
    } else {
      all_.push_back({passer, met.begin, met.end});
    }
  }

  /// The begins of overlaps, by time. An overlap that lasts through several parts of a motion counts once.
  std::vector<std::pair<double, std::size_t>> begins() const {
    std::vector<Span> spans = all_;
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
      return std::tie(a.passer, a.begin) < std::tie(b.passer, b.begin);
    });
    std::vector<std::pair<double, std::size_t>> begins;
    double end = 0.0;
    for (const Span& span : spans) {
      const bool goes_on =
          !begins.empty() && begins.back().second == span.passer && span.begin <= end + kApart;
      if (!goes_on) begins.emplace_back(span.begin, span.passer);
      end = goes_on ? std::max(end, span.end) : span.end;
    }
    std::sort(begins.begin(), begins.end());
    return begins;
  }

  /// Whether all that are listed begin before `t`.
  bool has_all_before(double t) const {
    if (all_.size() < kMaxUnavoidableOfRobot) return false;
    const auto listed = begins();
    return listed.size() >= kMaxUnavoidableOfRobot && listed[kMaxUnavoidableOfRobot - 1].first < t;
  }

 private:
  struct Span {
    std::size_t passer;
    double begin;
    double end;
  };
  std::vector<Span> all_;
};

/// Compares what passes with the robots in one part of time after the other. Robots for which all is known
/// are left out, so crowds take little time.
class CollisionSearch {
 public:
  CollisionSearch(const Problem& problem, std::span<const Itinerary> itineraries,
                  const std::vector<bool>& planned, const StopCondition& stop)
      : problem_(problem),
        itineraries_(itineraries),
        planned_(planned),
        stop_(stop),
        overlaps_(itineraries.size()) {
    add_robots();
    for (std::size_t i = 0; i < problem.obstacles().size(); ++i) {
      const MovingObstacle& obstacle = problem.obstacles()[i];
      finished_ = finished_ && !stop.met();
      if (!finished_) return;
      passers_.push_back({true, i, obstacle.radius, obstacle_motion(obstacle)});
    }
  }

  UnavoidableCollisions run() {
    UnavoidableCollisions result;
    for (const double t : ends_of_parts()) {
      if (certain_.empty()) break;
      finished_ = finished_ && compare_until(t);
      if (!finished_) break;
      leave_out_those_known(t);
    }
    result.finished = finished_;
    for (std::size_t i = 0; i < overlaps_.size(); ++i) {
      result.while_staying.push_back(overlaps_[i].meets_while_staying);
      list(i, result.collisions);
    }
    std::sort(result.collisions.begin(), result.collisions.end(),
              [](const UnavoidableCollision& a, const UnavoidableCollision& b) {
                return std::tie(a.t, a.robot, a.obstacle, a.other) <
                       std::tie(b.t, b.robot, b.obstacle, b.other);
              });
    return result;
  }

 private:
  void add_robots() {
    // Bounded: the committed actions, each once.
    for (std::size_t i = 0; i < itineraries_.size(); ++i) {
      const Itinerary& itinerary = itineraries_[i];
      const Position& place = itinerary.pose.position;
      Passer passer{false, i, itinerary.largest_radius()};
      const bool changes = !itinerary.radius_after.empty();
      for (const SizedSegment& segment : certain_segments(itinerary)) {
        passer.pieces.emplace_back(segment);
        if (changes) passer.radii.push_back(segment.radius);
        certain_.push_back({i, false, passer.pieces.back(), segment.radius});
      }
      const double at_end = itinerary.radius_after_goals(itinerary.first_goal);
      if (!planned_[i])
        certain_.push_back({i, true, MovingDisk({{place, place}, itinerary.t_begin, kForever}), at_end});
      if (!passer.pieces.empty()) passers_.push_back(std::move(passer));
    }
  }

  /// Ascending, and at last for ever.
  std::vector<double> ends_of_parts() const {
    std::vector<double> begins;
    // Bounded: the pieces that there are, each once.
    for (const Passer& passer : passers_) {
      for (const MovingDisk& piece : passer.pieces) begins.push_back(piece.t_start);
    }
    std::vector<double> ends;
    for (std::size_t share = kFirstShare; share > 1; share /= 2) {
      const auto at = begins.begin() + static_cast<std::ptrdiff_t>(begins.size() / share);
      std::nth_element(begins.begin(), at, begins.end());
      if (at != begins.end()) ends.push_back(*at);
    }
    ends.push_back(kForever);
    return ends;
  }

  /// Compares the pieces that begin before `t`. Returns false if the stop condition is met.
  bool compare_until(double t) {
    std::vector<MotionTree::Disk> disks;
    disks.reserve(certain_.size());
    for (const Certain& part : certain_) disks.push_back({part.disk, part.radius});
    // Invalid robots may stand beside the map.
    const MotionTree tree(std::move(disks), {problem_.grid().width(), problem_.grid().height(), kForever},
                          stop_);
    if (!tree.finished()) return false;
    for (std::size_t k = 0; k < passers_.size(); ++k) {
      const auto& pieces = passers_[k].pieces;
      std::size_t& next = passers_[k].next;
      while (next < pieces.size() && pieces[next].t_start < t) {
        if (stop_.met()) return false;
        const std::size_t begin = next;
        const std::size_t most = std::min(begin + kGroup, pieces.size());
        while (next < most && pieces[next].t_start < t) ++next;
        const MotionTree::Disk all = cover(&pieces[begin], &pieces[next - 1] + 1, passers_[k].radius);
        if (tree.visit(all.motion, all.radius, 0.0, [](std::size_t) { return false; })) continue;
        for (std::size_t i = begin; i < next; ++i) compare(k, i, tree);
      }
    }
    return true;
  }

  void compare(std::size_t index, std::size_t piece, const MotionTree& tree) {
    const Passer& passer = passers_[index];
    const double radius = passer.radii.empty() ? passer.radius : passer.radii[piece];
    tree.visit(passer.pieces[piece], radius, 0.0, [&](std::size_t k) {
      const Certain& part = certain_[k];
      // Committed motions are clear of each other.
      if (!passer.is_obstacle && (part.robot == passer.index || !part.is_stay)) return true;
      const auto met = overlap(part.disk, passer.pieces[piece], part.radius + radius - kOverlap);
      if (!met) return true;
      // Robots that begin too near to each other part.
      if (!passer.is_obstacle && met->begin <= 0.0) return true;
      Overlaps& overlaps = overlaps_[part.robot];
      overlaps.meets_while_staying = overlaps.meets_while_staying || part.is_stay;
      overlaps.add(index, *met);
      return true;
    });
  }

  void leave_out_those_known(double t) {
    std::vector<bool> known(overlaps_.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      known[i] = (planned_[i] || overlaps_[i].meets_while_staying) && overlaps_[i].has_all_before(t);
    }
    std::erase_if(certain_, [&](const Certain& part) { return known[part.robot]; });
  }

  void list(std::size_t robot, std::vector<UnavoidableCollision>& collisions) const {
    const auto begins = overlaps_[robot].begins();
    for (std::size_t k = 0; k < std::min(begins.size(), kMaxUnavoidableOfRobot); ++k) {
      UnavoidableCollision collision{robot, std::nullopt, std::nullopt, begins[k].first};
      const Passer& passer = passers_[begins[k].second];
      (passer.is_obstacle ? collision.obstacle : collision.other) = passer.index;
      collisions.push_back(collision);
    }
  }

  const Problem& problem_;
  std::span<const Itinerary> itineraries_;  // by robot
  const std::vector<bool>& planned_;
  const StopCondition& stop_;
  std::vector<Passer> passers_;
  std::vector<Certain> certain_;    // of robots for which not all is known
  std::vector<Overlaps> overlaps_;  // by robot
  bool finished_ = true;
};

}  // namespace

UnavoidableCollisions unavoidable_collisions(const Problem& problem, std::span<const Itinerary> itineraries,
                                             const std::vector<bool>& planned, const StopCondition& stop) {
  const bool any_committed =
      std::any_of(itineraries.begin(), itineraries.end(),
                  [](const Itinerary& itinerary) { return itinerary.is_committed && !itinerary.is_invalid; });
  if (problem.obstacles().empty() && !any_committed) return {};
  UnavoidableCollisions result = CollisionSearch(problem, itineraries, planned, stop).run();
  if (result.collisions.empty()) result.while_staying.clear();
  return result;
}

}  // namespace fleetplan::core
