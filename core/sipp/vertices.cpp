#include "core/sipp/vertices.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/compile/instance.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/map/refinement.h"

namespace fleetplan::core {
namespace {

/// Own vertices are linked to vertices within this distance, in lattice spacings.
constexpr double kLinkDistance = 2.0;
/// In lattice spacings: the longest link of a start that is too near to others, if the robot is clear of them
/// only there.
constexpr double kLongestLink = 12.0;  // > kLinkDistance
/// Comparisons of own vertices and links between two checks of the stop condition.
constexpr std::size_t kWorkBetweenPolls = 16 * 1024;

/// As many as it takes to add one more own vertex, about.
std::size_t work_to_add_to(const OwnVertices& own) {
  const auto count = static_cast<std::size_t>(own.end() - own.first());
  return 1 + 2 * count + (count == 0 ? 0 : own.links(own.end() - 1).size());
}

}  // namespace

OwnVertices::OwnVertices(const Instance& instance, std::size_t robot, std::size_t stage)
    : instance_(instance),
      stage_(stage),
      robot_radius_(instance.views(robot)[stage].body.wall_radius),
      lattice_(instance.lattice(robot)),
      free_space_(*instance.views(robot)[stage].free_space),
      finer_(free_space_.finer()),
      first_(lattice_.vertex_count() + finer_.count()) {}

int OwnVertices::add_start(std::size_t robot) {
  const Leaving* leaving = instance_.problem().leaving(robot);
  const bool has_way_out = leaving != nullptr && !leaving->way_out.empty();
  const Position& position = instance_.itinerary(robot).pose.position;
  const std::size_t before = own_.size();
  const int start = has_way_out ? add_way_out(position, leaving->way_out) : add_start_at(position, robot);
  start_count_ = own_.size() - before;
  never_entered_ = is_clear_at_start(instance_, robot) ? -1 : start;
  return start;
}

void OwnVertices::remove_start() {
  // Bounded: the own vertices of a goal, and their links.
  own_.resize(own_.size() - start_count_);
  start_count_ = 0;
  for (OwnVertex& own : own_) std::erase_if(own.links, [&](int link) { return link >= end(); });
  first_inside_ = std::numeric_limits<int>::max();
  end_inside_ = 0;
  outside_ = -1;
  never_entered_ = -1;
}

int OwnVertices::add_start_at(const Position& position, std::size_t robot) {
  const double radius = radius_at_start(instance_, robot);
  const double too_near = instance_.problem().one_at_a_time() ? 0.0 : instance_.contacts().deficit(robot);
  const double deficit = std::max(robot_radius_ - radius, too_near);
  const int vertex = lattice_vertex_at(position);
  if (vertex >= 0 && radius == robot_radius_ && deficit <= kContactTolerance) return vertex;
  const double reach = reach_with(deficit);
  return add({position, radius, deficit <= kContactTolerance ? kForever : reach, {}}, reach);
}

/// Adds the start and the places on the way out of zones; returns the start.
int OwnVertices::add_way_out(const Position& start_position, const std::vector<Position>& way) {
  const auto add_inside = [&](const Position& position) {
    const int id = end();
    OwnVertex own{position, robot_radius_, kForever, {}};
    if (!own_.empty()) {
      own.links.push_back(id - 1);
      own_.back().links.push_back(id);
    }
    own_.push_back(std::move(own));
  };
  const int start = end();
  add_inside(start_position);
  for (std::size_t k = 0; k + 1 < way.size(); ++k) add_inside(way[k]);
  const int last_inside = end() - 1;
  outside_ = lattice_vertex_at(way.back());
  if (outside_ < 0)
    outside_ = add({way.back(), robot_radius_, kForever, {}}, kLinkDistance * lattice_.spacing());
  const auto link = [&](int from, int to) {
    std::vector<int>& links = at(from).links;
    links.insert(std::lower_bound(links.begin(), links.end(), to), to);
  };
  link(last_inside, outside_);
  if (contains(outside_)) link(outside_, last_inside);
  first_inside_ = start;
  end_inside_ = last_inside + 1;
  return start;
}

int OwnVertices::add_goal(std::size_t robot, const Position& goal, double overlap) {
  const double radius = radius_at_goal(instance_, robot, goal, stage_, overlap);
  const int vertex = lattice_vertex_at(goal);
  if (vertex >= 0 && radius == robot_radius_) return vertex;
  const int own = own_vertex_at(goal);
  if (own >= 0 && !is_only_left(own)) return own;
  const double deficit = robot_radius_ - radius;
  if (overlap <= 0.0 || deficit <= 2.0 * kContactTolerance) {
    return add({goal, radius, kForever, {}}, kLinkDistance * lattice_.spacing());
  }
  const double reach = reach_with(deficit);
  never_left_ = add({goal, radius, reach, {}}, reach);
  return never_left_;
}

/// How far an own vertex is linked to others, metres, if so much of the disk is missing: two metres for each
/// metre, because the way to where the disk is clear need not be straight.
double OwnVertices::reach_with(double deficit) const {
  return std::min(kLinkDistance * lattice_.spacing() + 2.0 * deficit, kLongestLink * lattice_.spacing());
}

/// Adds an own vertex; where that has no links, also vertices that lead to others.
int OwnVertices::add(const OwnVertex& own, double reach) {
  const int id = add_linked(own, reach);
  const OccupancyGrid& grid = instance_.problem().grid();
  if (!own_.back().links.empty() ||
      !may_need_refinement(grid, lattice_, robot_radius_, free_space_.among_polygons()))
    return id;
  const FineLattice nodes(grid, lattice_, robot_radius_);
  for (const Position& place : way_to_lattice(own.position, own.radius, nodes, lattice_, free_space_)) {
    if (own_vertex_at(place) < 0) add_linked({place, robot_radius_, kForever, {}}, reach);
  }
  return id;
}

/// Adds an own vertex with links to the vertices within `reach` metres.
int OwnVertices::add_linked(OwnVertex own, double reach) {
  std::vector<int> all = lattice_.vertices_near(own.position, reach);
  for (const int near : finer_.near(own.position, reach)) all.push_back(near);
  for (const int near : all) {
    const Position to = position_of_any(near);
    if (is_same_position(to, own.position)) continue;
    const bool clear = own.radius == robot_radius_ || free_space_.disk_fits(to, robot_radius_);
    if (clear && may_move(own, to, robot_radius_)) own.links.push_back(near);
  }
  const int id = end();
  for (std::size_t k = 0; k < own_.size(); ++k) {  // start and goal near each other
    const double distance = (own_[k].position - own.position).norm();
    if (distance <= kSamePosition || distance > reach || !may_move(own, own_[k].position, own_[k].radius))
      continue;
    own.links.push_back(first_ + static_cast<int>(k));
    own_[k].links.push_back(id);
  }
  own_.push_back(std::move(own));
  return id;
}

Position OwnVertices::position_of_any(int vertex) const {
  if (vertex < lattice_.vertex_count()) return lattice_.position(vertex);
  return contains(vertex) ? position(vertex) : finer_.position(vertex);
}

/// The vertex of the refined lattice at this position, or -1.
int OwnVertices::lattice_vertex_at(const Position& position) const {
  const int vertex = lattice_.vertex_at(position);
  if (vertex >= 0 || finer_.count() == 0) return vertex;
  const std::vector<int> near = finer_.near(position, kSamePosition);
  return near.empty() ? -1 : near.front();
}

/// An own vertex at this position, or -1.
int OwnVertices::own_vertex_at(const Position& position) const {
  const auto own = std::find_if(own_.begin(), own_.end(), [&](const OwnVertex& vertex) {
    return is_same_position(vertex.position, position);
  });
  return own == own_.end() ? -1 : first_ + static_cast<int>(own - own_.begin());
}

bool OwnVertices::is_linked(const OwnVertex& own, int vertex) {
  if (own.links.empty() || vertex < own.links.front() || vertex > own.links.back()) return false;
  return std::binary_search(own.links.begin(), own.links.end(), vertex);
}

bool OwnVertices::is_free(int from, int to) const {
  if (is_inside(from) || is_inside(to)) return leads_out(from, to);
  if (!contains(from)) return may_move(at(to), position_of_any(from), robot_radius_);
  if (is_only_entered(to)) return may_move(at(to), position(from), at(from).radius);
  return may_move(at(from), position_of_any(to), contains(to) ? at(to).radius : robot_radius_);
}

/// `radius`: at the other end.
bool OwnVertices::may_move(const OwnVertex& own, const Position& to, double radius) const {
  const bool within_reach = (to - own.position).norm() <= own.reach;
  return free_space_.may_sweep(own.position, to, within_reach ? std::min(own.radius, radius) : robot_radius_);
}

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage)
    : times_(instance.views(robot)[stage].body, instance.views(robot)[stage].zones.get()),
      zones_(instance.views(robot)[stage].zones.get()),
      lattice_(instance.lattice(robot)),
      free_space_(*instance.views(robot)[stage].free_space),
      finer_(free_space_.finer()),
      any_angle_(instance.options().any_angle),
      own_(instance, robot, stage) {}

Vertices::Vertices(const Instance& instance, std::size_t robot, const Goal& goal)
    : Vertices(instance, robot, std::size_t{0}) {
  goals_.push_back({own_.add_goal(robot, goal.position, instance.options().goal_overlap), goal.theta});
}

void Vertices::replace_start(const Instance& instance, std::size_t robot) {
  own_.remove_start();
  const int goal = goals_.front().vertex;
  const bool at_goal = is_same_position(instance.itinerary(robot).pose.position, position(goal));
  start_ = at_goal ? goal : own_.add_start(robot);
}

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop)
    : Vertices(instance, robot, instance.itinerary(robot), stage, stop) {}

Vertices::Vertices(const Instance& instance, std::size_t robot, const Itinerary& itinerary, std::size_t stage,
                   const StopCondition& stop)
    : Vertices(instance, robot, stage) {
  const Views& views = instance.views(robot);
  const std::size_t own = views.number(stage);
  if (views.number(0) == own) start_ = own_.add_start(robot);
  // Committed actions that end in contact with the goal end there: a service goes on, without a move.
  double same = itinerary.is_committed ? kContactTolerance : kSamePosition;
  StopStride stride(stop, kWorkBetweenPolls);
  for (std::size_t k = 0; k < itinerary.goals.size(); ++k) {
    if (stride.met_after(work_to_add_to(own_))) {
      finished_ = false;
      return;
    }
    const Goal& goal = itinerary.goals[k];
    if (goal.anywhere) {  // wherever the robot comes to this stage
      goals_.push_back({goals_.empty() ? start_ : goals_.back().vertex, std::nullopt});
      continue;
    }
    const bool is_here = views.number(k) == own || views.number(k + 1) == own;
    const bool at_start = start_ >= 0 && (k == 0 || !own_.is_only_left(start_)) &&
                          (goal.position - itinerary.pose.position).norm() <= same;
    const double overlap = k + 1 == itinerary.goals.size() ? instance.options().goal_overlap : 0.0;
    const int vertex = at_start ? start_ : is_here ? own_.add_goal(robot, goal.position, overlap) : -1;
    goals_.push_back({vertex, goal.theta});
    same = kSamePosition;
  }
}

bool Vertices::is_free(int from, int to) const {
  if (own_.contains(from) || own_.contains(to)) return own_.is_free(from, to);
  return free_space_.may_sweep(position(from), position(to), body().wall_radius);
}

}  // namespace fleetplan::core
