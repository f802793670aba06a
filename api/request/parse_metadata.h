#pragma once

#include <cstddef>
#include <string>

#include "api/json/json_reader.h"

namespace fleetplan::api {

/// Of one object, written without spaces.
inline constexpr std::size_t kMostMetadataBytes = 16'384;

/// Reads `metadata` of a request, a robot or a goal: an object that the answer repeats and that means nothing
/// here. Returns it as JSON text, or an empty text if it is absent or at fault.
std::string parse_metadata(const JsonReader& owner);

}  // namespace fleetplan::api
