#pragma once

// Reads what vehicles report in state messages of VDA 5050 as states of robots: POST /v1/import/vda5050.

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/vda5050/export.h"
#include "api/vda5050/vehicle_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A readable body of POST /v1/import/vda5050.
struct VdaImport {
  VdaRequest request;  // as for POST /v1/export/vda5050
  VehicleReports reports;
};

inline constexpr auto kVdaImportMembers = [] {
  std::array<std::string_view, kVdaMembers.size() + 1> members{};
  std::copy(kVdaMembers.begin(), kVdaMembers.end(), members.begin());
  members.back() = "messages";
  return members;
}();

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<VdaImport> parse_vda5050_import(const JsonReader& root, const Limits& limits, core::Work& work);

/// Returns the answer: `states` and `poses` for POST /v1/advance, and `progress` for the next export. It also
/// tells what became of the orders, and what was wrong with the messages. Returns none if `work` is met.
std::optional<std::string> write_states(const VdaImport& import, core::Work& work);

}  // namespace fleetplan::api
