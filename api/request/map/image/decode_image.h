#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "api/json/json_reader.h"
#include "api/request/map/raster.h"

namespace fleetplan::api {

/// The members of an image that decode_image reads.
inline constexpr std::array<std::string_view, 6> kImageMembers{
    "pgm", "png", "mode", "negate", "occupied_thresh", "free_thresh"};

/// The occupancy that map_server of ROS publishes for an image: `pgm` or `png`, in base64, and the members of
/// its map.yaml that give shades a meaning (see ShadeRule). At most `most` pixels, which is checked before
/// they are decoded. Nothing when it has a fault, or when the reading of the document is stopped. Does not
/// look at other members.
std::optional<Raster> decode_image(const JsonReader& image, std::int64_t most);

}  // namespace fleetplan::api
