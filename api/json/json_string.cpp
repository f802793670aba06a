#include "api/json/json_string.h"

#include <cstdint>
#include <cstring>

namespace fleetplan::api {

namespace {

constexpr std::uint64_t kOnes = 0x0101010101010101U;
constexpr std::uint64_t kHighs = 0x8080808080808080U;

/// Whether any of eight bytes is zero.
bool has_zero(std::uint64_t bytes) { return ((bytes - kOnes) & ~bytes & kHighs) != 0; }

/// Whether any of eight bytes is a quote, a backslash, a control character or not ASCII.
bool has_special(std::uint64_t bytes) {
  const bool not_ascii = (bytes & kHighs) != 0;
  const bool control = ((bytes - kOnes * 0x20U) & ~bytes & kHighs) != 0;
  return not_ascii || control || has_zero(bytes ^ kOnes * '"') || has_zero(bytes ^ kOnes * '\\');
}

std::uint32_t byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

/// The length of the character of UTF-8 at the offset, which is not ASCII; 0 if it is invalid.
std::size_t character_length(std::string_view text, std::size_t at) {
  const auto continues = [&](std::size_t offset) { return (byte_at(text, at + offset) & 0xC0U) == 0x80U; };
  const std::uint32_t first = byte_at(text, at);
  const std::uint32_t second = byte_at(text, at + 1);
  if (first >= 0xC2U && first <= 0xDFU) return continues(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {  // not overlong, no surrogates
    if ((first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second > 0x9FU)) return 0;
    return continues(1) && continues(2) ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {  // not overlong, up to U+10FFFF
    if ((first == 0xF0U && second < 0x90U) || (first == 0xF4U && second > 0x8FU)) return 0;
    return continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto rest = [&](std::uint32_t shift) { text += static_cast<char>(0x80U | (code >> shift & 0x3FU)); };
  if (code < 0x80U) {
    text += static_cast<char>(code);
  } else if (code < 0x800U) {
    text += static_cast<char>(0xC0U | code >> 6U);
    rest(0);
  } else if (code < 0x10000U) {
    text += static_cast<char>(0xE0U | code >> 12U);
    rest(6);
    rest(0);
  } else {
    text += static_cast<char>(0xF0U | code >> 18U);
    rest(12);
    rest(6);
    rest(0);
  }
}

/// The number of four hexadecimal digits.
std::optional<std::uint32_t> hexadecimal(std::string_view text, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t index = at; index < at + 4; ++index) {
    const std::uint32_t c = byte_at(text, index);
    const std::uint32_t lower = c | 0x20U;
    if (c >= '0' && c <= '9') {
      number = number * 16 + (c - '0');
    } else if (lower >= 'a' && lower <= 'f') {
      number = number * 16 + (lower - 'a' + 10);
    } else {
      return std::nullopt;
    }
  }
  return number;
}

/// Appends the character of an escape that begins with \u; its length, or 0.
std::size_t append_coded(std::string& text, std::string_view from, std::size_t at) {
  const auto code = hexadecimal(from, at + 2);
  if (!code || (*code >= 0xDC00U && *code <= 0xDFFFU)) return 0;
  if (*code < 0xD800U || *code > 0xDBFFU) {
    append_utf8(text, *code);
    return 6;
  }
  const bool is_pair = byte_at(from, at + 6) == '\\' && byte_at(from, at + 7) == 'u';
  const auto low = is_pair ? hexadecimal(from, at + 8) : std::nullopt;
  if (!low || *low < 0xDC00U || *low > 0xDFFFU) return 0;
  append_utf8(text, 0x10000U + ((*code - 0xD800U) << 10U) + (*low - 0xDC00U));
  return 12;
}

/// Appends the character of an escape; its length, or 0.
std::size_t append_escaped(std::string& text, std::string_view from, std::size_t at) {
  constexpr std::string_view kLetters = "\"\\/bfnrt";
  constexpr std::string_view kMeant = "\"\\/\b\f\n\r\t";
  if (at + 1 >= from.size()) return 0;
  if (from[at + 1] == 'u') return append_coded(text, from, at);
  const std::size_t letter = kLetters.find(from[at + 1]);
  if (letter == std::string_view::npos) return 0;
  text += kMeant[letter];
  return 2;
}

}  // namespace

std::size_t plain_length(std::string_view text) {
  std::size_t at = 0;
  // Bounded: each byte is passed once or, of eight with something special, twice.
  while (true) {
    for (std::uint64_t bytes = 0; at + sizeof(bytes) <= text.size(); at += sizeof(bytes)) {
      std::memcpy(&bytes, text.data() + at, sizeof(bytes));
      if (has_special(bytes)) break;
    }
    // The eight bytes with something special, or the last ones.
    while (true) {
      const std::uint32_t byte = byte_at(text, at);
      if (byte >= 0x80U) {
        const std::size_t length = character_length(text, at);
        if (length == 0) return at;
        at += length;
        break;
      }
      if (at == text.size() || byte < 0x20U || byte == '"' || byte == '\\') return at;
      ++at;
    }
  }
}

std::optional<DecodedString> decode_string(std::string_view text) {
  DecodedString decoded;
  std::size_t at = 0;
  while (true) {
    const std::size_t plain = plain_length(text.substr(at));
    decoded.text.append(text.substr(at, plain));
    at += plain;
    if (at == text.size()) return std::nullopt;
    if (text[at] == '"') break;
    const std::size_t length = text[at] == '\\' ? append_escaped(decoded.text, text, at) : 0;
    if (length == 0) return std::nullopt;
    at += length;
  }
  decoded.length = at;
  return decoded;
}

}  // namespace fleetplan::api
