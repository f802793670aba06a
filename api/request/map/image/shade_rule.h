#pragma once

// How map_server of ROS makes occupancy of the pixels of a map's image (nav2_map_server/src/map_io.cpp).

#include <cstdint>
#include <span>
#include <vector>

#include "api/request/map/image/image_reader.h"
#include "api/request/map/raster.h"

namespace fleetplan::api {

inline constexpr std::int8_t kFullOccupancy = 100;

enum class ShadeMode { trinary, scale, raw };

/// The members of a map.yaml that say what a shade means.
struct ShadeRule {
  ShadeMode mode = ShadeMode::trinary;
  bool negate = false;            // white is occupied
  double occupied_thresh = 0.65;  // occupied above; 0 to 1
  double free_thresh = 0.196;     // free below; at most occupied_thresh
};

/// The occupancy of pixels of one image: 0 to 100 percent, or kUnknownOccupancy.
class OccupancyOfPixels {
 public:
  OccupancyOfPixels(const ShadeRule& rule, const ImageHeader& image);

  /// `channels`: of one pixel.
  std::int8_t of(std::span<const std::uint16_t> channels) const {
    return known_.empty() ? computed(channels) : known_[channels[0]];
  }

 private:
  std::int8_t computed(std::span<const std::uint16_t> channels) const;

  ShadeRule rule_;
  double largest_;
  bool has_alpha_;
  std::vector<std::int8_t> known_;  // of each gray, if that saves time
};

}  // namespace fleetplan::api
