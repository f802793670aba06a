#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/runtime/random.h"
#include "tests/bench/lifelong/timed_actions.h"
#include "tests/bench/lifelong/warehouse.h"

namespace fleetplan::bench {

struct VehicleType {
  double radius;         // metres
  double linear_speed;   // metres per second
  double angular_speed;  // radians per second
};

/// A robot of the running warehouse. Times are from the simulated clock.
struct Vehicle {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  std::string id;
  VehicleType type{};
  Actions actions;           // what it executes
  core::Pose rest;           // where it is if there are none
  core::Pose goal;           // of its present task
  bool goal_served = false;  // the goal is where the robot comes from, once it has a further task
  double task_began = 0.0;   // when it was free for this task
  double free_at = 0.0;      // when the service at the goal ends; kNever without a plan
  double alone = 0.0;        // seconds that the task takes if no other robot is there, service included

  core::Pose pose(double t) const { return pose_at(actions, t, rest); }
};

/// Whether the robot is being served at its goal at time `now`; `service`: how long that takes.
bool in_service(const Vehicle& vehicle, double now, double service);

/// The robots of the example warehouse: three totes, then a pallet, and so on. They draw their goals at
/// random from the places beside the shelves; no two goals overlap.
class Fleet {
 public:
  /// Robots at rest in random places, with a first goal each.
  Fleet(const Warehouse& warehouse, std::size_t robots, std::uint64_t seed);

  std::vector<Vehicle>& vehicles() { return vehicles_; }
  const std::vector<Vehicle>& vehicles() const { return vehicles_; }

  /// Draws a new goal for a robot.
  void draw_goal(Vehicle& vehicle);

 private:
  core::Random random_;
  std::vector<core::Pose> tote_places_;
  std::vector<core::Pose> pallet_places_;
  std::vector<Vehicle> vehicles_;
};

}  // namespace fleetplan::bench
