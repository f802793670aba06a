#pragma once

// Small helpers for the ASCII text of HTTP.

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::server {

/// Returns the text without spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// Returns the text with ASCII letters in lower case, everything else as it is.
std::string lower_case(std::string_view text);

/// Returns the trimmed parts between separators; an empty text has none.
std::vector<std::string_view> split(std::string_view text, char separator);
std::vector<std::string_view> split(std::string&& text, char separator) = delete;

/// Returns the text in single quotes, for an error's detail: printable ASCII, others as '?', cut at 100
/// characters.
std::string in_quotes(std::string_view text);

}  // namespace fleetplan::server
