#pragma once

#include <string>
#include <string_view>

namespace fleetplan::api {

/// What happens to the ends of lines (and tabs) of a text.
enum class Lines { joined, kept };

/// Returns the text in a form that is safe to show in a terminal and in XML 1.0, as valid UTF-8. Bytes that
/// are not UTF-8 become U+FFFD.
///
/// These are written as in JSON strings (`\u001b`): control characters (C0, DEL, C1), line separators,
/// characters that change the direction of text, tags and noncharacters. So JSON text with its lines kept
/// stays JSON of the same meaning.
std::string printable(std::string_view text, Lines lines = Lines::joined);

}  // namespace fleetplan::api
