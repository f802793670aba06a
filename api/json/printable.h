#pragma once

#include <string>
#include <string_view>

namespace fleetplan::api {

/// What is done to the ends of lines (and tabs) of a text.
enum class Lines { joined, kept };

/// Returns the text as it may be shown by a terminal and in XML 1.0, as valid UTF-8. Control characters (C0,
/// DEL, C1), separators of lines, characters that change the direction of text, tags and noncharacters are
/// written as in strings of JSON (`\u001b`), so JSON text with its lines kept stays JSON of the same meaning.
/// Bytes that are not UTF-8 become U+FFFD.
std::string printable(std::string_view text, Lines lines = Lines::joined);

}  // namespace fleetplan::api
