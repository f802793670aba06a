#pragma once

// The smallest gap between robots over all time, and where robots overlap. Found with the boxes of moving
// disks, in one window of time after the other.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// Returns the boundaries of time windows in which each robot has about half a leg, ascending. The first is
/// 0, the last the time at which all robots have come to rest. Only 0 if no robot ever moves. `others` move
/// among the robots, and also have about half a leg in each window.
std::vector<double> time_windows(const std::vector<std::vector<Leg>>& legs_by_robot,
                                 const std::vector<std::vector<Leg>>& others = {});

/// The bounding box of a disk within a time window.
struct MovingBox {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::size_t body = 0;
  double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;

  void include(const Position& position);
  void enlarge(double distance);
};

class MovingBoxes {
 public:
  /// The boxes of bodies with these `legs`. `reach`: by body, how far its boxes are enlarged, metres. A slack
  /// is added that is far more than the rounding of boxes, and far less than the radius of a robot.
  MovingBoxes(const std::vector<std::vector<Leg>>& legs, std::vector<double> reach);

  /// Returns the boxes of the bodies that are present within a closed window, by their left edges. Later
  /// calls must not have earlier windows.
  std::vector<MovingBox> in(const TimeSpan& window);

  /// Returns the legs of a body that do not end before the last window.
  std::span<const Leg> legs(std::size_t body) const { return std::span(legs_[body]).subspan(current_[body]); }

 private:
  const std::vector<std::vector<Leg>>& legs_;
  std::vector<double> reach_;
  std::vector<std::size_t> current_;  // by body, the first leg that does not end before the window
};

/// An uninterrupted overlap of two disks by more than the tolerance, from t_begin to t_end.
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
  /// A list of at most `max` overlaps. Further overlaps are left out.
  explicit OverlapList(std::size_t max) : max_(max) {}

  /// Adds the time in which the two are nearer than `allowed` metres, if there is any. The pieces of one pair
  /// come in the order of time. An overlap that goes on from one piece to the next is one overlap.
  void add(std::size_t first, std::size_t second, const RelativeMotion& motion, double allowed);

  std::vector<Overlap> take();

 private:
  std::size_t max_;
  std::vector<Overlap> overlaps_;
  std::unordered_map<std::uint64_t, std::size_t> latest_;  // by pair, the index of its last overlap
};

struct FleetClearance {
  std::optional<double> least;    // metres: smallest gap between two bodies; none for fewer than two robots
  std::vector<Overlap> overlaps;  // pairs of positions in the list of radii, first < second; in no order
};

/// The radii of robots, metres.
struct DiskRadii {
  const std::vector<double>& body;
  const std::vector<double>& kept_apart;  // the radii that are kept apart, each >= the radius of the body
};

/// Whether an overlap of two robots that rest for ever is left out of the list.
using LeftOutAtRest = std::function<bool(const Overlap&)>;

/// Returns the smallest gap and the overlaps of a fleet, exact up to rounding: a few ulp of the coordinates.
/// `legs_by_robot` are results of execute(); `radii` and `tolerances` (metres) are in the same order. Two
/// robots may overlap by the larger of their tolerances.
///
/// At most `max_overlaps` are listed. Missing overlaps begin later than the listed ones, or slightly earlier.
/// Overlaps for which `left_out` (which may be empty) holds are not listed. `least` always includes all pairs
/// and all time, and does not depend on the order of the robots. Returns none if `stop` is met first.
std::optional<FleetClearance> fleet_clearance(const std::vector<std::vector<Leg>>& legs_by_robot,
                                              const DiskRadii& radii, const std::vector<double>& tolerances,
                                              std::size_t max_overlaps, const StopCondition& stop,
                                              const LeftOutAtRest& left_out = {});

}  // namespace fleetplan::core
