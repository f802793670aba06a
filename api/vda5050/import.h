#pragma once

// What vehicles report in state messages of VDA 5050, as states of robots: POST /v1/import/vda5050.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/vda5050/export.h"
#include "core/geometry/segment.h"
#include "core/runtime/stop_condition.h"

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

/// A readable body of POST /v1/import/vda5050.
struct VdaImport {
  VdaRequest request;                               // as for POST /v1/export/vda5050
  std::vector<std::optional<VehicleState>> states;  // by robot
};

inline constexpr auto kVdaImportMembers = [] {
  std::array<std::string_view, kVdaMembers.size() + 1> members{};
  std::copy(kVdaMembers.begin(), kVdaMembers.end(), members.begin());
  members.back() = "messages";
  return members;
}();

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<VdaImport> parse_vda5050_import(const JsonReader& root, const Limits& limits, core::Work& work);

/// Returns the answer: `states` and `poses` for POST /v1/advance, `progress` for the next export, and what
/// became of the orders. Returns none if `work` is met.
std::optional<std::string> write_states(const VdaImport& import, core::Work& work);

}  // namespace fleetplan::api
