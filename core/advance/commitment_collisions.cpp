#include "core/advance/commitment_collisions.h"

// Which robots collide that execute nothing but their commitments, and then stand.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "core/advance/pieces.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

/// The most pairs that are listed. If more overlap, no reader needs all of them.
constexpr std::size_t kMaxPairs = 10'000;

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

double length(const std::vector<Action>& actions) {
  double metres = 0.0;
  for (const Action& action : actions) metres += (action.to.position - action.from.position).norm();
  return metres;
}

Stopping stopping(const Robot& robot, const std::vector<Action>& braking) {
  Stopping made;
  made.committed = committed_pieces(robot);
  made.brakes = !braking.empty();
  made.until = std::numeric_limits<double>::infinity();
  double driven = length(robot.committed);
  if (made.brakes && braking.back().t_end > robot.committed_until()) {
    if (braking.back().t_end > robot.committed_until() + kLater)
      made.until = robot.committed_until() + kLater;
    Robot brakes = robot;
    brakes.committed = braking;
    made.braking = committed_pieces(brakes);
    driven = std::max(driven, length(braking));
  }
  made.reach = largest_radius(robot) + driven;
  return made;
}

class CollisionSearch {
 public:
  CollisionSearch(const std::vector<Robot>& robots, Work& work) : robots_(robots), work_(work) {}

  void add(Stopping robot) { stopping_.push_back(std::move(robot)); }

  Collisions run() {
    Collisions found;
    for (std::size_t i = 0; i < stopping_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (work_.met_after(1)) return found;
        const auto t = begin_of_overlap(j, i);
        if (!t) continue;
        if (found.listed.size() < kMaxPairs) found.listed.push_back({j, i, *t});
        ++found.total;
      }
    }
    return found;
  }

 private:
  std::optional<double> begin_of_overlap(std::size_t first, std::size_t second) {
    const Robot& a = robots_[first];
    const Robot& b = robots_[second];
    const double reach = a.radius + b.radius - kContactTolerance;
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
    visit_in_time(mine, theirs, work_, [&](const Piece& piece, const Piece& other) {
      contact = first_overlap(piece, other, piece.radius + other.radius - kContactTolerance);
      return contact.has_value();
    });
    return contact;
  }

  const std::vector<Robot>& robots_;
  Work& work_;
  std::vector<Stopping> stopping_;  // by robot
};

}  // namespace

Collisions collisions_of_commitments(const std::vector<Robot>& robots,
                                     const std::vector<std::vector<Action>>& braking, Work& work) {
  CollisionSearch search(robots, work);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (work.met_after(kWorkOfAPiece * (1 + robots[k].committed.size()))) return {};
    search.add(stopping(robots[k], braking[k]));
  }
  return search.run();
}

}  // namespace fleetplan::core
