#pragma once

// How a robot with limited acceleration drives: as fast as its limits allow, and so that it stands where it
// has to stop. This place may change while the robot is on its way.

#include <cstddef>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/speed_profile.h"

namespace fleetplan::core {

/// Returns the number of the action after this drive. The drive is this action, which has a profile, and the
/// translations that follow it at speed.
std::size_t end_of_drive(Actions actions, std::size_t first);

/// A part of a drive within one action, at constant acceleration. Times in seconds.
struct DrivenPiece {
  std::size_t action = 0;
  double t_start = 0.0;
  double t_end = 0.0;
  double from = 0.0;  // fractions of the length (or angle) of the action
  double to = 0.0;
  double ramp = 0.0;  // see TimedSegment
};

/// One drive: actions that follow each other without a stop, unless the robot has to stop in between. Places
/// are in metres (or radians) from the begin of the first action. The robot stands until head_for() is
/// called.
class Drive {
 public:
  /// The actions from `first` on, to the end of the drive. Speeds are the speeds of the profiles, times
  /// `factors` (> 0, one by action of the drive, or one for all). At `t`, the robot has done this fraction of
  /// the first action and has this speed (metres or radians per second). The speed is lowered where the robot
  /// could not stop otherwise.
  Drive(Actions actions, std::size_t first, const std::vector<double>& factors, double t, double speed,
        double fraction = 0.0);

  /// The number of the action after the actions of the drive.
  std::size_t end() const { return first_ + parts_.size(); }
  double length() const { return begins_.back(); }
  /// Returns the place of a progress within these actions.
  double place_of(std::size_t action, double fraction) const;

  double now() const { return t_; }
  double at() const { return at_; }
  double speed() const { return speed_; }
  bool stands() const { return next_ == pieces_.size(); }
  bool slows_down() const { return !stands() && pieces_[next_].end < pieces_[next_].start; }

  /// Plans the way from where the robot is to rest at a place ahead.
  void head_for(double place);
  /// The place that the robot heads for. If it stands, the place where it is.
  double heading_for() const { return stands() ? at_ : pieces_.back().to; }
  /// Returns when the robot comes to a place on its way.
  double time_at(double place) const;
  /// Drives on to a place on its way, or until a time. Returns the pieces that it drives.
  std::vector<DrivenPiece> drive_to(double place);
  std::vector<DrivenPiece> drive_until(double t);
  /// Stands until a later time.
  void stand_until(double t) {
    t_ = t;
    speed_ = 0.0;
  }

 private:
  /// A part of the way ahead at constant acceleration.
  struct Piece {
    std::size_t part = 0;
    double t_start = 0.0;
    double t_end = 0.0;
    double from = 0.0;  // places
    double to = 0.0;
    double start = 0.0;  // speeds
    double end = 0.0;

    double ramp() const { return start == end ? 0.0 : (end - start) / (end + start); }
    double time_at(double place) const;
    Piece until(double t, double place) const;
    Piece since(double t, double place) const;
  };

  std::vector<Piece>::const_iterator ahead() const {
    return pieces_.begin() + static_cast<std::ptrdiff_t>(next_);
  }
  void add_pieces(std::size_t part, const SpeedProfile& profile, double to);
  void add_piece(std::size_t part, double seconds, double to, double start, double end);
  std::vector<DrivenPiece> take(double t, double place);
  DrivenPiece driven(const Piece& piece) const;
  double fraction(std::size_t part, double place) const;

  std::size_t first_;
  Inertia inertia_;
  std::vector<LimitedPart> parts_;  // by action
  std::vector<double> begins_;      // by action, and the end of the last one
  double t_;
  double at_ = 0.0;
  double speed_;
  std::vector<Piece> pieces_;  // of the way that it heads for
  std::size_t next_ = 0;       // the first of them that is ahead
};

}  // namespace fleetplan::core
