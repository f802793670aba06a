#include "core/verify/pairs/sweeps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "core/verify/check_rules.h"
#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {

namespace {

/// How much earlier than an overlap by more than a tolerance an unavoidable collision may begin, in metres:
/// it may begin when the disks touch.
constexpr double kTouching = 2.0 * kMaxTolerance;

/// Rounding of the time of an unavoidable collision that went through decimal text, seconds.
constexpr double kTextRounding = 1e-6;

/// Returns the positions of the robot at `t`, ascending; two where its radius changes then.
std::vector<std::size_t> positions_at(const ExecutedFleet& fleet, std::size_t robot, double t) {
  std::vector<std::size_t> positions;
  const auto found = std::lower_bound(fleet.robots.begin(), fleet.robots.end(), robot);
  auto position = static_cast<std::size_t>(found - fleet.robots.begin());
  for (; position < fleet.size() && fleet.robots[position] == robot; ++position) {
    const bool has_begun = fleet.begin_of(position) <= t + kTextRounding;
    if (has_begun && fleet.end_of(position) >= t - kTextRounding) positions.push_back(position);
  }
  return positions;
}

/// Whether an overlap until `t` goes on at the next position of the same robot.
bool goes_on(const ExecutedFleet& fleet, std::size_t position, double t) {
  return t >= fleet.end_of(position) && position + 1 < fleet.size() &&
         fleet.same_robot(position, position + 1);
}

}  // namespace

Exemptions::Exemptions(const std::vector<UnavoidableCollision>& collisions, const ExecutedFleet& fleet,
                       double inflation, const std::vector<std::vector<Leg>>& obstacles,
                       const std::vector<double>& obstacle_radii, const StopCondition& stop)
    : fleet_(fleet),
      inflation_(inflation),
      obstacles_(obstacles),
      obstacle_radii_(obstacle_radii),
      robots_(fleet.size()) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    certain_.push_back({fleet.stays[i] ? kNever : fleet.handovers[i].committed_until, kNever});
  }
  std::vector<std::size_t> listed(fleet.size(), 0);
  for (const UnavoidableCollision& collision : collisions) {
    if (stop.met()) return;
    const std::vector<std::size_t> ones = positions_at(fleet, collision.robot, collision.t);
    if (ones.empty() || !is_certain(ones.front(), collision.t)) continue;
    count(ones.front(), collision.t, listed);
    for (const std::size_t one : ones) {
      if (collision.obstacle && *collision.obstacle < obstacles.size()) {
        add_obstacle(one, *collision.obstacle, std::max(collision.t, fleet.begin_of(one)));
      }
      if (collision.other && *collision.other != collision.robot)
        add_pair(one, *collision.other, collision.t);
    }
  }
}

void Exemptions::add_pair(std::size_t one, std::size_t other_robot, double t) {
  for (const std::size_t other : positions_at(fleet_, other_robot, t)) {
    if (!is_certain(other, t)) continue;
    add_robots(one, other, std::max({t, fleet_.begin_of(one), fleet_.begin_of(other)}));
  }
}

void Exemptions::add_obstacle(std::size_t position, std::size_t obstacle, double t) {
  for (;; ++position) {
    const double near = fleet_.radii[position] + obstacle_radii_[obstacle] + kTouching;
    const auto span = time_together(fleet_.legs[position], obstacles_[obstacle], near, t);
    if (!span) return;
    with_obstacles_[obstacle * robots_ + position].push_back(*span);
    if (!goes_on(fleet_, position, span->end)) return;
    t = span->end;
  }
}

void Exemptions::add_robots(std::size_t one, std::size_t other, double t) {
  while (true) {
    const double near = fleet_.kept_distance(one, other, inflation_) + kTouching;
    const auto span = time_together(fleet_.legs[one], fleet_.legs[other], near, t);
    if (!span) return;
    of_robots_[key(one, other)].push_back(*span);
    t = span->end;
    const bool one_goes_on = goes_on(fleet_, one, t);
    const bool other_goes_on = goes_on(fleet_, other, t);
    if (!one_goes_on && !other_goes_on) return;
    one += one_goes_on ? 1 : 0;
    other += other_goes_on ? 1 : 0;
  }
}

bool Exemptions::is_certain(std::size_t position, double t) const {
  return t <= certain_[position].until + kTextRounding;
}

void Exemptions::count(std::size_t position, double t, std::vector<std::size_t>& collisions) {
  std::size_t first = position;
  while (first > 0 && fleet_.same_robot(first - 1, position)) --first;
  if (++collisions[first] < kMaxUnavoidableOfRobot) return;
  double& from = certain_[first].exempt_from;
  from = std::isinf(from) ? t : std::max(from, t);
  for (std::size_t next = first + 1; next < fleet_.size() && fleet_.same_robot(first, next); ++next) {
    certain_[next].exempt_from = from;
  }
}

bool Exemptions::allow_robots(std::size_t one, std::size_t other, double t) const {
  if (any_contains(of_robots(one, other), t)) return true;
  return t >= std::min(certain_[one].exempt_from, certain_[other].exempt_from) &&
         t <= std::min(certain_[one].until, certain_[other].until);
}

bool Exemptions::allow_obstacle(std::size_t robot, std::size_t obstacle, double t) const {
  if (any_contains(with_obstacle(robot, obstacle), t)) return true;
  return t >= certain_[robot].exempt_from && t <= certain_[robot].until;
}

const std::vector<TimeSpan>& Exemptions::of_robots(std::size_t one, std::size_t other) const {
  return find(of_robots_, key(one, other));
}

const std::vector<TimeSpan>& Exemptions::with_obstacle(std::size_t robot, std::size_t obstacle) const {
  return find(with_obstacles_, obstacle * robots_ + robot);
}

const std::vector<TimeSpan>& Exemptions::find(const Spans& spans, std::uint64_t pair) {
  static const std::vector<TimeSpan> none;
  const auto found = spans.find(pair);
  return found == spans.end() ? none : found->second;
}

std::uint64_t Exemptions::key(std::size_t one, std::size_t other) const {
  return static_cast<std::uint64_t>(std::min(one, other)) * robots_ + std::max(one, other);
}

bool any_contains(const std::vector<TimeSpan>& spans, double t) {
  return std::any_of(spans.begin(), spans.end(),
                     [t](const TimeSpan& span) { return span.begin <= t && t <= span.end; });
}

namespace {

constexpr std::size_t kPiecesBetweenPolls = 256;
/// Windows in which obstacles have about the same number of legs, in addition to the windows of the robots.
constexpr std::size_t kObstacleWindows = 64;
/// The most ends of legs from which these windows are found.
constexpr std::size_t kMaxSamples = 4096;

/// Compares, in each time window, every leg of an obstacle with the robots whose boxes it comes near. There
/// may be far more legs of obstacles than robots, so they are not sorted.
class ObstacleSweep {
 public:
  ObstacleSweep(const ExecutedFleet& fleet, const std::vector<std::vector<Leg>>& obstacles,
                const std::vector<double>& obstacle_radii, const Exemptions& exemptions,
                std::size_t max_overlaps, const StopCondition& stop)
      : fleet_(fleet),
        obstacles_(obstacles),
        radii_(obstacle_radii),
        exemptions_(exemptions),
        robots_(fleet.legs, fleet.radii),
        next_(obstacles.size(), 0),
        overlaps_(max_overlaps),
        stop_(stop),
        stride_(stop, kPiecesBetweenPolls) {}

  std::optional<std::vector<Overlap>> run() {
    if (obstacles_.empty() || fleet_.size() == 0) return std::vector<Overlap>{};
    const std::vector<double> boundaries = windows();
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
      if (stop_.met() || stride_.met()) return std::nullopt;
      compare_in({boundaries[k],
                  k + 1 < boundaries.size() ? boundaries[k + 1] : std::numeric_limits<double>::infinity()});
    }
    if (stride_.met()) return std::nullopt;
    return overlaps_.take();
  }

 private:
  std::vector<double> windows() const {
    std::size_t legs = 0;
    for (const std::vector<Leg>& all : obstacles_) legs += all.size();
    const std::size_t stride = 1 + legs / kMaxSamples;
    std::vector<double> ends;
    std::size_t k = 0;
    // Bounded: the legs that there are, each once.
    for (const std::vector<Leg>& all : obstacles_) {
      for (const Leg& leg : all) {
        if (k++ % stride == 0 && std::isfinite(leg.t_end)) ends.push_back(leg.t_end);
      }
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> boundaries = time_windows(fleet_.legs);
    for (std::size_t i = 1; i <= kObstacleWindows && !ends.empty(); ++i) {
      boundaries.push_back(std::max(0.0, ends[(ends.size() - 1) * i / kObstacleWindows]));
    }
    std::sort(boundaries.begin(), boundaries.end());
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    return boundaries;
  }

  void compare_in(const TimeSpan& window) {
    std::vector<MovingBox> boxes = robots_.in(window);
    std::erase_if(boxes,
                  [&](const MovingBox& box) { return exemptions_.allow_all_obstacles(box.body, window); });
    if (boxes.empty()) return;
    double widest = 0.0;
    for (const MovingBox& box : boxes) widest = std::max(widest, box.right - box.left);
    for (std::size_t obstacle = 0; obstacle < obstacles_.size() && !stride_.met(); ++obstacle) {
      const std::vector<Leg>& legs = obstacles_[obstacle];
      std::size_t& next = next_[obstacle];
      while (next < legs.size() && legs[next].t_end < window.begin) ++next;
      for (std::size_t k = next; k < legs.size() && legs[k].t_begin <= window.end && !stride_.met_at_step();
           ++k) {
        compare(boxes, widest, obstacle, legs[k], window);
      }
    }
  }

  void compare(const std::vector<MovingBox>& boxes, double widest, std::size_t obstacle, const Leg& leg,
               const TimeSpan& window) {
    MovingBox box;
    box.include(position_at(leg, window.begin));
    box.include(position_at(leg, window.end));
    box.enlarge(radii_[obstacle]);
    auto near = std::lower_bound(boxes.begin(), boxes.end(), box.left - widest,
                                 [](const MovingBox& robot, double left) { return robot.left < left; });
    for (; near != boxes.end() && near->left <= box.right; ++near) {
      if (near->right < box.left || near->top < box.bottom || box.top < near->bottom) continue;
      compare(near->body, obstacle, leg, window);
    }
  }

  void compare(std::size_t robot, std::size_t obstacle, const Leg& leg, const TimeSpan& window) {
    const double allowed = fleet_.radii[robot] + radii_[obstacle] - fleet_.tolerances[robot];
    if (allowed <= 0.0) return;
    const bool is_instant = obstacles_[obstacle].size() == 1;
    visit_common_pieces(
        robots_.legs(robot), {&leg, 1}, window, is_instant, [&](const RelativeMotion& motion) {
          const bool is_exempt = exemptions_.allow_all_obstacles(robot, {motion.t_begin, motion.t_end});
          if (!is_exempt && least_squared_distance(motion) < allowed * allowed) {
            overlaps_.add(robot, obstacle, motion, allowed);
          }
          return !stride_.met_at_step();
        });
  }

  const ExecutedFleet& fleet_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& radii_;
  const Exemptions& exemptions_;
  MovingBoxes robots_;
  std::vector<std::size_t> next_;  // by obstacle, the first leg that does not end before the window
  OverlapList overlaps_;
  const StopCondition& stop_;
  StopStride stride_;
};

}  // namespace

std::optional<std::vector<Overlap>> overlaps_with_obstacles(const ExecutedFleet& fleet,
                                                            const std::vector<std::vector<Leg>>& obstacles,
                                                            const std::vector<double>& obstacle_radii,
                                                            const Exemptions& exemptions,
                                                            std::size_t max_overlaps,
                                                            const StopCondition& stop) {
  return ObstacleSweep(fleet, obstacles, obstacle_radii, exemptions, max_overlaps, stop).run();
}

namespace {

constexpr std::size_t kComparisonsBetweenPolls = 64;

enum class Phase { committed, staying, planned };

Phase phase_of(const Leg& leg, const Handover& handover) {
  if (handover.plans(leg.t_begin)) return Phase::planned;
  return handover.commits(leg.t_end) ? Phase::committed : Phase::staying;
}

/// Returns a lower bound of the distance of two legs within these times, from their bounding boxes.
double least_possible(const Leg& a, const TimeSpan& time, const Leg& b, const TimeSpan& its_time) {
  const Position from = position_at(a, time.begin);
  const Position to = position_at(a, time.end);
  const Position its_from = position_at(b, its_time.begin);
  const Position its_to = position_at(b, its_time.end);
  const Position above = its_from.cwiseMin(its_to) - from.cwiseMax(to);
  const Position below = from.cwiseMin(to) - its_from.cwiseMax(its_to);
  return above.cwiseMax(below).maxCoeff();
}

/// Returns what remains of a time span without others.
std::vector<TimeSpan> without(const TimeSpan& span, const std::vector<TimeSpan>& left_out) {
  std::vector<TimeSpan> rest{span};
  // Bounded: the collisions of two robots that are listed.
  for (const TimeSpan& out : left_out) {
    std::vector<TimeSpan> smaller;
    for (const TimeSpan& part : rest) {
      if (out.end <= part.begin || out.begin >= part.end) {
        smaller.push_back(part);
        continue;
      }
      if (part.begin < out.begin) smaller.push_back({part.begin, out.begin});
      if (out.end < part.end) smaller.push_back({out.end, part.end});
    }
    rest = std::move(smaller);
  }
  return rest;
}

class MarginSweep {
 public:
  MarginSweep(const ExecutedFleet& fleet, double margin, double inflation, const TimesLeftOut& left_out,
              std::size_t max_overlaps, const StopCondition& stop)
      : fleet_(fleet),
        margin_(margin),
        inflation_(inflation),
        left_out_(left_out),
        max_overlaps_(max_overlaps),
        stop_(stop),
        stride_(stop, kComparisonsBetweenPolls) {}

  std::optional<std::vector<ShiftedOverlap>> run() {
    std::vector<double> boundaries = time_windows(fleet_.legs);
    // The last change of a radius may be the last event, and it counts for the margin before it, too.
    if (changes_radius()) boundaries.push_back(boundaries.back() + margin_);
    std::vector<double> reach = fleet_.radii;
    for (std::size_t i = 0; i < reach.size(); ++i) reach[i] += inflation_ + fleet_.vicinities[i];
    MovingBoxes boxes(fleet_.legs, std::move(reach));
    // After the last boundary all robots rest, where the rule without a margin is the same.
    for (std::size_t k = 0; k + 1 < boundaries.size(); ++k) {
      if (stop_.met() || stride_.met()) return std::nullopt;
      const TimeSpan window{boundaries[k], boundaries[k + 1]};
      sweep(boxes.in({window.begin - margin_, window.end + margin_}), window);
    }
    if (stride_.met()) return std::nullopt;
    std::vector<ShiftedOverlap> overlaps;
    overlaps.reserve(deepest_.size());
    for (const auto& [pair, overlap] : deepest_) overlaps.push_back(overlap);
    return overlaps;
  }

 private:
  bool changes_radius() const {
    return std::adjacent_find(fleet_.robots.begin(), fleet_.robots.end()) != fleet_.robots.end();
  }

  void sweep(const std::vector<MovingBox>& boxes, const TimeSpan& window) {
    for (std::size_t i = 0; i < boxes.size() && !stride_.met(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size() && boxes[j].left <= boxes[i].right && !stride_.met();
           ++j) {
        if (fleet_.same_robot(boxes[i].body, boxes[j].body)) continue;
        if (boxes[i].bottom > boxes[j].top || boxes[j].bottom > boxes[i].top) continue;
        compare(std::min(boxes[i].body, boxes[j].body), std::max(boxes[i].body, boxes[j].body), window);
      }
    }
  }

  /// Compares the first robot within the window with the second one up to the margin earlier and later.
  void compare(std::size_t first, std::size_t second, const TimeSpan& window) {
    stride_.met_at_step();
    const std::vector<Leg>& others = fleet_.legs[second];
    for (auto leg = first_leg_until(fleet_.legs[first], window.begin);
         leg != fleet_.legs[first].end() && leg->t_begin < window.end && !stride_.met(); ++leg) {
      const TimeSpan time{std::max(leg->t_begin, window.begin), std::min(leg->t_end, window.end)};
      const Phase phase = phase_of(*leg, fleet_.handovers[first]);
      if (phase == Phase::staying || time.begin >= time.end) continue;
      for (auto other = first_leg_until(others, time.begin - margin_);
           other != others.end() && other->t_begin <= time.end + margin_ && !stride_.met(); ++other) {
        const Phase its_phase = phase_of(*other, fleet_.handovers[second]);
        if (its_phase == Phase::staying || (phase == Phase::committed && its_phase == Phase::committed))
          continue;
        const TimeSpan its_time{std::max(other->t_begin, time.begin - margin_),
                                std::min(other->t_end, time.end + margin_)};
        if (its_time.begin < its_time.end) compare(first, *leg, time, second, *other, its_time);
      }
    }
  }

  void compare(std::size_t first, const Leg& leg, const TimeSpan& time, std::size_t second, const Leg& other,
               const TimeSpan& its_time) {
    stride_.met_at_step();
    const double kept = fleet_.kept_distance(first, second, inflation_) -
                        std::max(fleet_.tolerances[first], fleet_.tolerances[second]);
    const auto record = [&](const TimeSpan& a, const TimeSpan& b) {
      const ShiftedMoment nearest = least_shifted_distance(leg, a, other, b, margin_, kept);
      if (nearest.distance < kept) add({first, second, nearest.t_first, nearest.t_second, nearest.distance});
    };
    if (least_possible(leg, time, other, its_time) >= kept) return;
    if (least_shifted_distance(leg, time, other, its_time, margin_, kept).distance >= kept) return;
    const std::vector<TimeSpan> left_out = left_out_(first, second);
    // Bounded: the spans that few left-out ones leave.
    for (const TimeSpan& a : without(time, left_out)) {
      for (const TimeSpan& b : without(its_time, left_out)) record(a, b);
    }
  }

  void add(const ShiftedOverlap& overlap) {
    const std::pair pair(overlap.first, overlap.second);
    const auto found = deepest_.find(pair);
    if (found != deepest_.end()) {
      if (overlap.distance < found->second.distance) found->second = overlap;
    } else if (deepest_.size() < max_overlaps_) {
      deepest_.emplace(pair, overlap);
    }
  }

  const ExecutedFleet& fleet_;
  double margin_;
  double inflation_;
  const TimesLeftOut& left_out_;
  std::size_t max_overlaps_;
  const StopCondition& stop_;
  StopStride stride_;
  std::map<std::pair<std::size_t, std::size_t>, ShiftedOverlap> deepest_;  // by pair
};

}  // namespace

std::optional<std::vector<ShiftedOverlap>> overlaps_within_margin(const ExecutedFleet& fleet, double margin,
                                                                  double inflation,
                                                                  const TimesLeftOut& left_out,
                                                                  std::size_t max_overlaps,
                                                                  const StopCondition& stop) {
  if (margin <= 0.0) return std::vector<ShiftedOverlap>{};
  return MarginSweep(fleet, margin, inflation, left_out, max_overlaps, stop).run();
}

}  // namespace fleetplan::core
