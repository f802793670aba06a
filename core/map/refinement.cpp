#include "core/map/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/map/fine_regions.h"

namespace fleetplan::core {
namespace {

/// A lattice whose spacing is less than this many cells is refined between the cells.
constexpr double kCoarseCells = 1.5;
/// A lattice that is finer than this, in cells, misses nothing.
constexpr double kFinestCells = 0.75;
/// The least play of a disk in a gap between cells, in cells, with which it is passed on a grid line. Lower
/// bounds leave out gaps that are tighter; see TightGaps.
constexpr double kLeastPlay = 0.05;
/// Vertices whose regions touch are joined if the lattice has only a long way between them: longer than their
/// bridge by more than this factor and so many spacings.
constexpr double kLongWay = 1.5;
constexpr double kWayRound = 2.0;
/// The spacings by which a way may be longer on the lattice of the cells, whose plans are to change only
/// where it matters.
constexpr double kWayRoundCells = 8.0;
/// The longest links from additional vertices, in spacings.
constexpr double kLinkDistance = 1.5;
/// Paths bend around corners by turns of this at vertices that are placed for it, radians.
constexpr double kTurnAtCorner = 0.25 * std::numbers::pi;
/// The side of a square, in radii, of whose vertices at corners one suffices.
constexpr double kCornerSize = 0.35;
/// Nodes, corners, links or bridges between two checks of the stop condition; fewer where each takes long.
constexpr std::size_t kNodesBetweenPolls = 64;
constexpr std::size_t kCostlyNodesBetweenPolls = 2;

bool is_coarse(const OccupancyGrid& grid, const Lattice& lattice) {
  return lattice.spacing() > kCoarseCells * grid.resolution();
}

/// Whether a disk has no play in a gap of an even number of cells.
bool may_have_tight_gaps(const OccupancyGrid& grid, double radius) {
  const double diameter = 2.0 * radius / grid.resolution();
  const double even = 2.0 * std::ceil(0.5 * diameter - 1e-6);
  return even - diameter < 2.0 * kLeastPlay;
}

class Refinement {
 public:
  Refinement(const FineNodes& nodes, const FineRegions& regions, const LineOfSight& sight,
             const Lattice& lattice, double radius, double needed, double way_round,
             const StopCondition& stop)
      : nodes_(nodes),
        regions_(regions),
        sight_(sight),
        lattice_(lattice),
        needed_(needed),
        way_round_(way_round),
        space_(lattice, sight, radius),
        stop_(stop, nodes.are_costly() ? kCostlyNodesBetweenPolls : kNodesBetweenPolls),
        added_(regions.added()) {}

  /// Adds vertices around the convex corners of obstacles, where the shortest paths bend.
  void add_corners(const OccupancyGrid& grid);
  /// Adds vertices around the convex corners of a polygon.
  void add_corners(const Polygon& polygon);

  /// Refines the lattice. Returns none if the stop condition was met.
  std::optional<FinerVertices> run() {
    const std::vector<Bridge> bridges = find_bridges();
    for (const Bridge& bridge : bridges) {
      if (stop_.met_at_step()) break;
      const double length = bridge.length * nodes_.pitch() / FineRegions::kAxis;
      const double limit = kLongWay * length + way_round_ * lattice_.spacing();
      if (!are_joined(bridge.from, bridge.to, limit)) build(bridge);
    }
    link_to_lattice();
    if (stop_.met()) return std::nullopt;
    return FinerVertices(lattice_.vertex_count(), std::move(added_), std::move(links_));
  }

 private:
  struct Bridge {
    int length = 0;
    int from = 0;
    int to = 0;
    Cell near_from;  // the nodes between which it leaves the region of `from`
    Cell near_to;
  };

  std::vector<Bridge> find_bridges();
  bool is_one_move(int from, int to);
  bool are_joined(int from, int to, double limit);
  void build(const Bridge& bridge);
  void link(int from, int to);
  void link_to_lattice();
  void add_corner(const Position& wanted);

  Position position(int vertex) const {
    return vertex < lattice_.vertex_count()
               ? lattice_.position(vertex)
               : added_[static_cast<std::size_t>(vertex - lattice_.vertex_count())];
  }
  template <class Visitor>
  void for_each_neighbour(int vertex, const Visitor& visit);

  const FineNodes& nodes_;
  const FineRegions& regions_;
  const LineOfSight& sight_;
  const Lattice& lattice_;
  double needed_;  // radius on the way over nodes
  double way_round_;
  FreeSpace space_;
  StopStride stop_;
  std::vector<Position> added_;
  std::vector<FinerVertices::Link> links_;
  std::set<std::pair<int, int>> squares_with_corners_;
  std::unordered_map<int, std::vector<int>> linked_;
};

/// Returns the shortest bridge between every two vertices that have one but no move between them, shorter
/// ones first.
std::vector<Refinement::Bridge> Refinement::find_bridges() {
  std::unordered_map<std::uint64_t, Bridge> shortest;
  regions_.for_each_touch(stop_, [&](const FineRegions::Touch& touch) {
    if (stop_.met_at_step()) return;
    const bool in_order = touch.one_vertex < touch.other_vertex;
    if (is_one_move(in_order ? touch.one_vertex : touch.other_vertex,
                    in_order ? touch.other_vertex : touch.one_vertex)) {
      return;
    }
    const Bridge bridge{touch.length, in_order ? touch.one_vertex : touch.other_vertex,
                        in_order ? touch.other_vertex : touch.one_vertex, in_order ? touch.one : touch.other,
                        in_order ? touch.other : touch.one};
    const auto key = static_cast<std::uint64_t>(bridge.from) << 32 | static_cast<std::uint64_t>(bridge.to);
    const auto [known, is_new] = shortest.try_emplace(key, bridge);
    Bridge& best = known->second;
    if (is_new) best.length = std::numeric_limits<int>::max();
    if (bridge.length < best.length && nodes_.may_step(bridge.near_from, bridge.near_to)) best = bridge;
  });
  std::vector<Bridge> bridges;
  for (const auto& [key, bridge] : shortest) {
    if (bridge.length != std::numeric_limits<int>::max()) bridges.push_back(bridge);
  }
  std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
    return std::tie(a.length, a.from, a.to) < std::tie(b.length, b.from, b.to);
  });
  return bridges;
}

bool Refinement::is_one_move(int from, int to) {
  if (to >= lattice_.vertex_count()) return false;
  const std::span<const Lattice::Step> steps = lattice_.steps();
  const std::uint32_t free_steps = space_.steps_from(from);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const int next = from + steps[k].rows * lattice_.columns() + steps[k].columns;
    if (next == to && (free_steps >> k & 1u) != 0) return true;
  }
  return false;
}

template <class Visitor>
void Refinement::for_each_neighbour(int vertex, const Visitor& visit) {
  if (vertex < lattice_.vertex_count()) {
    std::uint32_t mask = space_.steps_from(vertex);
    for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
      const Lattice::Step& step = lattice_.steps()[k];
      if ((mask & 1u) != 0) visit(vertex + step.rows * lattice_.columns() + step.columns);
    }
  }
  const auto links = linked_.find(vertex);
  if (links == linked_.end()) return;
  for (const int other : links->second) visit(other);
}

/// Whether a way of at most `limit` metres leads from one vertex to another.
bool Refinement::are_joined(int from, int to, double limit) {
  struct Open {
    double f;
    double g;
    int vertex;
    bool operator>(const Open& other) const { return std::tie(f, vertex) > std::tie(other.f, other.vertex); }
  };
  const Position goal = position(to);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  std::unordered_map<int, double> best{{from, 0.0}};
  open.push({(position(from) - goal).norm(), 0.0, from});
  while (!open.empty()) {
    const Open at = open.top();
    open.pop();
    if (at.vertex == to) return true;
    if (at.g > best[at.vertex]) continue;
    const Position here = position(at.vertex);
    for_each_neighbour(at.vertex, [&](int next) {
      const double g = at.g + (position(next) - here).norm();
      const double f = g + (position(next) - goal).norm();
      if (f > limit) return;
      const auto [known, is_new] = best.try_emplace(next, g);
      if (!is_new && known->second <= g) return;
      known->second = g;
      open.push({f, g, next});
    });
  }
  return false;
}

/// Links the vertices: directly, or by the nodes between them that are needed.
void Refinement::build(const Bridge& bridge) {
  std::vector<Position> way = regions_.way_from(bridge.near_from);
  std::reverse(way.begin(), way.end());
  for (const Position& place : regions_.way_from(bridge.near_to)) way.push_back(place);
  int last = bridge.from;
  std::size_t at = 0;
  while (at + 1 < way.size() && !stop_.met()) {
    std::size_t next = way.size() - 1;
    const double max_length = next - at > 1 ? 2.0 * lattice_.spacing() : kForever;
    while (next > at + 1 && !stop_.met_at_step() &&
           ((way[next] - way[at]).norm() > max_length || !sight_.may_sweep(way[at], way[next], needed_))) {
      --next;
    }
    int vertex = bridge.to;
    if (next + 1 < way.size()) {
      vertex = lattice_.vertex_count() + static_cast<int>(added_.size());
      added_.push_back(way[next]);
    }
    link(last, vertex);
    last = vertex;
    at = next;
  }
}

void Refinement::link(int from, int to) {
  links_.emplace_back(from, to);
  linked_[from].push_back(to);
  linked_[to].push_back(from);
}

void Refinement::add_corners(const OccupancyGrid& grid) {
  const double away = needed_ / cosine(0.5 * kTurnAtCorner);
  for (int row = 1; row < grid.rows() && !stop_.met_at_step(); ++row) {
    for (int column = 1; column < grid.columns(); ++column) {
      const bool left = grid.blocked({column - 1, row - 1}) != grid.blocked({column - 1, row});
      const bool right = grid.blocked({column, row - 1}) != grid.blocked({column, row});
      if (left == right) continue;  // no corner, or two that touch
      if (stop_.met_at_step()) return;
      const int behind = left ? column - 1 : column;
      const int beside = left ? column : column - 1;
      if (grid.blocked({beside, row})) continue;  // a concave one
      const double up = grid.blocked({behind, row}) ? -1.0 : 1.0;
      const double to_right = left ? 1.0 : -1.0;
      const Position corner = grid.resolution() * Position(column, row);
      for (const double angle : {0.5 * kTurnAtCorner, 1.5 * kTurnAtCorner}) {
        add_corner(corner + away * Position(to_right * cosine(angle), up * sine(angle)));
      }
    }
  }
}

void Refinement::add_corners(const Polygon& polygon) {
  const double away = needed_ / cosine(0.5 * kTurnAtCorner);
  const std::vector<Position>& corners = polygon.corners();
  const double order = polygon.twice_signed_area() > 0.0 ? 1.0 : -1.0;
  for (std::size_t k = 0; k < corners.size() && !stop_.met_at_step(); ++k) {
    const Position& corner = corners[k];
    const Position in = corner - corners[(k + corners.size() - 1) % corners.size()];
    const Position out = corners[(k + 1) % corners.size()] - corner;
    const double turn = order * arctangent(cross_product(in, out), in.dot(out));
    if (turn <= 0.0) continue;                                             // a concave one
    const double first = heading_of(in) - order * 0.5 * std::numbers::pi;  // away from its edge
    for (double angle = 0.5 * std::min(turn, kTurnAtCorner); angle < turn; angle += kTurnAtCorner) {
      const double at = first + order * angle;
      add_corner(corner + away * unit_vector(at));
    }
  }
}

/// Adds the node nearest to the wanted position, if the disk fits there and a vertex of the lattice is in
/// sight.
void Refinement::add_corner(const Position& wanted) {
  const Cell nearest = nodes_.nearest(wanted);
  std::optional<Position> best;
  // Bounded: the nodes around one place.
  for (int row = nearest.row - 1; row <= nearest.row + 1; ++row) {
    for (int column = nearest.column - 1; column <= nearest.column + 1; ++column) {
      if (column < 0 || row < 0 || column >= nodes_.columns() || row >= nodes_.rows()) continue;
      const Position here = nodes_.position(column, row);
      if (best && (here - wanted).squaredNorm() >= (*best - wanted).squaredNorm()) continue;
      if (nodes_.fits(column, row)) best = here;
    }
  }
  if (!best || lattice_.vertex_at(*best) >= 0) return;
  const std::vector<int> near = lattice_.vertices_near(*best, kLinkDistance * lattice_.spacing());
  const bool is_linked = std::any_of(near.begin(), near.end(), [&](int vertex) {
    return sight_.may_sweep(*best, lattice_.position(vertex), needed_);
  });
  if (!is_linked) return;
  const double size = kCornerSize * needed_;
  const std::pair square{static_cast<int>(best->x() / size), static_cast<int>(best->y() / size)};
  if (squares_with_corners_.insert(square).second) added_.push_back(*best);
}

/// Links additional vertices to the vertices of the lattice around them, for shorter ways.
void Refinement::link_to_lattice() {
  const auto count = static_cast<int>(added_.size());
  const FinerVertices all(lattice_.vertex_count(), added_, {});
  for (int k = 0; k < count && !stop_.met_at_step(); ++k) {
    const Position& here = added_[static_cast<std::size_t>(k)];
    for (const int vertex : lattice_.vertices_near(here, kLinkDistance * lattice_.spacing())) {
      const Position there = lattice_.position(vertex);
      if ((there - here).norm() <= 2.0 * kSamePosition) continue;
      if (sight_.may_sweep(here, there, needed_)) links_.emplace_back(vertex, lattice_.vertex_count() + k);
    }
    for (const int other : all.near(here, kLinkDistance * lattice_.spacing())) {
      if (other <= lattice_.vertex_count() + k) continue;
      if (stop_.met_at_step()) return;
      if (sight_.may_sweep(here, all.position(other), needed_)) {
        links_.emplace_back(lattice_.vertex_count() + k, other);
      }
    }
  }
}

}  // namespace

bool may_need_refinement(const OccupancyGrid& grid, const Lattice& lattice, double radius, bool polygons) {
  if (lattice.spacing() < kFinestCells * grid.resolution()) return false;
  return polygons || is_coarse(grid, lattice) || radius > 0.5 * grid.resolution() + kContactTolerance;
}

FineLattice::FineLattice(const OccupancyGrid& grid, const Lattice& lattice, double robot_radius)
    : radius(robot_radius) {
  const bool half = !is_coarse(grid, lattice);
  pitch = half ? 0.5 * grid.resolution() : grid.resolution();
  first = half ? 0.0 : 0.5 * pitch;
  if (half && may_have_tight_gaps(grid, radius)) radius += kLeastPlay * grid.resolution();
}

std::optional<FinerVertices> refine(const OccupancyGrid& grid, const LineOfSight& sight,
                                    const Lattice& lattice, double radius, const StopCondition& stop) {
  const bool half = !is_coarse(grid, lattice);
  const double needed = FineLattice(grid, lattice, radius).radius;
  const FineNodes nodes(grid, sight, needed, half);
  FineRegions regions(nodes, lattice, needed, sight);
  if (!regions.find(stop)) return std::nullopt;
  Refinement refinement(nodes, regions, sight, lattice, radius, needed, half ? kWayRoundCells : kWayRound,
                        stop);
  if (!half) refinement.add_corners(grid);
  for (const Polygon& polygon : sight.polygons().polygons()) refinement.add_corners(polygon);
  return refinement.run();
}

namespace {

/// Lattice spacings: how far from the position nodes are searched, and how far from them vertices.
constexpr double kFarthestNodes = 4.0;
constexpr double kVertexDistance = 1.5;
/// The first nodes are within this many pitches of the position.
constexpr double kFirstNodes = 2.0;

/// Spreads over the nodes of the fine lattice until a vertex of the lattice is in sight.
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
    const double max_length = is_first ? kFirstNodes * nodes_.pitch : kForever;
    if ((there - last).norm() > max_length || (there - from_).norm() > kFarthestNodes * lattice_.spacing())
      return;
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

  /// Returns the places up to `last`, without places that can be skipped because the next place is in sight.
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
