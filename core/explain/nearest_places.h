#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry/position.h"
#include "core/map/line_of_sight.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Finds the nearest places with room for disks that do not fit where they are. For messages. All of them
/// together take a bounded number of tests.
class NearestPlaces {
 public:
  /// `origin`: the map's origin in the world, where the coordinates found have few decimals.
  NearestPlaces(const Position& origin, const StopCondition& stop) : origin_(origin), stop_(stop) {}
  NearestPlaces(const NearestPlaces&) = delete;
  NearestPlaces& operator=(const NearestPlaces&) = delete;

  /// Returns a place where the disk fits. It is the nearest place to within 2 %, or 1 cm for fewer decimals.
  /// The disk overlaps obstacles by `overlap` (metres, > 0) at `from`, and no place is nearer than that. None
  /// if no place is found.
  std::optional<Position> of(const LineOfSight& sight, const Position& from, double radius, double overlap);

 private:
  static constexpr std::size_t kTestsBetweenPolls = 32;

  bool fits(const LineOfSight& sight, const Position& place, double radius);
  std::optional<Position> with_few_decimals(const LineOfSight& sight, const Position& from,
                                            const Position& place, double radius);

  Position origin_;
  const StopCondition stop_;
  StopStride stride_{stop_, kTestsBetweenPolls};
  std::size_t tests_ = 0;
};

}  // namespace fleetplan::core
