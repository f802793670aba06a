#pragma once

// The earliest times at which one robot can follow a given path among reservations.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/compile/instance.h"
#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/model/itinerary.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// A path of straight moves from stop to stop, with the earliest times at which the robot can follow it. It
/// is safe-interval path planning (Phillips and Likhachev, ICRA 2011) in which only the times are free. Each
/// stop has the earliest arrival in each of its safe intervals. Stops need not be vertices.
///
/// It requires that
///
/// - the robot follows a planned trajectory to its goals, with one load,
/// - it is not at its first goal when its plan begins,
/// - and there is no horizon.
class TimedPath {
 public:
  using Accept = std::function<bool(const Trajectory&)>;

  /// The robot holds no reservation in `table`, or an ignored one. Once `stop` is met, no path is timed. The
  /// arguments must outlive this object.
  TimedPath(const Instance& instance, const ReservationTable& table, std::size_t robot,
            const StopCondition& stop);
  /// Whether paths of the robot can be timed.
  static bool may_be_timed(const Instance& instance, std::size_t robot);
  TimedPath(const TimedPath&) = delete;
  TimedPath& operator=(const TimedPath&) = delete;

  /// Takes the path of a trajectory of the robot. Returns false if the path cannot be followed as fast, or
  /// cannot be timed.
  bool follow(const Trajectory& trajectory);

  /// The stops, the begin and the end included.
  std::size_t stop_count() const { return stops_.size(); }
  const Position& position(std::size_t stop) const { return stops_[stop].position; }
  /// Whether the path may leave out this stop: it serves no goal, and the robot does not turn back there.
  bool is_bend(std::size_t stop) const;

  /// Replaces `count` stops, from `first` on, by at most one. They must be bends. Returns false, and changes
  /// nothing, unless all of these hold:
  ///
  /// - The moves are free of obstacles.
  /// - The robot reaches the next stops sooner.
  /// - The trajectory costs less than `bound` seconds and satisfies `accept`.
  bool replace(std::size_t first, std::size_t count, const std::optional<Position>& by, double bound,
               const Accept& accept);

  /// The trajectory along the path.
  const Trajectory& trajectory() const { return trajectory_; }
  /// How many paths were timed so far.
  std::int64_t timed() const { return timed_count_; }

 private:
  /// The earliest arrival in a safe interval.
  struct Arrival {
    double t = 0.0;          // seconds
    double ready = 0.0;      // seconds: then the goals of the stop are served
    double departure = 0.0;  // seconds, from the stop before
    std::size_t from = 0;    // of the arrivals there
    SafeInterval safe;
  };
  /// A stop, and the move to it.
  struct Stop {
    Position position{0.0, 0.0};
    bool reverse = false;        // the move
    std::size_t goals_end = 0;   // the robot leaves with so many of Itinerary::goals served
    double heading = 0.0;        // of the robot during the move
    double heading_after = 0.0;  // once the goals of the stop are served
    double duration = 0.0;       // seconds, of the move
    double least_left = 0.0;     // seconds from the arrival to the end of the path, at least
    std::vector<SafeInterval> safe;
    std::vector<Arrival> arrivals;  // ascending
  };

  bool set_stops(const Trajectory& trajectory);
  bool set_goals(const Trajectory& trajectory, const std::vector<double>& arrivals);
  void set_move(const Stop& from, Stop& to) const;
  double least_left(const Stop& before, const Stop& stop, const Stop* next) const;
  void set_least_left(std::size_t count);
  void set_safe_intervals(const Stop& from, Stop& to, bool is_last) const;
  void begin(Stop& stop) const;

  std::optional<std::size_t> try_replace(std::size_t first, std::size_t count,
                                         const std::optional<Position>& by, double bound);
  Footprint footprint(const Stop& stop) const;
  double preparation(const Stop& from, const Stop& to) const;
  double served(const Stop& from, const Stop& to, double t, std::vector<Visit>* visits = nullptr) const;
  bool arrive(const Stop& from, Stop& to, double bound);
  bool is_sooner(const Stop& tried, const Stop& now) const;
  Trajectory trajectory_of(const std::vector<Stop>& stops) const;

  const ReservationTable& table_;
  const StopCondition stop_;
  StopStride stride_;  // asks stop_ at every stop, or at some of them
  const std::size_t robot_;
  const View& view_;
  const Itinerary& itinerary_;
  const MoveTimes times_;
  const bool may_be_timed_;
  std::vector<Stop> stops_;
  std::vector<Stop> tried_;  // of try_replace(); kept for their memory
  Trajectory trajectory_;
  std::int64_t timed_count_ = 0;
};

}  // namespace fleetplan::core
