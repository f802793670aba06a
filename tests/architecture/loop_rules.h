#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// The functions of a source file in which a loop runs inside a loop, and which neither mention a stop
/// condition or the request's Work nor say in a comment `// Bounded: ...` what bounds them; a sentence each.
/// `code`: the same text with comments and literals blanked out.
std::vector<std::string> unbounded_loops(std::string_view path, std::string_view text, std::string_view code);

}  // namespace fleetplan::architecture
