#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// The violations of the layering server -> api -> core, of the rules for folders of core, of the rules for
/// headers, and of the rules for loops and stop conditions in one source file; a sentence each. `path`,
/// relative to the project root, decides which rules apply.
std::vector<std::string> violations(std::string_view path, std::string_view text);

}  // namespace fleetplan::architecture
