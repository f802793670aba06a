#include "core/map/way_to_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "core/geometry/segment.h"

namespace fleetplan::core {
namespace {

/// Lattice spacings: how far from the position nodes are searched, and how far from them vertices.
constexpr double kFarthestNodes = 4.0;
constexpr double kVertexDistance = 1.5;
/// The first nodes are within this many pitches of the position.
constexpr double kFirstNodes = 2.0;

/// A brushfire over nodes of the fine lattice.
class Brushfire {
 public:
  Brushfire(const Position& from, double radius, const FineLattice& nodes, const Lattice& lattice,
            const FreeSpace& space)
      : from_(from), radius_(radius), nodes_(nodes), lattice_(lattice), space_(space) {}

  std::vector<Position> run() {
    reach_first();
    for (std::size_t k = 0; k < reached_.size(); ++k) {
      if (sees_vertex(reached_[k].position)) return way_to(static_cast<int>(k));
      expand(static_cast<int>(k));
    }
    return {};
  }

 private:
  struct Reached {
    int column;
    int row;
    Position position;
    int before;  // index; -1: the position itself
  };

  void reach_first() {
    const auto index = [&](double x) {
      return static_cast<int>(std::floor((x - nodes_.first) / nodes_.pitch));
    };
    const int reach = static_cast<int>(kFirstNodes);
    // Bounded: the nodes around one place.
    for (int row = index(from_.y()) - reach; row <= index(from_.y()) + reach + 1; ++row) {
      for (int column = index(from_.x()) - reach; column <= index(from_.x()) + reach + 1; ++column) {
        reach_node(column, row, -1);
      }
    }
  }

  void expand(int node) {
    const Reached here = reached_[static_cast<std::size_t>(node)];
    // Bounded: the neighbours of a node.
    for (int row = here.row - 1; row <= here.row + 1; ++row) {
      for (int column = here.column - 1; column <= here.column + 1; ++column) reach_node(column, row, node);
    }
  }

  void reach_node(int column, int row, int before) {
    if (known_.contains({column, row})) return;
    const Position there(nodes_.first + column * nodes_.pitch, nodes_.first + row * nodes_.pitch);
    const bool is_first = before < 0;
    const Position& last = is_first ? from_ : reached_[static_cast<std::size_t>(before)].position;
    const double most = is_first ? kFirstNodes * nodes_.pitch : kForever;
    if ((there - last).norm() > most || (there - from_).norm() > kFarthestNodes * lattice_.spacing()) return;
    if (is_first && !space_.disk_fits(there, nodes_.radius)) return;
    if (!space_.may_sweep(last, there, is_first ? std::min(radius_, nodes_.radius) : nodes_.radius)) return;
    known_.insert({column, row});
    reached_.push_back({column, row, there, before});
  }

  bool sees_vertex(const Position& place) const {
    const double reach = kVertexDistance * lattice_.spacing();
    std::vector<int> near = lattice_.vertices_near(place, reach);
    const std::vector<int> finer = space_.finer().near(place, reach);
    return std::any_of(near.begin(), near.end(),
                       [&](int vertex) {
                         return space_.may_sweep(place, lattice_.position(vertex), nodes_.radius);
                       }) ||
           std::any_of(finer.begin(), finer.end(), [&](int vertex) {
             return space_.may_sweep(place, space_.finer().position(vertex), nodes_.radius);
           });
  }

  /// Only those that are needed to see the next one.
  std::vector<Position> way_to(int last) const {
    std::vector<Position> all;
    for (int k = last; k >= 0; k = reached_[static_cast<std::size_t>(k)].before) {
      all.push_back(reached_[static_cast<std::size_t>(k)].position);
    }
    std::reverse(all.begin(), all.end());
    std::vector<Position> way;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Position& before = way.empty() ? from_ : way.back();
      const double radius = way.empty() ? std::min(radius_, nodes_.radius) : nodes_.radius;
      const bool may_skip = k + 1 < all.size() && (all[k + 1] - before).norm() <= lattice_.spacing() &&
                            space_.may_sweep(before, all[k + 1], radius);
      if (!may_skip) way.push_back(all[k]);
    }
    return way;
  }

  const Position& from_;
  double radius_;
  const FineLattice& nodes_;
  const Lattice& lattice_;
  const FreeSpace& space_;
  std::set<std::pair<int, int>> known_;
  std::vector<Reached> reached_;
};

}  // namespace

std::vector<Position> way_to_lattice(const Position& from, double radius, const FineLattice& nodes,
                                     const Lattice& lattice, const FreeSpace& space) {
  return Brushfire(from, radius, nodes, lattice, space).run();
}

}  // namespace fleetplan::core
