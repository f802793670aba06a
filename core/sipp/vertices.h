#pragma once

#include <cstddef>
#include <vector>

#include "core/instance.h"

namespace fleetplan::core {

/// The vertices that one robot may stop at: the lattice's, and its own start and goal where they lie off the
/// lattice, each joined to every lattice vertex in sight within two cells.
class Vertices {
 public:
  Vertices(const Instance& instance, std::size_t robot);

  int count() const { return lattice_.vertex_count() + static_cast<int>(own_.size()); }
  int start() const { return start_; }
  /// -1 for a robot without a goal.
  int goal() const { return goal_; }
  Position position(int vertex) const {
    return is_own(vertex) ? own_[own_index(vertex)].position : lattice_.position(vertex);
  }

  /// From one vertex to another.
  Displacement between(int from, int to) const {
    if (is_own(from) || is_own(to)) return Displacement::between(position(from), position(to));
    return lattice_.between(from, to);
  }

  /// Calls visit(vertex) for everything that one static move reaches from `vertex`.
  template <class Visit>
  void for_each_neighbour(int vertex, Visit&& visit) const {
    if (is_own(vertex)) {
      for (const int link : own_[own_index(vertex)].links) visit(link);
      return;
    }
    std::uint32_t mask = moves_.from(vertex);
    for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
      if ((mask & 1u) != 0)
        visit(vertex + lattice_.steps()[k].rows * lattice_.columns() + lattice_.steps()[k].columns);
    }
    for (std::size_t k = 0; k < own_.size(); ++k) {
      if (linked(own_[k], vertex)) visit(lattice_.vertex_count() + static_cast<int>(k));
    }
  }

 private:
  struct OwnVertex {
    Position position;
    std::vector<int> links;  // ascending
  };

  bool is_own(int vertex) const { return vertex >= lattice_.vertex_count(); }
  std::size_t own_index(int vertex) const {
    return static_cast<std::size_t>(vertex - lattice_.vertex_count());
  }
  static bool linked(const OwnVertex& own, int vertex);
  int add(const Instance& instance, double radius, const Position& position);

  const Lattice& lattice_;
  StaticMoves& moves_;
  std::vector<OwnVertex> own_;
  int start_ = -1;
  int goal_ = -1;
};

}  // namespace fleetplan::core
