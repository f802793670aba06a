#include "api/json/printable.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace fleetplan::api {

namespace {

constexpr char32_t kReplacement = 0xFFFD;
constexpr char32_t kFirstBeyondBmp = 0x10000;
constexpr char32_t kBeyondUnicode = 0x110000;

struct Character {
  char32_t code = kReplacement;
  std::size_t bytes = 1;
};

/// Returns the first character of a text; U+FFFD for its first byte if that begins none.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t index) { return static_cast<unsigned char>(text[index]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  char32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t index = 1; index < bytes; ++index) {
    if ((byte(index) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(index) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, kFirstBeyondBmp};  // by bytes
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kLeast[bytes] || code >= kBeyondUnicode || is_surrogate) return {};
  return {code, bytes};
}

/// Ranges of characters that are not shown as they are, ascending, ends included.
constexpr std::array<std::pair<char32_t, char32_t>, 11> kHidden{{
    {0x00, 0x1F},        // C0
    {0x7F, 0x9F},        // DEL, C1
    {0x61C, 0x61C},      // ARABIC LETTER MARK
    {0x200E, 0x200F},    // marks of direction
    {0x2028, 0x202E},    // separators of lines and paragraphs, embeddings and overrides
    {0x2066, 0x2069},    // isolates
    {0x206A, 0x206F},    // deprecated controls
    {0xFDD0, 0xFDEF},    // noncharacters
    {0xFEFF, 0xFEFF},    // byte order mark
    {0xFFF9, 0xFFFB},    // interlinear annotation
    {0xE0000, 0xE007F},  // tags
}};

bool is_hidden(char32_t code) {
  if ((code & 0xFFFEU) == 0xFFFEU) return true;  // the last two of each plane
  const auto range =
      std::find_if(kHidden.begin(), kHidden.end(), [code](const auto& one) { return code <= one.second; });
  return range != kHidden.end() && code >= range->first;
}

void append_escape(std::string& text, char32_t unit) {
  constexpr std::string_view kHex = "0123456789abcdef";
  text += "\\u";
  for (unsigned shift = 16; shift > 0; shift -= 4) text += kHex[unit >> (shift - 4) & 0xFU];
}

void append_escaped(std::string& text, char32_t code) {
  if (code < kFirstBeyondBmp) return append_escape(text, code);
  const char32_t rest = code - kFirstBeyondBmp;
  append_escape(text, 0xD800U + (rest >> 10U));
  append_escape(text, 0xDC00U + (rest & 0x3FFU));
}

}  // namespace

std::string printable(std::string_view text, Lines lines) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character first = first_of(text);
    const std::string_view bytes = text.substr(0, first.bytes);
    text.remove_prefix(first.bytes);
    const bool is_kept = lines == Lines::kept && (first.code == '\n' || first.code == '\t');
    if (is_hidden(first.code) && !is_kept) {
      append_escaped(shown, first.code);
    } else if (first.code == kReplacement) {
      shown += "\uFFFD";
    } else {
      shown += bytes;
    }
  }
  return shown;
}

}  // namespace fleetplan::api
