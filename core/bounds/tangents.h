#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds/corner_sight.h"
#include "core/geometry/position.h"
#include "core/map/line_of_sight.h"

namespace fleetplan::core {

/// A way around a corner: of the circle of the disk's radius around it, the quarter that faces away from the
/// blocked cell, passed with the corner on the left or on the right. Places on it are told by the angle
/// passed, `bend`, which grows from -pi/4 to pi/4.
struct Bend {
  int corner = 0;
  bool left = false;  // the corner is on the left
};

/// A straight move that touches the circles of the corners that it links, or ends at a given point.
struct Tangent {
  Bend to;              // meaningless where the move ends at a point
  double leave = 0.0;   // the place on the bend that it starts from; 0 from a point
  double arrive = 0.0;  // the place on `to`; 0 at a point
  double length = 0.0;  // metres
  double heading = 0.0;
  Position begin{0.0, 0.0};
  Position end{0.0, 0.0};
};

/// The taut paths of a disk of one radius: a path that cannot be made shorter by pulling follows straight
/// moves and arcs of the disk's radius around convex corners. Left out are those through a gap of an even
/// number of cells that the disk just fits: it would have to move along a grid line there, where a robot that
/// starts, stops and turns on cell centres never is; and moves along an axis that only graze the beginning of
/// the quarter that they leave or the end of the one they arrive at, since nobody bends there: one longer
/// move does the same. Computed when first asked for; not
/// thread-safe. What is told of sight and arcs allows for kShrink, so that no taut path of a disk that is in
/// contact with obstacles is missed.
class Tangents {
 public:
  /// Metres by which the disk is smaller than the robot; a hundred times what plans may overlap obstacles, so
  /// that neither that nor rounding makes a path of the robot impossible for the disk.
  static constexpr double kShrink = 1e-7;

  /// `radius` > 2 kShrink is the robot's, metres.
  Tangents(CornerSight& corners, const LineOfSight& sight, double radius);

  double radius() const { return radius_; }
  int bend_count() const { return 2 * corners_.count(); }
  static int index(const Bend& bend) { return 2 * bend.corner + (bend.left ? 1 : 0); }

  // None of these is known to be free of obstacles: ask `is_free`.

  /// All from a bend to others, the last place to leave it from first; until this is called again.
  std::span<const Tangent> from(const Bend& bend);
  std::optional<Tangent> from_point(const Position& point, const Bend& to);
  std::optional<Tangent> to_point(const Bend& from, const Position& point);

  bool is_free(const Tangent& tangent);
  /// Of the k-th in `from(bend)`; remembered.
  bool is_free(const Bend& bend, std::size_t k);
  /// May the disk follow the arc? True too where obstacles reach less than a piece of 5.6 degrees into it.
  bool may_bend(const Bend& bend, double from, double to);

  /// The work done so far, a step taking 10 to 20 ns.
  std::int64_t work() const { return work_; }

 private:
  enum class Freedom : std::uint8_t { unknown, blocked, free };
  /// Of headings: the signs of their cosine and sine, and the one in the middle. All headings that a disk has
  /// on a bend are in one quadrant.
  struct Quadrant {
    double x;
    double y;
    double middle;  // radians
  };
  struct Side {  // an end of a tangent
    Position center;
    double offset;             // of the circle's centre to the left of the move, metres; 0: a point
    const Quadrant* quadrant;  // null: a point
  };
  struct Links {     // in tangents_
    int begin = -1;  // not yet computed
    int end = -1;
  };
  struct Arc {
    std::uint32_t blocked = 0;  // a bit for each piece, counter-clockwise
    bool known = false;
  };

  static const Quadrant& quadrant(const Corner& corner, bool left);
  Side side(const Bend& bend) const;
  static Side side(const Position& point) { return {point, 0.0, nullptr}; }
  static bool may_head(const Side& side, const Position& direction, double slack);
  static double place(const Side& side, double heading);
  std::optional<Tangent> tangent(const Side& from, const Side& to);
  Links link(const Bend& bend);
  bool squeezes_through(const Tangent& tangent) const;
  bool gap_at(int line, int cell, bool upright) const;
  const Arc& arc(int corner);

  CornerSight& corners_;
  const LineOfSight& sight_;
  double radius_;
  int tight_gap_;                  // cells, even; 0 for none
  std::vector<Links> from_;        // by bend
  std::vector<Tangent> tangents_;  // between bends
  std::vector<Freedom> freedom_;   // of tangents_
  std::vector<Arc> arcs_;          // by corner
  std::int64_t work_ = 0;
};

}  // namespace fleetplan::core
