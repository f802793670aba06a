#pragma once

// Small helpers for the ASCII text of HTTP.

#include <string>
#include <string_view>
#include <vector>

namespace fleetplan::server {

/// Returns the text without spaces and tabs at both ends.
inline std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Returns the text with ASCII letters in lower case. Other characters stay as they are.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// Returns the trimmed parts between separators; an empty text has none.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const auto end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return parts;
}
std::vector<std::string_view> split(std::string&& text, char separator) = delete;

/// Returns the text in single quotes, for an error's detail. Characters that are not printable ASCII become
/// '?'. The text is cut at 100 characters.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxLength = 100;
  std::string result = "'";
  for (const char c : text.substr(0, kMaxLength)) result += (c >= 0x20 && c < 0x7f) ? c : '?';
  if (text.size() > kMaxLength) result += "...";
  result += '\'';
  return result;
}

}  // namespace fleetplan::server
