#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// The violations of the layering server -> api -> core, of the rules for folders of core, of the rules for
/// headers, and of the rules for loops and stop conditions in one source file; a sentence each. `path`,
/// relative to the project root, decides which rules apply.
std::vector<std::string> violations(std::string_view path, std::string_view text);

/// The pairs of folders of core, api and server whose files include each other, as "api/json and
/// api/request" or "api/request/fleet and api/request/map": the folders of a layer, and at any depth folders
/// that are next to each other. A file that lies loose in a layer belongs to the folder of the layer.
/// `sources`: texts by path.
std::vector<std::string> mutual_includes(const std::map<std::string, std::string>& sources);

}  // namespace fleetplan::architecture
