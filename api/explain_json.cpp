#include "api/explain_json.h"

#include <algorithm>

#include "api/text.h"

namespace fleetplan::api {

namespace {

std::string place(std::string_view body, std::size_t offset) {
  const std::string_view before = body.substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? offset + 1 : offset - newline;
  return "line " + std::to_string(line) + ", column " + std::to_string(column) + " (byte " +
         std::to_string(offset + 1) + ")";
}

bool is_ascii_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

bool starts_non_finite(std::string_view rest) {
  if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
  return rest.starts_with("NaN") || rest.starts_with("nan") || rest.starts_with("Inf") ||
         rest.starts_with("inf");
}

/// What is wrong where the parser stopped. `start` to `stop`: the bytes that could not be placed.
std::string reason(std::string_view body, std::size_t start, std::size_t stop) {
  const std::string_view rest = body.substr(start);
  const auto last = static_cast<unsigned char>(body[stop - 1]);
  if (starts_non_finite(rest)) return "NaN and infinities are not JSON; give a finite number";
  if (last >= 0x80) {
    return rest.starts_with('"') ? "this string is not valid UTF-8"
                                 : "a character that JSON allows in strings only, or invalid UTF-8";
  }
  if (last < 0x20 && rest.starts_with('"'))
    return "a raw control character in a string; escape it as \\u00XX";
  if (last < 0x20 && last != '\n' && last != '\r' && last != '\t') return "a control character";
  if (rest.starts_with('\'')) return "strings and keys want double quotes, not single ones";
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#')) {
    return "JSON has no comments";
  }
  const std::string_view token = body.substr(start, stop - start);
  if (token.starts_with('"') && token.find('\\') != std::string_view::npos && !token.ends_with('"')) {
    return "a bad escape in a string";
  }
  return is_ascii_printable(token) ? "unexpected " + in_quotes(token) : "unexpected text";
}

}  // namespace

std::string explain_malformed(std::string_view body, std::size_t position, std::string_view token) {
  const std::size_t stop = std::min(position, body.size());
  // Past the last byte the parser counts the end of the input as one more.
  if (stop == 0 || (position > body.size() && !starts_non_finite(token))) {
    return "Not JSON: the text ends too early, at " + place(body, body.size()) + ".";
  }
  std::size_t start = stop - 1;
  if (token.size() <= stop && !token.empty() && body.substr(stop - token.size(), token.size()) == token) {
    start = stop - token.size();
  } else if (const std::size_t quote =
                 token.starts_with('"') ? body.rfind('"', start) : std::string_view::npos;
             quote != std::string_view::npos) {
    start = quote;
  }
  return "Not JSON at " + place(body, start) + ": " + reason(body, start, stop) + ".";
}

}  // namespace fleetplan::api
