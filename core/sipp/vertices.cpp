#include "core/sipp/vertices.h"

#include <algorithm>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// How far an own vertex is joined to the lattice, in lattice spacings.
constexpr double kJoin = 2.0;

}  // namespace

Vertices::Vertices(const Instance& instance, std::size_t robot)
    : lattice_(instance.lattice()), moves_(instance.moves(robot)) {
  const Robot& r = instance.robot(robot);
  const double radius = instance.motion(robot).radius;
  start_ = add(instance, radius, r.start.position);
  if (!r.goal) return;
  const bool same = (r.goal->position - r.start.position).norm() <= kContactTolerance;
  goal_ = same ? start_ : add(instance, radius, r.goal->position);
}

int Vertices::add(const Instance& instance, double radius, const Position& position) {
  const int vertex = lattice_.vertex_at(position);
  if (vertex >= 0) return vertex;
  OwnVertex own{position, {}};
  for (const int near : lattice_.vertices_near(position, kJoin * lattice_.spacing())) {
    if (instance.sight().may_sweep(position, lattice_.position(near), radius)) own.links.push_back(near);
  }
  const int id = count();
  for (std::size_t k = 0; k < own_.size(); ++k) {  // start and goal near each other
    const bool near = (own_[k].position - position).norm() <= kJoin * lattice_.spacing();
    if (!near || !instance.sight().may_sweep(position, own_[k].position, radius)) continue;
    own.links.push_back(lattice_.vertex_count() + static_cast<int>(k));
    own_[k].links.push_back(id);
  }
  own_.push_back(std::move(own));
  return id;
}

bool Vertices::linked(const OwnVertex& own, int vertex) {
  return std::binary_search(own.links.begin(), own.links.end(), vertex);
}

}  // namespace fleetplan::core
