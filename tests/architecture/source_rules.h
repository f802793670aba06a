#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// The violations of rules in one source file; a sentence each. The rules are about
///
/// - the layering server -> api -> core,
/// - folders of core,
/// - headers,
/// - loops and stop conditions.
///
/// `path`, relative to the project root, decides which rules apply.
std::vector<std::string> violations(std::string_view path, std::string_view text);

/// The pairs of folders of core, api and server whose files include each other, as "api/json and api/request"
/// or "api/request/fleet and api/request/map". They are the folders of a layer, and at any depth folders that
/// are next to each other. A file that lies loose in a layer belongs to the folder of the layer. `sources`:
/// texts by path.
std::vector<std::string> mutual_includes(const std::map<std::string, std::string>& sources);

}  // namespace fleetplan::architecture
