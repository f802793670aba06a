#pragma once

// Small helpers for the ASCII text of HTTP.

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::server {

/// Without spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// ASCII letters in lower case, everything else as it is.
std::string lower_case(std::string_view text);

/// The trimmed parts between separators; an empty text has none.
std::vector<std::string_view> split(std::string_view text, char separator);
std::vector<std::string_view> split(std::string&& text, char separator) = delete;

/// For an error's detail, in single quotes: printable ASCII, others as '?', cut at 100 characters.
std::string in_quotes(std::string_view text);

}  // namespace fleetplan::server
