#include "api/advance/committed_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::api {

using core::Position;

namespace {

/// Metres: two disks that come nearer by less do not; far above rounding.
constexpr double kNearer = 1e-9;

}  // namespace

std::vector<Piece> committed_pieces(const core::Robot& robot) {
  std::vector<core::RadiusStep> steps;
  if (core::changes_radius(robot)) {
    steps = core::radius_steps(robot, core::itinerary_of(robot).visited);
  }
  std::vector<Piece> pieces;
  double radius = robot.radius;
  auto step = steps.begin();
  // Bounded: the changes of radius of one robot, each once.
  const auto add = [&](Piece piece) {
    for (; step != steps.end() && step->t < piece.end; ++step) {
      if (step->t > piece.begin) {
        pieces.push_back({piece.begin, step->t, piece.from, piece.velocity, radius, piece.grows});
        piece.from = piece.at(step->t);
        piece.begin = step->t;
      }
      piece.grows = step->radius > radius;
      radius = step->radius;
    }
    piece.radius = radius;
    pieces.push_back(piece);
  };
  for (const core::Action& action : robot.committed) {
    const double duration = action.t_end - action.t_start;
    const Position path = action.to.position - action.from.position;
    const Position velocity = duration > 0.0 ? Position(path / duration) : Position(0.0, 0.0);
    if (action.profile && path.squaredNorm() > 0.0 && duration > 0.0) {
      const core::TimedSegment move{{action.from.position, action.to.position}, action.t_start, action.t_end};
      for (const core::TimedSegment& phase : core::phases(move, *action.profile)) {
        add({phase.t_start, phase.t_end, phase.path.from, phase.velocity(), 0.0, false, phase.ramp});
      }
      continue;
    }
    add({action.t_start, action.t_end, action.from.position, velocity});
  }
  add({robot.committed_until(),
       std::numeric_limits<double>::infinity(),
       robot.committed_end().position,
       {0.0, 0.0}});
  return pieces;
}

std::optional<double> first_overlap(const Piece& a, const Piece& b, double distance) {
  const double begin = std::max(a.begin, b.begin);
  const double end = std::min(a.end, b.end);
  if (begin > end) return std::nullopt;
  const Position apart = a.at(begin) - b.at(begin);
  if (a.ramp != 0.0 || b.ramp != 0.0) {
    // Disks that are too near already may go on, but not come nearer.
    const auto met = core::overlap(a.disk(), b.disk(), std::min(distance, apart.norm() - kNearer));
    return met && met->begin < end ? std::optional(met->begin) : std::nullopt;
  }
  const Position velocity = a.velocity - b.velocity;
  const double closing = apart.dot(velocity);
  if (closing >= 0.0) return std::nullopt;
  const double gap = apart.squaredNorm() - distance * distance;
  if (gap < 0.0) return begin;
  const double speed = velocity.squaredNorm();
  const double under_root = closing * closing - speed * gap;
  if (under_root <= 0.0) return std::nullopt;
  const double t = begin + gap / (-closing + std::sqrt(under_root));
  return t < end ? std::optional(t) : std::nullopt;
}

namespace {

/// Pairs that are listed; where more overlap, nobody reads all of them.
constexpr std::size_t kMostPairs = 10'000;

/// A commitment that cannot end there ends by so much before disks overlap, at most (seconds).
constexpr double kLater = 1e-2;

/// What a robot does that executes its commitment, and then stands.
struct Stopping {
  std::vector<Piece> committed;
  std::vector<Piece> braking;  // instead, if it cannot stand where its commitment ends; otherwise none
  double reach = 0.0;          // metres, from its start, with its disk
  bool brakes = false;
  double until = 0.0;  // seconds; how it brakes after that is after a collision, and not known
};

double length(const std::vector<core::Action>& actions) {
  double metres = 0.0;
  for (const core::Action& action : actions) metres += (action.to.position - action.from.position).norm();
  return metres;
}

Stopping stopping(const core::Robot& robot, const std::vector<core::Action>& braking) {
  Stopping made;
  made.committed = committed_pieces(robot);
  made.brakes = !braking.empty();
  made.until = std::numeric_limits<double>::infinity();
  double driven = length(robot.committed);
  if (made.brakes && braking.back().t_end > robot.committed_until()) {
    if (braking.back().t_end > robot.committed_until() + kLater)
      made.until = robot.committed_until() + kLater;
    core::Robot brakes = robot;
    brakes.committed = braking;
    made.braking = committed_pieces(brakes);
    driven = std::max(driven, length(braking));
  }
  made.reach = core::largest_radius(robot) + driven;
  return made;
}

class CollisionSearch {
 public:
  CollisionSearch(const std::vector<core::Robot>& robots, core::Work& stop) : robots_(robots), stop_(stop) {}

  void add(Stopping robot) { stopping_.push_back(std::move(robot)); }

  std::vector<Collision> run() {
    std::vector<Collision> found;
    for (std::size_t i = 0; i < stopping_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (stop_.met_after(1) || found.size() >= kMostPairs) return found;
        if (const auto t = begin_of_overlap(j, i)) found.push_back({j, i, *t});
      }
    }
    return found;
  }

 private:
  std::optional<double> begin_of_overlap(std::size_t first, std::size_t second) {
    const core::Robot& a = robots_[first];
    const core::Robot& b = robots_[second];
    const double reach = a.radius + b.radius - core::kContactTolerance;
    const double apart = (a.start.position - b.start.position).norm();
    if (reach > 0.0 && apart < reach) return 0.0;
    const Stopping& mine = stopping_[first];
    const Stopping& theirs = stopping_[second];
    if (!(mine.brakes || theirs.brakes) || apart > mine.reach + theirs.reach) return std::nullopt;
    if (!mine.braking.empty() || !theirs.braking.empty()) {
      const auto braked = [](const Stopping& robot) -> const std::vector<Piece>& {
        return robot.braking.empty() ? robot.committed : robot.braking;
      };
      const auto t = first_contact(braked(mine), braked(theirs));
      if (t && *t <= std::min(mine.until, theirs.until)) return t;
    }
    return first_contact(mine.committed, theirs.committed);
  }

  std::optional<double> first_contact(const std::vector<Piece>& mine, const std::vector<Piece>& theirs) {
    std::optional<double> contact;
    visit_in_time(mine, theirs, stop_, [&](const Piece& piece, const Piece& other) {
      contact = first_overlap(piece, other, piece.radius + other.radius - core::kContactTolerance);
      return contact.has_value();
    });
    return contact;
  }

  const std::vector<core::Robot>& robots_;
  core::Work& stop_;
  std::vector<Stopping> stopping_;  // by robot
};

}  // namespace

std::vector<Collision> unavoidable_collisions(const std::vector<core::Robot>& robots,
                                              const std::vector<std::vector<core::Action>>& braking,
                                              core::Work& stop) {
  CollisionSearch search(robots, stop);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (stop.met_after(kWorkOfAPiece * (1 + robots[k].committed.size()))) return {};
    search.add(stopping(robots[k], braking[k]));
  }
  return search.run();
}

}  // namespace fleetplan::api
