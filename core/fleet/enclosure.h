#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/compile/instance.h"
#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Where a way between obstacles is too narrow for a robot, metres.
struct NarrowPlace {
  Position place;
  double width = 0.0;
  double needed = 0.0;  // by the robot, inflation included
};

/// Finds out whether obstacles and robots that stay for ever close off a robot's goal or its start.
///
/// On its way, the robot's centre crosses borders between cells. Two cells are joined if the robot can cross
/// their common border. One point of the border must be far enough from obstacles and from the robots that
/// stay. Cells are searched from the start and from the goal in turns, so the effort depends on the smaller
/// enclosed area.
///
/// A robot that is closed off has no path, whatever the other robots do. A robot that is not closed off may
/// have no path either, because the insides of cells are not examined.
class Enclosure {
 public:
  enum class Answer : std::uint8_t { open, closed, unknown };
  struct Result {
    Answer answer = Answer::unknown;
    /// If closed: the robots that must all be there to close the way, ascending. Without any one of them, the
    /// way would be open. Empty if obstacles alone close the way.
    std::vector<std::size_t> robots;
  };

  /// `robot` has a goal; `staying` are the robots that stay where their plans would begin. `instance` and
  /// `stop` must outlive this object.
  Enclosure(const Instance& instance, std::size_t robot, const std::vector<std::size_t>& staying,
            const StopCondition& stop);

  /// Finds out whether the robot is closed off. The answer is unknown after `max_steps` steps, or if the stop
  /// condition is met first. A step takes about 50 ns, or more if many disks are near one border.
  ///
  /// Finding the robots may take a few times as many steps. Beyond that, or after the stop, the result has
  /// more robots than necessary, or not all of them.
  Result find(std::int64_t max_steps);

  /// Returns the width of the widest way between obstacles, up to `limit` metres; at least what the robot
  /// needs. None if no way is found within `max_steps` steps, or before the stop condition is met.
  std::optional<double> widest_way(double limit, std::int64_t max_steps);

  /// Returns the narrowest place of the widest way between obstacles, for a robot that they close off. Finds
  /// it by floods of at most `max_steps` steps each, and subtracts the steps from `left`. None in these
  /// cases:
  ///
  /// - Not even a point has a way.
  /// - A flood takes more steps, or no steps are left.
  /// - The stop condition is met first.
  std::optional<NarrowPlace> narrowest_place(std::int64_t max_steps, std::int64_t& left);

 private:
  struct Disk {
    std::size_t robot;
    Position center;
    double reach;  // metres; the robot's centre has to be at least so far away
    bool removed;
  };
  struct Covered {  // a part of a border: an open interval of metres from its begin
    double begin;
    double end;
  };
  struct Border {
    Position begin;
    bool vertical;
  };
  enum class Side : std::uint8_t;
  struct Flood;

  double required_clearance() const;
  Flood flood(std::int64_t max_steps);
  std::optional<Position> gap_of(Flood& closed, double narrower);
  void expand(Flood& flood, std::size_t side);
  bool crossable(const Border& border, Flood& flood, std::size_t side);
  std::pair<Cell, Cell> cells_near(const Border& border);
  void cover_by_obstacles(const Border& border);
  void cover_by(const Border& border, const Position& low, const Position& high, double distance);
  std::vector<Disk*> disks_near(const Border& border);
  bool fully_covered(double length);
  bool is_over();
  std::vector<std::size_t> necessary(const std::vector<Disk*>& removed, std::int64_t max_steps);

  const Instance& instance_;
  const OccupancyGrid& grid_;
  const std::size_t robot_;
  double clearance_;              // metres; the distance to keep from obstacles
  double longest_reach_ = 0.0;    // metres; the longest reach among disks_
  std::vector<Disk> disks_;       // by abscissa
  std::vector<Covered> covered_;  // the covered parts of the border that is examined
  std::int64_t steps_ = 0;        // steps of the present flood
  StopStride stride_;
  std::size_t work_ = 0;  // steps, disks and cells that it has not counted yet
};

}  // namespace fleetplan::core
