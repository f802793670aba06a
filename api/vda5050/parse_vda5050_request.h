#pragma once

// Orders of VDA 5050: what a robot may do now (the base), and what comes later (the horizon).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/vda5050/route.h"
#include "core/execution/dependency.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

enum class VdaVersion : std::uint8_t { v2_1, v3_0 };

/// The members that all orders of an answer have.
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

/// How far a robot is, and the order that it has.
struct OrderProgress {
  core::ActionPlace at;
  std::optional<std::string> order_id;  // none: it has no order yet
  std::uint64_t update_id = 0;          // update of the last message
  std::uint64_t last_released = 0;      // the sequence id of the last node of the base
};

/// A readable body of POST /v1/export/vda5050, in the client's world.
struct VdaRequest {
  OrderHeader header;
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<core::Dependency> dependencies;
  std::vector<Route> routes;                // by robot
  std::vector<OrderProgress> progress;      // by robot
  std::vector<std::string> serial_numbers;  // by robot
};

inline constexpr std::array<std::string_view, 13> kVdaMembers{
    "version",  "map",          "map_id",         "robots",    "robot_defaults", "plans",   "dependencies",
    "progress", "manufacturer", "serial_numbers", "timestamp", "options",        "metadata"};

/// Reads the root of the document. Returns none if it has faults, or if its stop is met.
std::optional<VdaRequest> parse_vda5050_request(const JsonReader& root, const Limits& limits,
                                                core::Work& stop);

}  // namespace fleetplan::api
