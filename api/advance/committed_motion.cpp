// The motion of robots that execute nothing but their commitments, in pieces of straight motion and rest;
// which of them collide then; and commitments that end early, so that none do.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "api/advance/advance.h"
#include "core/geometry/disk_motion.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::api {

using core::Position;

namespace {

/// Metres: two disks that come nearer by less do not; far above rounding.
constexpr double kNearer = 1e-9;

/// Copying a piece, or comparing two, is as much work as reading so many bytes.
constexpr std::size_t kWorkOfAPiece = 64;

/// A piece of straight motion or rest.
struct Piece {
  double begin;
  double end;
  core::Position from;
  core::Position velocity;  // the mean
  double radius = 0.0;      // of the bare disk
  bool grows = false;       // it is smaller before
  double ramp = 0.0;        // see core::TimedSegment

  core::Position at(double t) const {
    return ramp == 0.0 ? core::Position(from + velocity * (t - begin)) : disk().at(t);
  }
  core::MovingDisk disk() const {
    core::MovingDisk disk;
    disk.from = from;
    disk.velocity = velocity;
    disk.t_start = begin;
    disk.t_end = end;
    disk.ramp = ramp;
    return disk;
  }
  bool moves() const { return velocity.squaredNorm() > 0.0; }
};

/// Returns the pieces of the commitment, and then the stay at its end, which has no end.
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
  for (const core::Action& action : robot.committed) {
    const double duration = action.t_end - action.t_start;
    const Position path = action.to.position - action.from.position;
    const Position velocity = duration > 0.0 ? Position(path / duration) : Position(0.0, 0.0);
    if (action.profile && path.squaredNorm() > 0.0 && duration > 0.0) {
      const core::TimedSegment move{{action.from.position, action.to.position}, action.t_start, action.t_end};
      for (const core::TimedSegment& phase : core::phases(move, *action.profile)) {
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

/// Returns when two pieces begin to be nearer than a distance, in the time of both; at the beginning of that
/// time if they are nearer then and come nearer.
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

/// Calls visit(piece, other) for the pieces of two robots whose times overlap, in the order of time, until it
/// returns true or `work` is met.
template <class Visit>
void visit_in_time(std::span<const Piece> pieces, std::span<const Piece> others, core::Work& work,
                   const Visit& visit) {
  std::size_t i = 0;
  for (std::size_t k = 0; k < pieces.size() && i < others.size();) {
    if (work.met_after(kWorkOfAPiece) || visit(pieces[k], others[i])) return;
    others[i].end < pieces[k].end ? ++i : ++k;
  }
}

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
  CollisionSearch(const std::vector<core::Robot>& robots, core::Work& work) : robots_(robots), work_(work) {}

  void add(Stopping robot) { stopping_.push_back(std::move(robot)); }

  std::vector<Collision> run() {
    std::vector<Collision> found;
    for (std::size_t i = 0; i < stopping_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (work_.met_after(1) || found.size() >= kMostPairs) return found;
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
    visit_in_time(mine, theirs, work_, [&](const Piece& piece, const Piece& other) {
      contact = first_overlap(piece, other, piece.radius + other.radius - core::kContactTolerance);
      return contact.has_value();
    });
    return contact;
  }

  const std::vector<core::Robot>& robots_;
  core::Work& work_;
  std::vector<Stopping> stopping_;  // by robot
};

}  // namespace

std::vector<Collision> collisions_of_commitments(const std::vector<core::Robot>& robots,
                                                 const std::vector<std::vector<core::Action>>& braking,
                                                 core::Work& work) {
  CollisionSearch search(robots, work);
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (work.met_after(kWorkOfAPiece * (1 + robots[k].committed.size()))) return {};
    search.add(stopping(robots[k], braking[k]));
  }
  return search.run();
}

namespace {

using core::Action;
using Actions = std::vector<Action>;

/// Disks that overlap by less only touch (metres): far below the contact tolerance, far above rounding.
constexpr double kTouch = 1e-8;

/// Disks with a smaller gap touch (metres): more than the contact tolerance.
constexpr double kTouching = 1e-6;

/// The share of the margins of two robots that is little: errors of measured poses are less.
constexpr double kLittle = 0.25;

/// A commitment that is ended by less is not ended (seconds).
constexpr double kSameEnd = 1e-9;

/// A shorter commitment is none (seconds).
constexpr double kNothing = 1e-6;

/// A commitment that ends by so much before a service does not contain it (seconds).
constexpr double kBeforeService = 1e-3;

/// Where two robots begin to be too near, and who drives then, or becomes larger.
struct Meeting {
  double t;
  bool first_moves;
  bool second_moves;
};

/// When a disk that becomes larger at the end of a service is too near to another one: it is not to end.
std::optional<Meeting> overlap_by_growth(const Piece& a, const Piece& b, double distance) {
  const double begin = std::max(a.begin, b.begin);
  const bool a_grows = a.grows && begin == a.begin;
  const bool b_grows = b.grows && begin == b.begin;
  if (!a_grows && !b_grows) return std::nullopt;
  if (begin > std::min(a.end, b.end) || (a.at(begin) - b.at(begin)).norm() >= distance) return std::nullopt;
  return Meeting{std::max(0.0, begin - kBeforeService), a_grows, b_grows};
}

class Clearing {
 public:
  Clearing(std::vector<core::Robot>& robots, const std::vector<double>& margins,
           const std::vector<Actions>& braking, core::Work& work)
      : robots_(robots), margins_(margins), braking_(braking), work_(work), waits_(robots.size(), true) {
    for (const core::Robot& robot : robots) {
      reach_.push_back(core::largest_radius(robot) + margins[pieces_.size()] + driven(robot));
      waiting_.push_back(pieces_.size());
      pieces_.push_back(committed_pieces(robot));
    }
  }

  void run() {
    while (!waiting_.empty()) {
      const std::size_t robot = waiting_.back();
      waiting_.pop_back();
      waits_[robot] = false;
      for (std::size_t other = 0; other < robots_.size(); ++other) {
        if (work_.met_after(kWorkOfAPiece)) return;
        if (other != robot) part(robot, other);
      }
    }
  }

 private:
  /// The length of the committed path.
  static double driven(const core::Robot& robot) {
    double length = 0.0;
    for (const Action& action : robot.committed) length += (action.to.position - action.from.position).norm();
    return length;
  }

  bool may_meet(std::size_t robot, std::size_t other) const {
    const double reach = reach_[robot] + reach_[other];
    const Position apart = robots_[robot].start.position - robots_[other].start.position;
    return apart.squaredNorm() <= reach * reach;
  }

  /// Between the bare disks at the moment; negative if they overlap, metres.
  double gap_now(std::size_t robot, std::size_t other) const {
    const core::Robot& a = robots_[robot];
    const core::Robot& b = robots_[other];
    return (a.start.position - b.start.position).norm() - a.radius - b.radius;
  }

  /// What two robots keep between their bare disks: the margins of both; of robots that are nearer than that
  /// at the moment, half of what they have, and all of it if that is little. Otherwise robots that are
  /// measured again and again would creep up to each other, until errors of their poses are more than what is
  /// left.
  double margin(std::size_t robot, std::size_t other) const {
    const double now = gap_now(robot, other);
    const double whole = margins_[robot] + margins_[other];
    if (now >= whole - kTouch) return whole;
    return std::max({0.0, 0.5 * now, std::min(now, kLittle * whole)});
  }

  /// Until when a robot that drives at the moment cannot stop, seconds; 0 if it stands.
  double cannot_stop_before(std::size_t index) const {
    return index < braking_.size() && !braking_[index].empty() ? braking_[index].back().t_end : 0.0;
  }

  /// Stops both where they begin to be too near while the other one is committed, or as soon as they can.
  /// Where that is too late, their commitments end where their disks touch, if both are certain to be there:
  /// POST /v1/plan refuses commitments that collide.
  void part(std::size_t robot, std::size_t other) {
    if (pieces_[other].size() == 1 || !may_meet(robot, other)) return;
    if (const auto meeting = first_meeting(robot, other)) {
      if (meeting->first_moves) cut(robot, when_it_can_stop(robot, meeting->t));
      if (meeting->second_moves) cut(other, when_it_can_stop(other, meeting->t));
    }
    if (cannot_stop_before(robot) == 0.0 && cannot_stop_before(other) == 0.0) return;
    give_way(robot, other);
    give_way(other, robot);
    if (const auto contact = first_contact(robot, other)) {
      if (contact->first_moves) cut(robot, contact->t);
      if (contact->second_moves) cut(other, contact->t);
    }
  }

  /// Ends a commitment so early that the robot does not stand where another one, which cannot stop, comes.
  void give_way(std::size_t robot, std::size_t other) {
    constexpr int kHalvings = 40;  // of a commitment, to find its end
    double late = robots_[robot].committed_until();
    double early = cannot_stop_before(robot);
    if (cannot_stop_before(other) == 0.0 || early >= late || may_stand(robot, late, other)) return;
    if (!may_stand(robot, early, other)) return;
    for (int k = 0; k < kHalvings && !work_.met(); ++k) {
      const double middle = 0.5 * (early + late);
      (may_stand(robot, middle, other) ? early : late) = middle;
    }
    cut(robot, early);
  }

  /// Whether the other one does not come too near to the robot if that ends its commitment at `t`.
  bool may_stand(std::size_t robot, double t, std::size_t other) {
    const std::vector<Piece>& mine = pieces_[robot];
    const auto at_t =
        std::find_if(mine.begin(), mine.end(), [&](const Piece& piece) { return t < piece.end; });
    work_.met_after(kWorkOfAPiece * (mine.size() + pieces_[other].size()));
    Piece stay{t, mine.back().end, at_t->at(t), {0.0, 0.0}, at_t->radius};
    if (robots_[robot].linear_inertia().is_limited) {
      work_.met_after(kWorkOfAnAction * robots_[robot].committed.size());
      const Actions stopped = stopped_by(robots_[robot].committed, t);
      stay.from = stopped.empty() ? robots_[robot].start.position : stopped.back().to.position;
    }
    const double margin = this->margin(robot, other) - kTouch;
    return std::none_of(pieces_[other].begin(), pieces_[other].end(), [&](const Piece& piece) {
      return first_overlap(piece, stay, piece.radius + stay.radius + margin).has_value();
    });
  }

  double when_it_can_stop(std::size_t index, double t) const {
    return std::max(t, cannot_stop_before(index));
  }

  std::optional<Meeting> first_meeting(std::size_t robot, std::size_t other) {
    const std::vector<Piece>& mine = pieces_[robot];
    const std::vector<Piece>& theirs = pieces_[other];
    const double margin = this->margin(robot, other) - kTouch;
    // One that stops where it touches goes on touching: what follows may come nearer.
    const auto ends_one = [&](const Meeting& meeting) {
      return (meeting.first_moves && shortens(robot, when_it_can_stop(robot, meeting.t))) ||
             (meeting.second_moves && shortens(other, when_it_can_stop(other, meeting.t)));
    };
    std::optional<Meeting> found;
    visit_in_time(mine, committed(theirs), work_, [&](const Piece& piece, const Piece& theirs_then) {
      const double distance = piece.radius + theirs_then.radius + margin;
      const auto grown = overlap_by_growth(piece, theirs_then, distance);
      if (grown && ends_one(*grown)) {
        found = grown;
      } else if (const auto t = first_overlap(piece, theirs_then, distance)) {
        const Meeting meeting{*t, piece.moves(), theirs_then.moves()};
        if (ends_one(meeting)) found = meeting;
      }
      return found.has_value();
    });
    return found;
  }

  /// Where the disks of two commitments begin to overlap, or to come nearer if they overlap. A robot without
  /// a goal certainly stays at the end of its own, and nobody can leave before one that touches it already.
  std::optional<Meeting> first_contact(std::size_t robot, std::size_t other) {
    const std::vector<Piece>& mine = pieces_[robot];
    const std::vector<Piece>& theirs = pieces_[other];
    const bool may_leave = robots_[robot].goal && gap_now(robot, other) > kTouching;
    const std::span<const Piece> certain = may_leave ? committed(mine) : std::span(mine);
    // Less than where one has stopped already that can: rounding must not end the commitment of the other.
    const double contact = std::min(0.0, margin(robot, other)) - 2.0 * kTouch;
    std::optional<Meeting> found;
    visit_in_time(certain, committed(theirs), work_, [&](const Piece& piece, const Piece& theirs_then) {
      const auto t = first_overlap(piece, theirs_then, piece.radius + theirs_then.radius + contact);
      if (!t) return false;
      const Meeting meeting{*t, piece.moves(), theirs_then.moves()};
      if ((meeting.first_moves && shortens(robot, *t)) || (meeting.second_moves && shortens(other, *t))) {
        found = meeting;
      }
      return found.has_value();
    });
    return found;
  }

  /// Without the stay at the end.
  static std::span<const Piece> committed(std::span<const Piece> pieces) {
    return pieces.first(pieces.size() - 1);
  }

  /// Whether a commitment that ends then is shorter.
  bool shortens(std::size_t index, double t) const {
    return (t < kNothing ? 0.0 : t) < robots_[index].committed_until() - kSameEnd;
  }

  void cut(std::size_t index, double t) {
    core::Robot& robot = robots_[index];
    work_.met_after(kWorkOfAPiece * pieces_[index].size());
    if (!shortens(index, t)) return;
    if (t < kNothing) t = 0.0;
    Actions stopped = stopped_by(robot.committed, t);
    const double end = stopped.empty() ? 0.0 : stopped.back().t_end;
    if (end > t + kSameEnd) {
      end_abruptly(robot, t);
    } else {
      robot.committed = std::move(stopped);
      if (robot.previous) robot.previous = split_at(*robot.previous, t);
    }
    pieces_[index] = committed_pieces(robot);
    if (waits_[index]) return;
    waits_[index] = true;
    waiting_.push_back(index);
  }

  /// A robot that cannot stop before it touches another one: what is known of its motion ends there.
  static void end_abruptly(core::Robot& robot, double t) {
    robot.committed = executed_until(robot.committed, t);
    if (!robot.committed.empty()) robot.committed.back().profile.reset();
    robot.previous.reset();
  }

  std::vector<core::Robot>& robots_;
  const std::vector<double>& margins_;   // by robot
  const std::vector<Actions>& braking_;  // by robot
  core::Work& work_;
  std::vector<std::vector<Piece>> pieces_;
  std::vector<double> reach_;  // from the start, with disk and margin; of the commitment as it was
  std::vector<bool> waits_;    // for its comparison with all others
  std::vector<std::size_t> waiting_;
};

}  // namespace

void clear_commitments(std::vector<core::Robot>& robots, const std::vector<double>& margins,
                       const std::vector<std::vector<Action>>& braking, core::Work& work) {
  Clearing(robots, margins, braking, work).run();
}

}  // namespace fleetplan::api
