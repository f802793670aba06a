#pragma once

// Orders of VDA 5050: what a robot may do now (the base), and what comes later (the horizon).

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "api/vda5050/route.h"

namespace fleetplan::api {

enum class VdaVersion : std::uint8_t { v2_1, v3_0 };

/// What all orders of an answer have.
struct OrderHeader {
  VdaVersion version = VdaVersion::v2_1;
  std::string manufacturer;
  std::string timestamp;  // ISO 8601
  std::string map_id;
};

/// An order, or an update of one, of a robot's route from a node on.
struct Order {
  std::string robot;
  std::string serial_number;
  std::string order_id;
  std::uint64_t update_id = 0;
  std::size_t first = 0;     // index of its first node
  std::size_t released = 1;  // the number of nodes of the whole route that are released, > first
};

}  // namespace fleetplan::api
