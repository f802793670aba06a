#pragma once

// Steps of a fleet: one robot moves at a time, while all others rest.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/segment.h"
#include "core/moves/configuration_search.h"
#include "core/moves/step_places.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Which robots would touch each other, by their places. Not thread-safe.
class JointSteps {
 public:
  /// `robots` outlive this object.
  explicit JointSteps(const std::vector<StepPlaces>& robots);

  std::size_t size() const { return robots_.size(); }
  const StepPlaces& robot(std::size_t k) const { return robots_[k]; }

  /// What one robot does in a step: it moves from one place to another, or rests.
  struct Move {
    std::size_t robot = 0;
    int from = -1;
    int to = -1;

    bool rests() const { return from == to; }
  };
  /// Whether the moving robot would touch another robot that rests at a place.
  bool touches(const Move& move, std::size_t other, int place) const;

  /// Whether it would touch any other robot if it makes this step alone. `at`: the places of all robots.
  bool touches_any(std::size_t robot, const StepPlaces::Step& step, const Configuration& at) const;
  bool is_end(const Configuration& at) const;

  /// Which of two robots has to move first in a step.
  enum class Order : std::uint8_t { any, first, second, none };
  /// `none`: neither order keeps them apart.
  Order order_of(const Move& first, const Move& second) const;

  /// The robots that move in a step from one configuration to the next, in an order in which they can move
  /// one after the other. None if there is no such order.
  std::optional<std::vector<std::size_t>> order_of_step(const Configuration& from,
                                                        const Configuration& to) const;

 private:
  double reach(const Move& move, std::size_t other, int place) const;

  enum class Known : std::uint8_t { nothing, clear, touching };

  const std::vector<StepPlaces>& robots_;
  std::vector<std::vector<float>> start_distance_;  // metres, by robot and robot; kForever if clear
  std::vector<std::size_t> first_step_;             // by robot, among the steps of all robots
  std::vector<std::size_t> first_place_;            // by robot, among the places of all robots
  mutable std::vector<Known> known_;                // by step, then by place; empty if there are too many
};

}  // namespace fleetplan::core
