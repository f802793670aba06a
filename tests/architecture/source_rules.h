#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// What a source file does that the layering server -> api -> core, or the hygiene of headers, does not
/// allow; one sentence each. `path` is relative to the project root and decides which rules apply.
std::vector<std::string> violations(std::string_view path, std::string_view text);

}  // namespace fleetplan::architecture
