#include "core/reservation/fixed_reservations.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Seconds; obstacles are there for so much longer at both ends, so that the instants at which they appear
/// and vanish are occupied. Far above the rounding of times.
constexpr double kInstant = 1e-6;
/// Seconds; no motion is shorter, so that velocities are finite.
constexpr double kShortestMotion = 1e-9;

}  // namespace

/// Collects the disks of the tree and their owners.
class FixedReservations::Collector {
 public:
  explicit Collector(std::vector<Owner>& owners) : owners_(owners) {}

  void add(const TimedSegment& segment, double radius, const Owner& owner) {
    disks_.push_back({MovingDisk(segment), radius});
    owners_.push_back(owner);
  }

  void add_obstacle(const MovingObstacle& obstacle, std::uint32_t index) {
    const Owner owner{index, true, false, Terminal::none, obstacle.radius};
    const auto& first = obstacle.motion.front();
    const auto& last = obstacle.motion.back();
    const auto rest = [&](const Position& position, double t_begin, double t_end) {
      add({{position, position}, t_begin, t_end}, obstacle.radius, owner);
    };
    rest(first.position, first.t - kInstant, first.t);
    for (std::size_t k = 1; k < obstacle.motion.size(); ++k) {
      const auto& from = obstacle.motion[k - 1];
      const auto& to = obstacle.motion[k];
      const double t_end = std::max(to.t, from.t + kShortestMotion);
      add({{from.position, to.position}, from.t, t_end}, obstacle.radius, owner);
    }
    rest(last.position, last.t,
         obstacle.after == MovingObstacle::After::stays ? kForever : last.t + kInstant);
  }

  void add_robot(const Committed& robot, std::uint32_t index, const Contacts* contacts) {
    bool from_start = true;
    for (const SizedSegment& segment : robot.committed) {
      from_start = from_start && segment.radius == robot.radius_at_start &&
                   is_same_position(segment.path.from, robot.start);
      const Terminal terminal =
          contacts != nullptr ? contacts->terminal(index, segment.path, segment.radius) : Terminal::none;
      add(segment, robot.disk.pair_radius_with(segment.radius),
          {index, false, from_start, terminal, segment.radius});
    }
  }

  std::vector<MotionTree::Disk> disks() { return std::move(disks_); }

 private:
  std::vector<Owner>& owners_;
  std::vector<MotionTree::Disk> disks_;
};

FixedReservations::FixedReservations(double width, double height, std::vector<Committed> robots,
                                     const std::vector<MovingObstacle>& obstacles, const Contacts* contacts,
                                     const StopCondition& stop)
    : robots_(std::move(robots)) {
  double largest = 0.0;
  for (const Committed& robot : robots_) {
    largest = std::max(largest, robot.disk.pair_radius);
    if (!robot.committed.empty()) empty_ = false;
    has_ramps_ = has_ramps_ || std::any_of(robot.committed.begin(), robot.committed.end(),
                                           [](const SizedSegment& segment) { return segment.ramp != 0.0; });
  }
  if (!obstacles.empty()) empty_ = false;
  if (empty_) return;
  try {
    Collector collector(owners_);
    known_ = true;
    for (std::uint32_t i = 0; i < obstacles.size() && known_; ++i) {
      known_ = !stop.met();
      if (known_) collector.add_obstacle(obstacles[i], i);
    }
    for (std::uint32_t i = 0; i < robots_.size(); ++i) collector.add_robot(robots_[i], i, contacts);
    if (known_) tree_ = MotionTree(collector.disks(), {width, height, largest}, stop);
    known_ = known_ && tree_.finished();
  } catch (const std::bad_alloc&) {  // not granted to the job
    known_ = false;
  }
  if (known_) return;
  tree_ = MotionTree();
  owners_ = {};
}

bool FixedReservations::begins_at_commitment_end(std::size_t robot, const Position& from) const {
  return is_same_position(robots_[robot].committed_end, from);
}

}  // namespace fleetplan::core
