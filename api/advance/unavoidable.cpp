#include "api/advance/unavoidable.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "api/advance/committed_pieces.h"
#include "core/geometry/tolerance.h"
#include "core/model/radius_steps.h"

namespace fleetplan::api {

namespace {

using core::Action;
using core::Position;

/// Pairs that are listed; where more overlap, nobody reads all of them.
constexpr std::size_t kMostPairs = 10'000;

/// A commitment that cannot end there ends by so much before disks overlap, at most (seconds).
constexpr double kLater = 1e-2;

/// What a robot does that stops as soon as it can, or where its commitment ends if that is later.
struct Stopping {
  std::vector<Piece> pieces;
  double reach = 0.0;  // metres, from its start, with its disk
  bool brakes = false;
  double until = 0.0;  // seconds; what comes later is after a collision, and not known
};

Stopping stopping(const core::Robot& robot, const std::vector<Action>& braking) {
  Stopping made;
  made.brakes = !braking.empty();
  made.reach = core::largest_radius(robot);
  core::Robot stops = robot;
  made.until = std::numeric_limits<double>::infinity();
  if (made.brakes && braking.back().t_end > robot.committed_until() + kLater) {
    made.until = robot.committed_until() + kLater;
  }
  if (made.brakes && braking.back().t_end > robot.committed_until()) stops.committed = braking;
  for (const Action& action : stops.committed)
    made.reach += (action.to.position - action.from.position).norm();
  made.pieces = committed_pieces(stops);
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
    const bool any_brakes = stopping_[first].brakes || stopping_[second].brakes;
    if (!any_brakes || apart > stopping_[first].reach + stopping_[second].reach) return std::nullopt;
    const auto t = first_contact(stopping_[first].pieces, stopping_[second].pieces);
    return t && *t <= std::min(stopping_[first].until, stopping_[second].until) ? t : std::nullopt;
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
                                              const std::vector<std::vector<Action>>& braking,
                                              core::Work& stop) {
  CollisionSearch search(robots, stop);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (stop.met_after(kWorkOfAPiece * (1 + robots[k].committed.size()))) return {};
    search.add(stopping(robots[k], braking[k]));
  }
  return search.run();
}

}  // namespace fleetplan::api
