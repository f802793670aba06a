#pragma once

// Pairs of robots that begin or end nearer to each other than the search keeps robots apart.
//
// Two robots may start nearer to each other than the sum of their inflated radii. They may then leave. While
// both stand at their starts or move straight away from them, they only have to come no nearer than they are.
//
// Bare disks may overlap by up to kContactTolerance. Such a robot may leave in the same way. It may also rest
// at a goal that touches another start or goal so.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// Where a robot begins and ends, and how far the search's vertices may be from these positions.
struct Terminals {
  Position start{0.0, 0.0};
  std::optional<Position> goal;
  double pair_radius = 0.0;      // metres at the start, inflation and vicinity included
  double start_rounding = 0.0;   // metres
  double goal_rounding = 0.0;    // metres
  double inflation = 0.0;        // metres, with the vicinity; a part of the pair radius
  double radius_at_start = 0.0;  // metres; neither inflation nor vicinity included
  double radius_at_goal = 0.0;   // metres; neither inflation nor vicinity included
  /// The robot becomes larger only at the start, so it has never been so near to any bare disk before.
  bool grows_at_start = false;
};

/// Where a robot stands, or where its move begins or ends. `leaving`: it moves from its start, and the two
/// robots leave one after the other.
enum class Terminal : std::uint8_t { none, goal, start, leaving };

class Contacts {
 public:
  /// The most contacts of a robot that are listed. A robot with more cannot leave its start.
  static constexpr std::size_t kMaxContacts = 64;

  /// `with_margin`: whether robots keep an interval margin (PlanOptions). Then robots that start too near to
  /// each other leave one after the other.
  explicit Contacts(std::vector<Terminals> robots, bool with_margin = false);

  /// Whether no two robots are in contact.
  bool empty() const;
  /// Whether the robot is in contact with no other robot.
  bool none(std::size_t robot) const { return contacts_[robot].empty(); }
  /// Whether there are more than kMaxContacts.
  bool too_many(std::size_t robot) const { return too_many_[robot]; }
  /// The robots whose starts are too near to the start of this robot, ascending.
  std::vector<std::size_t> at_start(std::size_t robot) const;
  /// By how much the start of this robot is too near to another start, at most. It is the distance that
  /// robots keep, minus the distance of the starts.
  double deficit(std::size_t robot) const;

  /// Whether the robot stands at its start or goal, or moves from its start or to its goal. Returns `none`
  /// for a robot without contacts, or if `radius` (metres) is not its radius at its begin or end. A robot
  /// that `has_left` its start keeps apart from others there, too.
  Terminal terminal(std::size_t robot, const Segment& path, double radius, bool has_left = false) const;

  /// The distance that two robots keep at these ends, metres. `full` if they are not in contact.
  double distance(std::size_t robot, Terminal at, std::size_t other, Terminal other_at, double full) const;

 private:
  struct Contact {
    std::size_t other = 0;
    double leaving = kForever;   // metres; the distance to keep while both are at their starts
    double touching = kForever;  // metres; the distance to keep where at least one of them is at its goal
    /// They leave one after the other: once they have been clear of each other, they come no nearer again.
    /// This is so if the bare disks overlap at the starts by more than contact. With an interval margin, the
    /// disks that are kept apart count instead.
    bool in_turn = false;
  };
  struct Point;

  bool leaves_in_turn(std::size_t robot) const;
  void compare(const Point& a, const Point& b);
  void add(std::size_t robot, const Contact& contact);
  const Contact* find(std::size_t robot, std::size_t other) const;

  std::vector<Terminals> robots_;
  bool with_margin_;
  std::vector<std::vector<Contact>> contacts_;  // by robot
  std::vector<bool> too_many_;                  // by robot
};

}  // namespace fleetplan::core
