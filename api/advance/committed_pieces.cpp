#include "api/advance/committed_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/itinerary.h"
#include "core/model/radius_steps.h"

namespace fleetplan::api {

using core::Position;

std::vector<Piece> committed_pieces(const core::Robot& robot) {
  std::vector<core::RadiusStep> steps;
  if (core::changes_radius(robot)) {
    steps = core::radius_steps(robot, core::itinerary_of(robot).visited);
  }
  std::vector<Piece> pieces;
  double radius = robot.radius;
  auto step = steps.begin();
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

}  // namespace fleetplan::api
