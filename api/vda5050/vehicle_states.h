#pragma once

// What vehicles report in state messages of VDA 5050.

#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "api/json/json_reader.h"
#include "api/vda5050/parse_vda5050_request.h"
#include "core/geometry/segment.h"

namespace fleetplan::api {

/// A state message of a vehicle, as far as it matters here. Texts are those of the body.
struct VehicleState {
  std::string_view order_id;  // empty: it has had no order
  std::uint64_t update_id = 0;
  std::optional<std::uint64_t> next_sequence_id = {};  // of the first node that it still has to reach
  std::uint64_t last_sequence_id = 0;                  // of the last node that it has reached
  std::optional<core::Pose> pose;                      // none: it does not know where it is
  std::unordered_set<std::string_view> ended_actions;  // ids of actions that are finished or have failed
  bool has_failed = false;  // it cannot go on, or has refused the last message of its order
};

/// Reads `messages`, at most one of each vehicle. Returns them by robot.
std::vector<std::optional<VehicleState>> parse_states(const JsonReader& member, const VdaRequest& request);

}  // namespace fleetplan::api
