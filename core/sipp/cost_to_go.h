#pragma once

// Estimates of the costs to goals and from starts on the static map, without other robots.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/model/body.h"
#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

class Vertices;

/// The time of translations from where a robot sets out, along the fastest ways of lattice moves and links.
/// It is computed as far as needed to reach the goal (A*; Hart, Nilsson and Raphael, 1968). Each move has the
/// greatest speed at its beginning. Unlike a straight line, the ways follow rooms, corridors and zones. They
/// take a small part of the effort of any-angle ways.
class TimesFromStart {
 public:
  /// Between two vertices; `vertices` outlives this object.
  TimesFromStart(const Vertices& vertices, int start, int goal);

  /// Whether there is a way to the goal. None if that takes more than `max_expansions` more expansions, or if
  /// `stop` is met first.
  std::optional<bool> reach_goal(std::int64_t max_expansions, const StopCondition& stop);

  /// A lower bound of the time of the ways to a vertex, seconds; exact on the fastest way to the goal. 0 as
  /// long as the goal is not reached.
  double at_least(int vertex);

  std::int64_t expansions() const { return expansions_; }
  /// Approximate memory in use, bytes.
  std::size_t bytes() const { return times_.bytes(); }

 private:
  struct Time {
    float seconds = static_cast<float>(kForever);
  };
  struct Open {
    float seconds;
    std::int32_t vertex;
  };

  float& time(int vertex) { return times_[static_cast<std::size_t>(vertex)].seconds; }
  double to_goal(int vertex) const;
  void open(int vertex, float seconds);
  void expand(const Open& best);

  const Vertices& vertices_;
  const int goal_;
  const Position goal_position_;
  PagedArray<Time> times_;  // of the fastest ways known
  RadixHeap<Open> open_;    // by the estimated time by way of the vertex to the goal, seconds
  std::int64_t expansions_ = 0;
  bool reached_goal_ = false;
};

/// Estimates h: the cost for one robot, alone on the static map, to get from a vertex to a goal. In sight of
/// the goal, it is the cost of the straight line. Elsewhere, it comes from a backward search from the goal
/// (Lazy Theta*; Nash, Koenig and Tovey, AAAI 2010; rotations included). The search is resumed when it has
/// not reached the vertex yet.
///
/// h is the cost of an existing path, so it may exceed the optimum. It guides the search and is not a lower
/// bound. A robot that may reverse has two costs: with the first translation forwards, and backwards.
class CostToGo {
 public:
  struct Estimate {
    double seconds = 0.0;   // without the rotation to `heading`; kForever if there is no path
    double heading = 0.0;   // of the first translation, forwards
    bool straight = false;  // the goal is in sight
    /// As `seconds`, if the first translation is backwards, with the opposite heading. kForever for a robot
    /// that does not reverse.
    double reverse_seconds = kForever;

    double least() const { return std::min(seconds, reverse_seconds); }
    double with_rotation(double from_heading, const Body& body) const {
      const double ahead = seconds + body.rotation_time(from_heading, heading);
      if (reverse_seconds == kForever) return ahead;
      return std::min(ahead, reverse_seconds + body.rotation_time(from_heading, opposite_heading(heading)));
    }
  };

  /// To the goal with this index in Vertices::goals(). `vertices` must outlive this object. If they have no
  /// start yet, the search goes in all directions, so that estimates do not depend on later starts.
  explicit CostToGo(const Vertices& vertices, std::size_t goal = 0);
  ~CostToGo();

  /// Must be called after Vertices::replace_start(). Keeps what is known of all other vertices.
  void replace_start();

  /// From any vertex but the goal. If `stop` is met during the search, the estimate is the cost of the
  /// straight line.
  Estimate from(int vertex, const StopCondition& stop);

  /// Whether the map has a path from a vertex. None if that takes more than `max_expansions` more expansions,
  /// or if `stop` is met first.
  std::optional<bool> reaches(int vertex, std::int64_t max_expansions, const StopCondition& stop);

  /// The way behind the estimate of from() for a vertex: the vertices at which its translations end, the goal
  /// last. None if it is not known or does not exist.
  std::vector<int> way(int vertex);
  /// Its length, metres.
  double metres(int vertex);

  /// Expansions of the backward search so far.
  std::int64_t expansions() const;

  /// Approximate memory in use, bytes.
  std::size_t bytes() const;

 private:
  class BackwardSearch;

  std::unique_ptr<BackwardSearch> search_;
};

}  // namespace fleetplan::core
