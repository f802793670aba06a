#include "api/json/explain_json.h"

#include <algorithm>

#include "api/json/fault_text.h"

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

bool in_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '+' || c == '-' ||
         c == '.' || c == '_';
}

/// Where the string, word or sign begins that the byte at `offset` belongs to.
std::size_t token_start(std::string_view body, std::size_t offset) {
  std::size_t at = 0;
  // Bounded: each byte is passed once.
  while (at <= offset) {
    const std::size_t start = at++;
    if (body[start] == '"') {
      while (at < body.size() && body[at] != '"') at += body[at] == '\\' ? 2 : 1;
      ++at;
    } else if (in_word(body[start])) {
      while (at < body.size() && in_word(body[at])) ++at;
    }
    if (at > offset) return start;
  }
  return offset;
}

/// What is wrong where the parser stopped. `start` to `stop`: the bytes that could not be placed.
std::string reason(std::string_view body, std::size_t start, std::size_t stop) {
  const std::string_view rest = body.substr(start);
  const auto last = static_cast<unsigned char>(body[stop - 1]);
  const auto before = stop - start >= 2 ? static_cast<unsigned char>(body[stop - 2]) : 0U;
  if (starts_non_finite(rest)) return "NaN and infinities are not JSON; give a finite number";
  if (last >= 0x80 || (before >= 0x80 && last != '"' && last >= 0x20)) {
    return rest.starts_with('"') ? "this string is not valid UTF-8"
                                 : "a character that JSON allows in strings only, or invalid UTF-8";
  }
  if (last < 0x20 && rest.starts_with('"'))
    return "a raw control character in a string; escape it as \\u00XX";
  if (last < 0x20 && last != '\n' && last != '\r' && last != '\t') return "a control character";
  if (rest.starts_with('\'')) return "strings and keys need double quotes, not single quotes";
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

std::string explain_malformed(std::string_view body, std::size_t position) {
  // Past the last byte the parser counts the end of the input as one more.
  if (position == 0 || position > body.size()) {
    return "Not JSON: the text ends too early, at " + place(body, body.size()) + ".";
  }
  const std::size_t start = token_start(body, position - 1);
  return "Not JSON at " + place(body, start) + ": " + reason(body, start, position) + ".";
}

}  // namespace fleetplan::api
