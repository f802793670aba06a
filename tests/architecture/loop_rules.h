#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::architecture {

/// The functions of a source file that break the rule for loops; a sentence each. In such a function, a loop
/// runs inside a loop. The function neither mentions a stop condition or the request's Work, nor says in a
/// comment `// Bounded: ...` what bounds the loops. `code`: the same text with comments and literals blanked
/// out.
std::vector<std::string> unbounded_loops(std::string_view path, std::string_view text, std::string_view code);

}  // namespace fleetplan::architecture
