#pragma once

// The motion of robots that execute only their commitments, and of obstacles, in pieces of straight motion
// and rest.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/position.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Copying a piece, or comparing two, is as much work as reading so many bytes.
inline constexpr std::size_t kWorkOfAPiece = 64;

/// A piece of straight motion or rest.
struct Piece {
  double begin;
  double end;
  Position from;
  Position velocity;    // the mean
  double radius = 0.0;  // of the bare disk
  bool grows = false;   // it is smaller before
  double ramp = 0.0;    // see TimedSegment

  Position at(double t) const { return ramp == 0.0 ? Position(from + velocity * (t - begin)) : disk().at(t); }
  MovingDisk disk() const {
    MovingDisk disk;
    disk.from = from;
    disk.velocity = velocity;
    disk.t_start = begin;
    disk.t_end = end;
    disk.ramp = ramp;
    return disk;
  }
  bool moves() const { return velocity.squaredNorm() > 0.0; }
};

/// Returns the pieces of the commitment, followed by the stay at its end, which has no end.
std::vector<Piece> committed_pieces(const Robot& robot);

/// Returns the pieces of an obstacle, as long as it is there.
std::vector<Piece> pieces_of(const MovingObstacle& obstacle);

/// Returns when two pieces begin to be nearer than a distance, in their common time. If they are nearer at
/// the beginning of this time and come nearer, returns the beginning.
std::optional<double> first_overlap(const Piece& a, const Piece& b, double distance);

/// Calls visit(piece, other) for the pieces of two robots whose times overlap, in the order of time, until it
/// returns true or `work` is met.
template <class Visit>
void visit_in_time(std::span<const Piece> pieces, std::span<const Piece> others, Work& work,
                   const Visit& visit) {
  std::size_t i = 0;
  for (std::size_t k = 0; k < pieces.size() && i < others.size();) {
    if (work.met_after(kWorkOfAPiece) || visit(pieces[k], others[i])) return;
    others[i].end < pieces[k].end ? ++i : ++k;
  }
}

}  // namespace fleetplan::core
