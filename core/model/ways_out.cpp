#include "core/model/ways_out.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <queue>
#include <utility>

#include "core/geometry/polygon.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/map/lattice.h"
#include "core/map/refinement.h"
#include "core/model/drive_zones.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

namespace {

using Zones = std::vector<std::size_t>;  // indices, ascending

template <class Counts>
Zones zones_of(std::size_t robot, const std::vector<Zone>& zones, const Counts& counts) {
  Zones found;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (counts(zones[k]) && zones[k].is_for(robot)) found.push_back(k);
  }
  return found;
}

bool is_blocked(const Zone& zone) { return zone.type == Zone::Type::blocked; }
bool is_wall(const Zone& zone) { return zone.is_wall(); }
bool is_to_leave(const Zone& zone) { return is_blocked(zone) && zone.may_leave; }

std::shared_ptr<const StaticMap> with_zones(const std::shared_ptr<const StaticMap>& map, const Zones& blocked,
                                            const std::vector<Zone>& zones) {
  std::vector<Polygon> polygons;
  for (const std::size_t k : blocked) polygons.emplace_back(zones[k].polygon);
  return std::make_shared<StaticMap>(map, std::move(polygons));
}

}  // namespace

ZoneMaps::ZoneMaps(std::shared_ptr<const StaticMap> map, const std::vector<Zone>& zones, std::size_t robots,
                   const StopCondition& stop)
    : maps_{std::move(map)} {
  if (std::none_of(zones.begin(), zones.end(), is_blocked)) return;
  const bool any_to_leave = std::any_of(zones.begin(), zones.end(), is_to_leave);
  std::map<Zones, std::size_t> known{{{}, 0}};
  const auto map_with = [&](const Zones& blocked) {
    const auto [found, is_new] = known.emplace(blocked, maps_.size());
    if (is_new) maps_.push_back(with_zones(maps_.front(), blocked, zones));
    return found->second;
  };
  for (std::size_t robot = 0; robot < robots; ++robot) {
    if (stop.met()) {
      finished_ = false;
      return;
    }
    map_of_.push_back(map_with(zones_of(robot, zones, is_blocked)));
    if (any_to_leave) leaving_map_of_.push_back(map_with(zones_of(robot, zones, is_wall)));
  }
}

double distance_to_zone(const Zone& zone, const Position& position) {
  const Polygon polygon(zone.polygon);
  return polygon.contains(position) ? 0.0 : polygon.distance_to_border(position);
}

namespace {

template <class Counts>
std::optional<NearestZone> nearest_zone(const std::vector<Zone>& zones, std::size_t robot,
                                        const Position& position, double reach, const Counts& counts) {
  std::optional<NearestZone> nearest;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (!counts(zones[k]) || !zones[k].is_for(robot)) continue;
    const double distance = distance_to_zone(zones[k], position);
    if (distance < (nearest ? nearest->distance : reach)) nearest = NearestZone{k, distance};
  }
  return nearest;
}

}  // namespace

std::optional<NearestZone> nearest_blocked_zone(const std::vector<Zone>& zones, std::size_t robot,
                                                const Position& position, double reach) {
  return nearest_zone(zones, robot, position, reach, is_wall);
}

std::optional<NearestZone> nearest_zone_to_leave(const std::vector<Zone>& zones, std::size_t robot,
                                                 const Position& position, double reach) {
  return nearest_zone(zones, robot, position, reach, is_to_leave);
}

namespace {

constexpr int kConnectivity = 8;
/// Expansions between two checks of the stop condition.
constexpr std::size_t kStopStride = 64;
/// The start is joined to vertices within this distance, in lattice spacings.
constexpr double kLinkDistance = 2.0;

/// Whether the robot may end its way out at a place that is clear of the zones.
using MayEnd = std::function<bool(const Position&)>;

/// The shortest way of a disk from a place to a place clear of zones, over the vertices of its lattice and
/// straight between them. Theta* without a heuristic (Daniel, Nash, Koenig and Felner, JAIR 2010).
class WayOutSearch {
 public:
  WayOutSearch(const StaticMap& inside, const LineOfSight& outside, const DriveZones& zones, double radius,
               double inflation, const StopCondition& stop)
      : grid_(inside.grid()),
        outside_(outside),
        zones_(zones),
        radius_(radius + inflation),
        lattice_(grid_, kConnectivity, default_lattice_spacing(grid_, radius)),
        space_(lattice_, inside.sight(), radius_, inside.finer_vertices(lattice_, radius_, stop)),
        stop_(stop),
        nodes_(static_cast<std::size_t>(lattice_.vertex_count() + space_.finer().count())) {}

  /// `least`: the radius of the disk where it begins, if walls leave it no more.
  std::vector<Position> find(const Position& from, double least, const MayEnd& may_end) {
    begin(from, std::min(least, radius_));
    StopStride stride(stop_, kStopStride);
    while (!open_.empty()) {
      if (stride.met_at_step()) return {};
      const auto [length, vertex] = open_.top();
      open_.pop();
      Node& node = node_of(vertex);
      if (node.closed) continue;
      node.closed = true;
      if (is_clear(vertex) && may_end(position(vertex))) return way_to(vertex);
      expand(vertex, length);
    }
    return {};
  }

 private:
  struct Node {
    double length = kForever;
    int before = -1;  // the vertex from which it is reached straight; -1: the end of the prefix
    bool closed = false;
  };
  using Open = std::pair<double, int>;  // length and vertex

  Node& node_of(int vertex) { return nodes_[static_cast<std::size_t>(vertex)]; }
  Position position(int vertex) const {
    return vertex < lattice_.vertex_count() ? lattice_.position(vertex) : space_.finer().position(vertex);
  }
  Position place_before(const Node& node) const {
    return node.before < 0 ? prefix_.back() : position(node.before);
  }
  bool is_clear(int vertex) const { return outside_.disk_fits(position(vertex), radius_); }

  void begin(const Position& from, double least) {
    prefix_ = {from};
    if (open_from(least)) return;
    // A disk that is too near to a wall to see a vertex gets to one over the fine lattice.
    const FineLattice fine(grid_, lattice_, radius_);
    for (const Position& place : way_to_lattice(from, least, fine, lattice_, space_)) {
      if (!zones_.allow(prefix_.back(), place)) return;
      prefix_.push_back(place);
    }
    if (prefix_.size() > 1) open_from(radius_);
  }

  /// Returns whether a vertex is in sight of the end of the prefix.
  bool open_from(double radius) {
    const Position from = prefix_.back();
    const double reach = kLinkDistance * lattice_.spacing();
    std::vector<int> near = lattice_.vertices_near(from, reach);
    for (const int finer : space_.finer().near(from, reach)) near.push_back(finer);
    bool any = false;
    for (const int vertex : near) {
      const Position to = position(vertex);
      if (!space_.disk_fits(to, radius_) || !space_.may_sweep(from, to, radius) || !zones_.allow(from, to))
        continue;
      reach_vertex(vertex, -1, (to - from).norm());
      any = true;
    }
    return any;
  }

  void expand(int vertex, double length) {
    std::uint32_t mask = vertex < lattice_.vertex_count() ? space_.steps_from(vertex) : 0;
    for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
      const Lattice::Step& step = lattice_.steps()[k];
      if ((mask & 1u) != 0) extend(vertex, vertex + step.rows * lattice_.columns() + step.columns, length);
    }
    for (const auto& [from, to] : space_.finer().links_from(vertex)) extend(vertex, to, length);
  }

  /// Straight from where the vertex was reached if it can be, otherwise from the vertex. A robot that is
  /// clear of the zones stays so.
  void extend(int vertex, int next, double length) {
    if (node_of(next).closed) return;
    const Position here = position(vertex);
    const Position there = position(next);
    if (is_clear(vertex)) {
      if (outside_.may_sweep(here, there, radius_) && zones_.allow(here, there))
        reach_vertex(next, vertex, length + (there - here).norm());
      return;
    }
    const Node& node = node_of(vertex);
    const Position before = place_before(node);
    const bool is_first = node.before < 0;
    if (!is_first && space_.may_sweep(before, there, radius_) && zones_.allow(before, there)) {
      const double to_before = length - (here - before).norm();
      return reach_vertex(next, node.before, to_before + (there - before).norm());
    }
    if (zones_.allow(here, there)) reach_vertex(next, vertex, length + (there - here).norm());
  }

  void reach_vertex(int vertex, int before, double length) {
    Node& node = node_of(vertex);
    if (node.closed || length >= node.length) return;
    node = {length, before, false};
    open_.push({length, vertex});
  }

  std::vector<Position> way_to(int vertex) {
    std::vector<Position> way;
    for (int at = vertex; at >= 0; at = node_of(at).before) way.push_back(position(at));
    for (std::size_t k = prefix_.size(); k-- > 1;) way.push_back(prefix_[k]);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const OccupancyGrid& grid_;
  const LineOfSight& outside_;
  const DriveZones& zones_;
  const double radius_;  // metres, inflation included
  const Lattice lattice_;
  FreeSpace space_;
  const StopCondition& stop_;
  PagedArray<Node> nodes_;
  std::vector<Position> prefix_;  // the start, and places on the way from there to the lattice
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

/// What a disk needs of the distance to be clear.
double needed(double radius) { return radius - kContactTolerance + kSearchSlack; }

class WaysOut {
 public:
  WaysOut(const ZoneMaps& maps, const std::vector<Zone>& zones, double inflation, std::vector<Robot>& robots,
          const StopCondition& stop)
      : maps_(maps), zones_(zones), inflation_(inflation), robots_(robots), stop_(stop) {}

  std::vector<Leaving> run() {
    std::vector<Leaving> all(robots_.size());
    for (std::size_t robot = 0; robot < robots_.size() && !stop_.met(); ++robot) {
      if (!maps_.may_leave_any(robot) || robots_[robot].invalid || !robots_[robot].goal) continue;
      all[robot] = leaving(robot);
    }
    return all;
  }

 private:
  Leaving leaving(std::size_t index) {
    Robot& robot = robots_[index];
    const std::size_t served = itinerary_of(robot).first_goal;
    const std::vector<double> radii = radii_of(robot);
    Leaving result;
    result.postponed = postponed(index, served, radii);
    const bool has_goals_left = !result.postponed || result.postponed->first > served;
    const bool yields = robot.yields();
    if (result.postponed) take_goals_away(robot, result.postponed->first, has_goals_left);
    find_way(index, radii[served], has_goals_left, result);
    const bool lacks_last_goal = !robot.goal && !robot.via.empty();
    if (result.postponed && (yields || lacks_last_goal)) robot.let_yield();
    return result;
  }

  /// The way out of a robot that begins inside.
  void find_way(std::size_t index, double radius, bool has_goals_left, Leaving& result) {
    const Position from = robots_[index].committed_end().position;
    if (maps_.of(index)->sight().disk_fits(from, needed(radius))) return;
    const auto may_end = [&](const Position& place) {
      return has_goals_left || is_out_of_the_way(index, radius, place);
    };
    result.way_out = way_out(index, from, radius, may_end);
    if (has_goals_left || result.way_out.empty()) return;
    robots_[index].goal = Goal{result.way_out.back(), std::nullopt};
  }

  std::optional<PostponedGoals> postponed(std::size_t index, std::size_t first,
                                          const std::vector<double>& radii) const {
    const Robot& robot = robots_[index];
    const std::size_t count = robot.own_goal_count();
    for (std::size_t k = first; k < count; ++k) {
      const Position& place = robot.goal_at(k).position;
      const double radius = std::max(radii[k], radii[k + 1]);
      if (maps_.of(index)->sight().disk_fits(place, needed(radius))) continue;
      const auto zone = nearest_zone_to_leave(zones_, index, place, radius);
      if (zone) return PostponedGoals{k, count - k, zone->index};
    }
    return std::nullopt;
  }

  /// Leaves so many goals. `has_last`: it stays at the last one of them; otherwise it has no goal to stay at.
  static void take_goals_away(Robot& robot, std::size_t left, bool has_last) {
    robot.via.resize(left);
    robot.goal.reset();
    if (!has_last) return;
    robot.goal = robot.via.back();
    robot.via.pop_back();
  }

  std::vector<Position> way_out(std::size_t index, const Position& from, double radius,
                                const MayEnd& may_end) const {
    const StaticMap& inside = *maps_.while_leaving(index);
    const double fits =
        inside.sight().fitting_radius(from, std::min(needed(radius), radius), radius + inflation_);
    const DriveZones drive(zones_, index, robots_[index]);
    WayOutSearch search(inside, maps_.of(index)->sight(), drive, radius, inflation_, stop_);
    return search.find(from, fits, may_end);
  }

  /// Whether a robot may rest there beside the last goals of others, and beside robots that stay.
  bool is_out_of_the_way(std::size_t index, double radius, const Position& place) const {
    const double own = radius + inflation_ + robots_[index].vicinity;
    for (std::size_t other = 0; other < robots_.size(); ++other) {
      if (other == index) continue;
      const Robot& robot = robots_[other];
      const bool moves = robot.goal && !robot.invalid;
      const Position& rest = moves ? robot.goal->position : robot.committed_end().position;
      const double kept = own + last_radius(robot) + inflation_ + robot.vicinity;
      if ((place - rest).squaredNorm() < kept * kept) return false;
    }
    return true;
  }

  const ZoneMaps& maps_;
  const std::vector<Zone>& zones_;
  const double inflation_;
  std::vector<Robot>& robots_;
  const StopCondition& stop_;
};

}  // namespace

std::vector<Leaving> find_ways_out(const ZoneMaps& maps, const std::vector<Zone>& zones, double inflation,
                                   std::vector<Robot>& robots, const StopCondition& stop) {
  const bool any = std::any_of(zones.begin(), zones.end(), [](const Zone& zone) {
    return zone.type == Zone::Type::blocked && zone.may_leave;
  });
  if (!any) return {};
  return WaysOut(maps, zones, inflation, robots, stop).run();
}

}  // namespace fleetplan::core
