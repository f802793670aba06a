#include "tests/bench/lifelong/fleet.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace fleetplan::bench {
namespace {

constexpr VehicleType kTote{0.2, 1.5, std::numbers::pi};
constexpr VehicleType kPallet{0.3, 1.0, 2.0};

bool is_pallet(std::size_t number) { return number % 4 == 3; }

}  // namespace

bool in_service(const Vehicle& vehicle, double now, double service) {
  return vehicle.free_at != Vehicle::kNever && vehicle.free_at - service <= now && now < vehicle.free_at;
}

Fleet::Fleet(const Warehouse& warehouse, std::size_t robots, std::uint64_t seed)
    : random_(seed),
      tote_places_(shelf_places(warehouse, kTote.radius)),
      pallet_places_(shelf_places(warehouse, kPallet.radius)) {
  vehicles_.reserve(robots);
  for (std::size_t number = 0; number < robots; ++number) {
    Vehicle& vehicle = vehicles_.emplace_back();
    vehicle.id = (is_pallet(number) ? "pallet-" : "tote-") + std::to_string(number + 1);
    vehicle.type = is_pallet(number) ? kPallet : kTote;
    draw_goal(vehicle);
  }
  for (Vehicle& vehicle : vehicles_) vehicle.rest = vehicle.goal;
  for (Vehicle& vehicle : vehicles_) draw_goal(vehicle);
}

void Fleet::draw_goal(Vehicle& vehicle) {
  const auto& places = vehicle.type.radius == kPallet.radius ? pallet_places_ : tote_places_;
  const auto is_free = [&](const core::Pose& place) {
    return std::none_of(vehicles_.begin(), vehicles_.end(), [&](const Vehicle& other) {
      const double apart = (other.goal.position - place.position).norm();
      return apart < vehicle.type.radius + other.type.radius;  // its own last goal, too
    });
  };
  constexpr int kMaxDraws = 100'000;
  for (int drawn = 0; drawn < kMaxDraws; ++drawn) {
    const core::Pose& place = places[random_.below(places.size())];
    if (!is_free(place)) continue;
    vehicle.goal = place;
    return;
  }
  throw std::runtime_error("too many robots for the places beside the shelves");
}

}  // namespace fleetplan::bench
