#pragma once

// Reading messages of VDA 5050, which may have more members than are known here.

#include <cstdint>

#include "api/json/faults.h"
#include "api/json/json_reader.h"

namespace fleetplan::api {

/// Ids of updates and sequences are unsigned numbers of 32 bits, and there is one after each.
inline constexpr std::uint64_t kGreatestId = 4'294'967'294;

/// The value itself if it is an object, whatever members it has; otherwise absent.
inline JsonReader message(const JsonReader& value) {
  if (!value || value.value().is_object()) return value;
  value.must_be(fault::kWrongType, "an object");
  return {};
}

}  // namespace fleetplan::api
