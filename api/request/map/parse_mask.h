#pragma once

// Masks of zones: images that are read in the same way as by the filters of Nav2.

#include <cstddef>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/shared_members.h"
#include "core/geometry/position.h"

namespace fleetplan::api {

/// Cells of a mask with the same value, as a rectangle in the map frame.
struct MaskPart {
  double speed_share = 1.0;  // of masks of speeds: share of the robot's own speed
  std::vector<core::Position> polygon;
};

/// Masks of a request that may mean something else than what is read: how many, and the first of them. There
/// may be as many as zones, so each kind has only one warning.
class MaskNotes {
 public:
  void add_changed_pixels(const std::string& zone, std::size_t pixels);
  void add_changed_speeds(const std::string& zone);
  void add_without_limit(const std::string& zone, int percent, double limit);

  void tell(std::vector<std::string>& warnings) const;

 private:
  struct Kind {
    std::size_t masks = 0;
    std::string first;  // a warning

    void add(std::string warning);
  };

  Kind pixels_;
  Kind speeds_;
  Kind without_limit_;
};

enum class MaskKind { blocked, speed };

/// Reads `mask`: an image in its own frame, or a pixel for each cell of the map. The parts of a blocked mask
/// are the cells that are occupied by the thresholds of map_server. The parts of a mask of speeds are the
/// cells of 1 to 100 %, which limit the speed.
///
/// Parts overlap by far less than a cell, so that there are no gaps between them. Parts off the map are left
/// out. Returns none if the mask has a fault. All parts of a request take their corners from the quota.
/// `zone` names the zone in `notes`.
std::vector<MaskPart> parse_mask(const JsonReader& member, const WorldMap& map, MaskKind kind,
                                 const Limits& limits, Quota& corners, const std::string& zone,
                                 MaskNotes& notes);

}  // namespace fleetplan::api
