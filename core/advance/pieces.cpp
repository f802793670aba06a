#include "core/advance/pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

/// Metres: two disks that come nearer by less do not; far above rounding.
constexpr double kNearer = 1e-9;

}  // namespace

std::vector<Piece> committed_pieces(const Robot& robot) {
  std::vector<RadiusStep> steps;
  if (changes_radius(robot)) {
    const Itinerary itinerary = itinerary_of(robot);
    steps = radius_steps(itinerary, itinerary.visited);
  }
  std::vector<Piece> pieces;
  double radius = robot.radius;
  auto step = steps.begin();
  // Bounded: the changes of radius of one robot, each once.
  const auto add = [&](Piece piece) {
    for (; step != steps.end() && step->t < piece.end; ++step) {
      if (step->t > piece.begin) {
        pieces.push_back({.begin = piece.begin,
                          .end = step->t,
                          .from = piece.from,
                          .velocity = piece.velocity,
                          .radius = radius,
                          .grows = piece.grows});
        piece.from = piece.at(step->t);
        piece.begin = step->t;
      }
      piece.grows = step->radius > radius;
      radius = step->radius;
    }
    piece.radius = radius;
    pieces.push_back(piece);
  };
  for (const Action& action : robot.committed) {
    const double duration = action.t_end - action.t_start;
    const Position path = action.to.position - action.from.position;
    const Position velocity = duration > 0.0 ? Position(path / duration) : Position(0.0, 0.0);
    if (action.profile && path.squaredNorm() > 0.0 && duration > 0.0) {
      const TimedSegment move{{action.from.position, action.to.position}, action.t_start, action.t_end};
      for (const TimedSegment& phase : phases(move, *action.profile)) {
        add({.begin = phase.t_start,
             .end = phase.t_end,
             .from = phase.path.from,
             .velocity = phase.velocity(),
             .ramp = phase.ramp});
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

std::vector<Piece> pieces_of(const MovingObstacle& obstacle) {
  std::vector<Piece> pieces;
  const auto& motion = obstacle.motion;
  for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
    const double duration = motion[k + 1].t - motion[k].t;
    pieces.push_back({.begin = motion[k].t,
                      .end = motion[k + 1].t,
                      .from = motion[k].position,
                      .velocity = (motion[k + 1].position - motion[k].position) / duration,
                      .radius = obstacle.radius});
  }
  const bool stays = obstacle.after == MovingObstacle::After::stays;
  const double end = stays ? std::numeric_limits<double>::infinity() : motion.back().t;
  pieces.push_back({.begin = motion.back().t,
                    .end = end,
                    .from = motion.back().position,
                    .velocity = {0.0, 0.0},
                    .radius = obstacle.radius});
  return pieces;
}

std::optional<double> first_overlap(const Piece& a, const Piece& b, double distance) {
  const double begin = std::max(a.begin, b.begin);
  const double end = std::min(a.end, b.end);
  if (begin > end) return std::nullopt;
  const Position apart = a.at(begin) - b.at(begin);
  if (a.ramp != 0.0 || b.ramp != 0.0) {
    // Disks that are too near already may go on, but not come nearer.
    const auto met = overlap(a.disk(), b.disk(), std::min(distance, apart.norm() - kNearer));
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

}  // namespace fleetplan::core
