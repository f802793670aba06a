#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/segment.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A box in space and time.
struct MotionBox {
  Position low{kForever, kForever};
  Position high{-kForever, -kForever};
  double t_begin = kForever;
  double t_end = -kForever;

  void add(const MotionBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    t_begin = std::min(t_begin, other.t_begin);
    t_end = std::max(t_end, other.t_end);
  }
};

/// Moving disks that never change, as a tree of boxes in space and time. It is a packed R-tree in the order
/// of a Z-curve (Kamel and Faloutsos, CIKM 1993). Long motions are entered in pieces, so that their boxes are
/// small. The number of pieces is bounded: a million disks need about 60 MB, whatever the size of the map.
class MotionTree {
 public:
  /// A disk of the tree.
  struct Disk {
    MovingDisk motion;
    double radius = 0.0;  // metres
  };
  /// The range of queries: their disks have at most this radius, and centres in [0, width] x [0, height].
  struct Extent {
    double width = 0.0;
    double height = 0.0;
    double radius = 0.0;
  };

  MotionTree() = default;
  /// If the stop condition is met first, the tree is not finished and must not be used.
  MotionTree(std::vector<Disk> disks, const Extent& extent, const StopCondition& stop);

  bool finished() const { return finished_; }
  const Disk& operator[](std::size_t index) const { return disks_[index]; }

  /// Calls visit(index) for every disk that could come near the centre of `mine`: within `reach` in addition
  /// to its own radius. Times may differ by up to `margin` seconds. A disk may be visited more than once.
  /// Stops and returns false when visit returns false; otherwise returns true.
  template <class Visitor>
  bool visit(const MovingDisk& mine, double reach, double margin, Visitor&& visit) const {
    if (leaves_.empty()) return true;
    return descend(levels_.size() - 1, 0, Query{mine, reach + mine.sag(), margin}, visit);
  }

 private:
  /// How many boxes of a level one box of the level above contains, and how many pieces a leaf contains.
  static constexpr std::size_t kFanOut = 8;

  struct Query {
    const MovingDisk& mine;  // as if at constant speed: the reach includes how far it is from that
    double reach;
    double margin;

    /// Whether the disk's centre is within the reach of the box at some time.
    bool touches(const MotionBox& box) const {
      double begin = std::max(mine.t_start, box.t_begin - margin);
      double end = std::min(mine.t_end, box.t_end + margin);
      for (int axis = 0; axis < 2; ++axis) {
        const double from = mine.from[axis];
        const double speed = mine.velocity[axis];
        const double low = box.low[axis] - reach - from;
        const double high = box.high[axis] + reach - from;
        if (speed == 0.0) {
          if (low > 0.0 || high < 0.0) return false;
          continue;
        }
        const auto [first, last] = std::minmax({low / speed, high / speed});
        begin = std::max(begin, mine.t_start + first);
        end = std::min(end, mine.t_start + last);
      }
      return begin <= end;
    }
  };
  struct Piece {
    std::uint64_t key;    // along the Z-curve
    std::uint32_t disk;   // index
    std::uint32_t part;   // of the disk's motion
    std::uint32_t parts;  // that the motion is divided into
  };

  std::optional<std::vector<Piece>> pieces(const Extent& extent, const StopCondition& stop) const;
  MotionBox box(const Piece& piece) const;
  bool build(const std::vector<Piece>& pieces, const StopCondition& stop);

  template <class Visitor>
  bool descend(std::size_t level, std::size_t index, const Query& query, Visitor& visit) const {
    if (!query.touches(levels_[level][index])) return true;
    const std::size_t begin = index * kFanOut;
    const std::size_t end =
        std::min(begin + kFanOut, level == 0 ? leaves_.size() : levels_[level - 1].size());
    for (std::size_t k = begin; k < end; ++k) {
      if (level == 0 ? !visit(leaves_[k]) : !descend(level - 1, k, query, visit)) return false;
    }
    return true;
  }

  std::vector<Disk> disks_;
  std::vector<std::uint32_t> leaves_;           // disks, in the order of their pieces
  std::vector<std::vector<MotionBox>> levels_;  // from the leaves to the root
  bool finished_ = true;
};

}  // namespace fleetplan::core
