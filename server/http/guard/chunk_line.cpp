#include "server/http/guard/chunk_line.h"

#include <algorithm>
#include <charconv>

#include "server/http/guard/field_syntax.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kMaxSizeDigits = 16;

void skip_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

bool skip(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

bool skip_token(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_token_char);
  const auto size = static_cast<std::size_t>(end - text.begin());
  text.remove_prefix(size);
  return size > 0;
}

/// After the opening quote, with the closing one.
bool skip_quoted(std::string_view& text) {
  while (!text.empty()) {
    const char c = text.front();
    text.remove_prefix(1);
    if (c == '"') return true;
    if (c == '\\') {
      if (text.empty() || !is_field_value_char(text.front())) return false;
      text.remove_prefix(1);
    } else if (!is_field_value_char(c)) {
      return false;
    }
  }
  return false;
}

bool skip_extension(std::string_view& text) {
  skip_blanks(text);
  if (!skip(text, ';')) return false;
  skip_blanks(text);
  if (!skip_token(text)) return false;
  auto value = text;
  skip_blanks(value);
  if (!skip(value, '=')) return true;
  skip_blanks(value);
  const bool valid = skip(value, '"') ? skip_quoted(value) : skip_token(value);
  text = value;
  return valid;
}

}  // namespace

std::optional<ChunkLine> parse_chunk_line(std::string_view line) {
  ChunkLine chunk{};
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), chunk.size, 16);
  const auto digits = static_cast<std::size_t>(end - line.data());
  if (error != std::errc{} || digits > kMaxSizeDigits) return std::nullopt;
  line.remove_prefix(digits);
  chunk.extension_bytes = line.size();
  while (!line.empty()) {
    if (!skip_extension(line)) return std::nullopt;
  }
  return chunk;
}

}  // namespace fleetplan::server
