#include "core/advance/committed_motion.h"

// Commitments that end early, or late, so that robots that execute nothing else do not collide.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "core/advance/inertia.h"
#include "core/advance/pieces.h"
#include "core/advance/timeline.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"

namespace fleetplan::core {

namespace {

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

/// When a disk that becomes larger at the end of a service is too near to another disk. The service must not
/// end then.
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
  Clearing(std::vector<Robot>& robots, const std::vector<double>& margins, Motions& motions, Work& work)
      : robots_(robots),
        margins_(margins),
        motions_(motions),
        work_(work),
        driven_on_(robots.size(), 0),
        waits_(robots.size(), true) {
    for (const Robot& robot : robots) {
      reach_.push_back(largest_radius(robot) + margins[pieces_.size()] + driven(robot.committed));
      waiting_.push_back(pieces_.size());
      pieces_.push_back(committed_pieces(robot));
    }
    for (const MovingObstacle& obstacle : motions.obstacles) obstacles_.push_back(pieces_of(obstacle));
  }

  void run() {
    for (std::size_t robot = 0; robot < robots_.size() && !obstacles_.empty(); ++robot) {
      stop_before_obstacles(robot);
    }
    // Bounded: a robot waits again in two cases. Its commitment ends at least kSameEnd earlier, or it is
    // committed to more of its course, each time to more actions than before.
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
  /// The length of the path.
  static double driven(const ActionSequence& actions) {
    double length = 0.0;
    for (const Action& action : actions) length += (action.to.position - action.from.position).norm();
    return length;
  }

  bool may_meet(std::size_t robot, std::size_t other) const {
    const double reach = reach_[robot] + reach_[other];
    const Position apart = robots_[robot].start.position - robots_[other].start.position;
    return apart.squaredNorm() <= reach * reach;
  }

  /// Between the bare disks at the moment; negative if they overlap, metres.
  double gap_now(std::size_t robot, std::size_t other) const {
    const Robot& a = robots_[robot];
    const Robot& b = robots_[other];
    return (a.start.position - b.start.position).norm() - a.radius - b.radius;
  }

  /// The distance that two robots keep between their bare disks: the margins of both. If they are nearer at
  /// the moment, they keep half of their distance, or all of it if it is small. Otherwise, robots that are
  /// measured again and again would creep up to each other, until the rest is less than the errors of their
  /// poses.
  double margin(std::size_t robot, std::size_t other) const {
    const double now = gap_now(robot, other);
    const double whole = margins_[robot] + margins_[other];
    if (now >= whole - kTouch) return whole;
    return std::max({0.0, 0.5 * now, std::min(now, kLittle * whole)});
  }

  /// Until when a robot that drives at the moment cannot stop, seconds; 0 if it stands.
  double cannot_stop_before(std::size_t index) const {
    const std::vector<ActionSequence>& braking = motions_.braking;
    return index < braking.size() && !braking[index].empty() ? braking[index].back().t_end : 0.0;
  }

  /// Stops both robots where they begin to be too near while the other is committed, or as soon as they can.
  /// If that is too late, they go on as planned, if that is better. Otherwise, if both are certain to be
  /// there, their commitments end where their disks touch, because POST /v1/plan refuses commitments that
  /// collide.
  void part(std::size_t robot, std::size_t other) {
    if (pieces_[other].size() == 1 || !may_meet(robot, other)) return;
    if (const auto meeting = first_meeting(robot, other)) {
      if (meeting->first_moves) cut(robot, when_it_can_stop(robot, meeting->t));
      if (meeting->second_moves) cut(other, when_it_can_stop(other, meeting->t));
    }
    if (cannot_stop_before(robot) == 0.0 && cannot_stop_before(other) == 0.0) return;
    give_way(robot, other);
    give_way(other, robot);
    // Plans may pass a robot that stands within its margin.
    for (const double margin : {this->margin(robot, other), 0.0}) {
      if (!keep_apart(pieces_[robot], pieces_[other], margin) && drive_on(robot, other, margin)) return;
    }
    if (const auto contact = first_contact(robot, other)) {
      if (contact->first_moves) cut(robot, contact->t);
      if (contact->second_moves) cut(other, contact->t);
    }
  }

  /// Ends a commitment so early that the robot does not stand in the way of another robot that cannot stop.
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

  /// Whether the other robot does not come too near if this robot ends its commitment at `t`.
  bool may_stand(std::size_t robot, double t, std::size_t other) {
    const std::vector<Piece>& mine = pieces_[robot];
    const auto at_t =
        std::find_if(mine.begin(), mine.end(), [&](const Piece& piece) { return t < piece.end; });
    work_.met_after(kWorkOfAPiece * (mine.size() + pieces_[other].size()));
    Piece stay{t, mine.back().end, at_t->at(t), {0.0, 0.0}, at_t->radius};
    if (robots_[robot].linear_inertia().is_limited) {
      work_.met_after(kWorkOfAnAction * robots_[robot].committed.size());
      const ActionSequence stopped = stopped_by(robots_[robot].committed, t);
      stay.from = stopped.empty() ? robots_[robot].start.position : stopped.back().to.position;
    }
    const double margin = this->margin(robot, other) - kTouch;
    return std::none_of(pieces_[other].begin(), pieces_[other].end(), [&](const Piece& piece) {
      return first_overlap(piece, stay, piece.radius + stay.radius + margin).has_value();
    });
  }

  /// Whether two robots that do this and then stand are never too near, nor become so by their loads.
  bool keep_apart(const std::vector<Piece>& mine, const std::vector<Piece>& theirs, double margin) {
    bool do_meet = false;
    visit_in_time(std::span(mine), std::span(theirs), work_, [&](const Piece& piece, const Piece& other) {
      // Less than where one has stopped already that can.
      const double distance = piece.radius + other.radius + margin - 2.0 * kTouch;
      do_meet = overlap_by_growth(piece, other, distance) || first_overlap(piece, other, distance);
      return do_meet;
    });
    return !do_meet;
  }

  /// Commits two robots, at least one of which cannot stop, to more of their plans, until they stand by their
  /// plans. If it suffices, only one of them. Returns false if they meet nevertheless.
  bool drive_on(std::size_t robot, std::size_t other, double margin) {
    std::size_t mine = 0;  // actions of its course; 0 for the commitment as it is
    std::size_t theirs = 0;
    while (!work_.met()) {
      const std::size_t my_next = next_stop(robot, mine);
      const std::size_t their_next = next_stop(other, theirs);
      if (my_next > mine && parts(robot, my_next, other, theirs, margin))
        return go_on(robot, my_next, other, theirs);
      if (their_next > theirs && parts(robot, mine, other, their_next, margin))
        return go_on(robot, mine, other, their_next);
      if (my_next == mine && their_next == theirs) return false;
      const bool both = my_next > mine && their_next > theirs;
      mine = my_next;
      theirs = their_next;
      if (both && parts(robot, mine, other, theirs, margin)) return go_on(robot, mine, other, theirs);
    }
    return false;
  }

  /// The number of first actions of a robot's course after which it has driven and stands. It is more than
  /// `count`, than its commitment, and than what it has driven on to before; `count` if there is none. So
  /// each robot drives on at most as often as its course has actions, even if its commitment is cut again.
  std::size_t next_stop(std::size_t index, std::size_t count) const {
    if (index >= motions_.courses.size()) return count;
    const ActionSequence& course = motions_.courses[index];
    for (std::size_t k = std::max(count, driven_on_[index]); k < course.size(); ++k) {
      const bool stands = course[k].type == Action::Type::translate &&
                          (k + 1 == course.size() || !goes_on(course[k], course[k + 1]));
      if (stands && course[k].t_end > robots_[index].committed_until() + kSameEnd) return k + 1;
    }
    return count;
  }

  ActionSequence first_of_course(std::size_t index, std::size_t count) const {
    const auto begin = motions_.courses[index].begin();
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
  }

  /// The pieces of a robot that is committed to these actions.
  std::vector<Piece> pieces_if(std::size_t index, ActionSequence committed) {
    work_.met_after(kWorkOfAnAction * (1 + committed.size()));
    Robot robot = robots_[index];
    robot.previous.reset();
    robot.committed = std::move(committed);
    return committed_pieces(robot);
  }

  /// Whether two robots keep apart, and clear of obstacles, if they go on for so many actions of their
  /// courses. A robot that does not go on may stop as soon as it can.
  bool parts(std::size_t robot, std::size_t mine, std::size_t other, std::size_t theirs, double margin) {
    const auto pieces = [&](std::size_t index, std::size_t count) {
      return count > 0 ? pieces_if(index, first_of_course(index, count)) : pieces_[index];
    };
    const std::vector<Piece> my_pieces = pieces(robot, mine);
    const std::vector<Piece> their_pieces = pieces(other, theirs);
    if ((mine > 0 && first_touch(my_pieces)) || (theirs > 0 && first_touch(their_pieces))) return false;
    if (keep_apart(my_pieces, their_pieces, margin)) return true;
    const auto stopped = [&](std::size_t index) {
      const std::vector<ActionSequence>& braking = motions_.braking;
      return pieces_if(index, index < braking.size() ? braking[index] : ActionSequence());
    };
    if (mine == 0) return keep_apart(stopped(robot), their_pieces, margin);
    return theirs == 0 && keep_apart(my_pieces, stopped(other), margin);
  }

  bool go_on(std::size_t robot, std::size_t mine, std::size_t other, std::size_t theirs) {
    if (mine > 0) commit_to(robot, mine);
    if (theirs > 0) commit_to(other, theirs);
    return true;
  }

  /// Commits a robot to the first actions of its course. It does not stop before.
  void commit_to(std::size_t index, std::size_t count) {
    Robot& robot = robots_[index];
    driven_on_[index] = count;
    robot.committed = first_of_course(index, count);
    if (robot.previous) robot.previous = motions_.courses[index];
    motions_.braking.resize(robots_.size());
    motions_.braking[index] = robot.committed;
    pieces_[index] = committed_pieces(robot);
    reach_[index] = largest_radius(robot) + margins_[index] + driven(robot.committed);
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (k == index || may_meet(k, index)) compare_again(k);
    }
  }

  void compare_again(std::size_t index) {
    if (waits_[index]) return;
    waits_[index] = true;
    waiting_.push_back(index);
  }

  /// When a robot that does this touches an obstacle, before it stands in the end.
  std::optional<double> first_touch(const std::vector<Piece>& pieces) {
    const auto moves = [](const Piece& piece) { return piece.moves(); };
    const auto end = std::find_if(pieces.rbegin(), pieces.rend(), moves).base();
    const std::span<const Piece> driven(pieces.begin(), end);
    std::optional<double> first;
    for (const std::vector<Piece>& obstacle : obstacles_) {
      visit_in_time(driven, std::span(obstacle), work_, [&](const Piece& piece, const Piece& other) {
        const auto t = first_overlap(piece, other, piece.radius + other.radius - kTouch);
        if (t) first = std::min(*t, first.value_or(*t));
        return t.has_value();
      });
    }
    return first;
  }

  /// Ends a commitment where the robot can stop at last before it touches an obstacle. Where it can nowhere,
  /// it goes on as planned, if that is better, or stops as soon as it can.
  void stop_before_obstacles(std::size_t index) {
    const std::optional<double> touch = first_touch(pieces_[index]);
    if (!touch) return;
    const double earliest = cannot_stop_before(index);
    if (!robots_[index].linear_inertia().is_limited)
      return cut(index, std::max(earliest, rest_before(index, *touch)));
    constexpr int kTries = 64;     // of times at which it may stand
    constexpr int kHalvings = 40;  // between two of them
    const auto is_clear = [&](double t) {
      return !first_touch(pieces_if(index, stopped_by(robots_[index].committed, t)));
    };
    double late = robots_[index].committed_until();
    const double step = (late - earliest) / kTries;
    double early = late;
    for (int k = 0; k < kTries && !work_.met(); ++k) {
      early = k + 1 < kTries ? early - step : earliest;
      if (is_clear(early)) break;
      late = early;
    }
    if (late == early) {
      const std::size_t stop = next_stop(index, 0);
      if (stop > 0 && !first_touch(pieces_if(index, first_of_course(index, stop)))) {
        return commit_to(index, stop);
      }
      return cut(index, earliest);
    }
    for (int k = 0; k < kHalvings && !work_.met(); ++k) {
      const double middle = 0.5 * (early + late);
      (is_clear(middle) ? early : late) = middle;
    }
    cut(index, early);
  }

  /// The time, or if the robot stands then, when it has stopped.
  double rest_before(std::size_t index, double t) const {
    double stopped = 0.0;
    for (const Action& action : robots_[index].committed) {
      if (action.type != Action::Type::translate) continue;
      if (action.t_start < t && t <= action.t_end) return t;
      if (action.t_end < t) stopped = action.t_end;
    }
    return stopped;
  }

  double when_it_can_stop(std::size_t index, double t) const {
    return std::max(t, cannot_stop_before(index));
  }

  std::optional<Meeting> first_meeting(std::size_t robot, std::size_t other) {
    const std::vector<Piece>& mine = pieces_[robot];
    const std::vector<Piece>& theirs = pieces_[other];
    const double margin = this->margin(robot, other) - kTouch;
    // A robot that stops where it touches goes on touching. Later motion may come nearer.
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
  /// a goal certainly stays at the end of its commitment. A robot that touches another one cannot leave
  /// before it.
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

  /// Without the stay at the end, unless the disk becomes larger as it begins.
  static std::span<const Piece> committed(std::span<const Piece> pieces) {
    return pieces.back().grows ? pieces : pieces.first(pieces.size() - 1);
  }

  /// What is left of a commitment.
  struct Ended {
    ActionSequence committed;
    bool stands;  // or touches another robot before it can stop: what is known of its motion ends there

    double until() const { return committed.empty() ? 0.0 : committed.back().t_end; }
  };

  /// Ends a commitment at a time, or up to kSameEnd later: an action is not cut if nearly nothing of it would
  /// be left.
  Ended ended(const ActionSequence& committed, double t) const {
    work_.met_after(kWorkOfAnAction * committed.size());
    if (t < kNothing) t = 0.0;
    Ended stopped{stopped_by(committed, t), true};
    if (stopped.until() <= t + kSameEnd) return stopped;
    Ended cut{executed_until(committed, t), false};
    if (stopped.until() <= cut.until()) return stopped;
    if (!cut.committed.empty()) cut.committed.back().profile.reset();
    return cut;
  }

  /// Whether a commitment that is to end at `t` becomes shorter. The time alone does not tell: if less of the
  /// action under way is left than can be cut, the commitment would stay as it is, however often it is ended.
  bool shortens(std::size_t index, double t) const {
    const double less = robots_[index].committed_until() - kSameEnd;
    return (t < kNothing ? 0.0 : t) < less && ended(robots_[index].committed, t).until() < less;
  }

  void cut(std::size_t index, double t) {
    Robot& robot = robots_[index];
    work_.met_after(kWorkOfAPiece * pieces_[index].size());
    if (!shortens(index, t)) return;
    Ended end = ended(robot.committed, t);
    robot.committed = std::move(end.committed);
    if (!end.stands) {
      robot.previous.reset();
    } else if (robot.previous) {
      robot.previous = split_at(*robot.previous, t < kNothing ? 0.0 : t);
    }
    pieces_[index] = committed_pieces(robot);
    compare_again(index);
  }

  std::vector<Robot>& robots_;
  const std::vector<double>& margins_;  // by robot
  Motions& motions_;
  Work& work_;
  std::vector<std::vector<Piece>> pieces_;     // by robot
  std::vector<std::vector<Piece>> obstacles_;  // by obstacle
  std::vector<double> reach_;           // from the start, with disk and margin; of the commitment as it was
  std::vector<std::size_t> driven_on_;  // by robot: the actions of its course that it was committed to last
  std::vector<bool> waits_;             // for its comparison with all others
  std::vector<std::size_t> waiting_;
};

}  // namespace

std::vector<double> margins_of(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                               const Moment& moment, const std::vector<Robot>& next, Work& work) {
  // Robots that are released to places where they touch may go there. Two of them stay within the tolerance.
  constexpr double kReleased = -0.4 * kContactTolerance;
  std::vector<double> margins(robots.size(), moment.stand_until ? kReleased : 0.0);
  if (moment.stand_until) return margins;
  for (std::size_t k = 0; k < next.size(); ++k) {
    if (work.met_after(1 + executions[k].actions.size())) break;
    const Pose planned = planned_pose(robots[k], executions[k].actions, moment.at);
    const double off = (next[k].start.position - planned.position).norm();
    margins[k] = robots[k].vicinity + moment.inflation - std::min(off, 0.5 * moment.inflation);
  }
  return margins;
}

void clear_commitments(std::vector<Robot>& robots, const std::vector<double>& margins, Motions& motions,
                       Work& work) {
  Clearing(robots, margins, motions, work).run();
}

}  // namespace fleetplan::core
