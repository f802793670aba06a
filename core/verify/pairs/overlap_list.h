#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// Two disks overlap by more than the tolerance, without interruption, from t_begin to t_end.
struct Overlap {
  std::size_t first = 0;  // positions in lists of disks
  std::size_t second = 0;
  double t_begin = 0.0;
  double t_end = 0.0;  // infinity if it never ends
  double t_deepest = 0.0;
  double distance = 0.0;  // metres, between the centres at t_deepest
};

/// Collects the overlaps of pairs, piece of time by piece of time.
class OverlapList {
 public:
  /// Further overlaps are left out.
  explicit OverlapList(std::size_t most) : most_(most) {}

  /// Adds the time in which the two are nearer than `allowed` metres, if there is any. Pieces of one pair
  /// come in the order of time; an overlap that goes on from one piece to the next is one.
  void add(std::size_t first, std::size_t second, const RelativeMotion& motion, double allowed);

  std::vector<Overlap> take();

 private:
  std::size_t most_;
  std::vector<Overlap> overlaps_;
  std::unordered_map<std::uint64_t, std::size_t> latest_;  // by pair, the index of its last overlap
};

}  // namespace fleetplan::core
