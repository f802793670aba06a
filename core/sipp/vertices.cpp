#include "core/sipp/vertices.h"

#include <algorithm>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/instance.h"

namespace fleetplan::core {
namespace {

/// Own vertices are linked to vertices within this distance, in lattice spacings.
constexpr double kLinkDistance = 2.0;

}  // namespace

Vertices::Vertices(const Instance& instance, std::size_t robot)
    : motion_(instance.motion(robot)),
      lattice_(instance.lattice()),
      sight_(instance.sight()),
      moves_(instance.moves(robot)),
      any_angle_(instance.options().any_angle),
      start_pose_(instance.robot(robot).start) {
  const Robot& r = instance.robot(robot);
  start_ = add(r.start.position);
  if (!r.goal) return;
  goal_heading_ = r.goal->theta;
  const bool same = (r.goal->position - r.start.position).norm() <= kContactTolerance;
  goal_ = same ? start_ : add(r.goal->position);
}

/// Adds an own vertex, unless the position is a vertex of the lattice.
int Vertices::add(const Position& position) {
  const int vertex = lattice_.vertex_at(position);
  if (vertex >= 0) return vertex;
  const double reach = kLinkDistance * lattice_.spacing();
  OwnVertex own{position, {}};
  for (const int near : lattice_.vertices_near(position, reach)) {
    if (sight_.may_sweep(position, lattice_.position(near), motion_.radius)) own.links.push_back(near);
  }
  const int id = count();
  for (std::size_t k = 0; k < own_.size(); ++k) {  // start and goal near each other
    const bool near = (own_[k].position - position).norm() <= reach;
    if (!near || !sight_.may_sweep(position, own_[k].position, motion_.radius)) continue;
    own.links.push_back(lattice_.vertex_count() + static_cast<int>(k));
    own_[k].links.push_back(id);
  }
  own_.push_back(std::move(own));
  return id;
}

bool Vertices::linked(const OwnVertex& own, int vertex) {
  return std::binary_search(own.links.begin(), own.links.end(), vertex);
}

bool Vertices::in_sight(int from, int to) const {
  return sight_.may_sweep(position(from), position(to), motion_.radius);
}

std::uint32_t Vertices::free_steps(int vertex) const { return moves_.from(vertex); }

}  // namespace fleetplan::core
