#include "api/request/map/image/base64.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "api/json/faults.h"

namespace fleetplan::api {

namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kInvalid = 0x80;  // more than 6 bits

constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> values{};
  for (auto& value : values) value = kInvalid;
  for (std::size_t index = 0; index < kAlphabet.size(); ++index) {
    values[static_cast<unsigned char>(kAlphabet[index])] = static_cast<std::uint8_t>(index);
  }
  return values;
}
constexpr std::array<std::uint8_t, 256> kValues = make_values();

std::uint32_t value_of(char letter) { return kValues[static_cast<unsigned char>(letter)]; }

std::string letter_fault(std::string_view text, std::size_t from) {
  const auto bad = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(),
                                [](char letter) { return value_of(letter) == kInvalid; });
  const std::size_t at = static_cast<std::size_t>(bad - text.begin());
  const std::string place = " at character " + std::to_string(at + 1);
  if (*bad == '\n' || *bad == '\r' || *bad == ' ') {
    return "has white space" + place + "; write base64 on one line, as base64 -w 0 does";
  }
  if (*bad == '=') return "has padding" + place + ", before its end";
  if (*bad == '-' || *bad == '_') return "is base64url" + place + "; write + for - and / for _";
  const bool is_visible = *bad > ' ' && *bad < 0x7f;
  return "has " + (is_visible ? in_quotes({&*bad, 1}) : "a character") + place + ", which is not of base64";
}

}  // namespace

Result<Bytes, std::string> decode_base64(std::string_view text, core::Work& stop) {
  if (text.starts_with("data:")) {
    constexpr std::size_t kLongestPrefix = 64;
    const std::string_view prefix = text.substr(0, text.substr(0, kLongestPrefix).find(',') + 1);
    return "is a data URL; leave out its prefix" + (prefix.empty() ? "" : ' ' + in_quotes(prefix)) +
           " and give the base64 alone";
  }
  if (text.size() % 4 != 0) {
    return "has " + std::to_string(text.size()) +
           " characters of base64, not a multiple of 4; is it cut off?";
  }
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  const std::size_t letters = text.size() - padding;
  const std::size_t whole = letters / 4 * 4;
  Bytes bytes(letters / 4 * 3 + (padding == 0 ? 0 : 3 - padding));
  std::uint8_t* target = bytes.data();
  for (std::size_t begin = 0; begin < whole; begin += core::Work::kStride) {
    const std::size_t end = std::min(whole, begin + core::Work::kStride);
    std::uint32_t seen = 0;
    for (std::size_t at = begin; at < end; at += 4) {
      const std::uint32_t a = value_of(text[at]);
      const std::uint32_t b = value_of(text[at + 1]);
      const std::uint32_t c = value_of(text[at + 2]);
      const std::uint32_t d = value_of(text[at + 3]);
      seen |= a | b | c | d;
      *target++ = static_cast<std::uint8_t>(a << 2U | b >> 4U);
      *target++ = static_cast<std::uint8_t>(b << 4U | c >> 2U);
      *target++ = static_cast<std::uint8_t>(c << 6U | d);
    }
    if ((seen & kInvalid) != 0) return letter_fault(text.substr(0, letters), begin);
    if (stop.met_after(end - begin)) return bytes;
  }
  if (padding == 0) return bytes;
  const std::uint32_t a = value_of(text[whole]);
  const std::uint32_t b = value_of(text[whole + 1]);
  const std::uint32_t c = padding == 1 ? value_of(text[whole + 2]) : 0;
  if (((a | b | c) & kInvalid) != 0) return letter_fault(text.substr(0, letters), whole);
  *target++ = static_cast<std::uint8_t>(a << 2U | b >> 4U);
  if (padding == 1) *target = static_cast<std::uint8_t>(b << 4U | c >> 2U);
  const std::uint32_t left = padding == 1 ? c & 3U : b & 15U;
  if (left != 0) return std::string("has bits after its last byte; is it cut off?");
  return bytes;
}

}  // namespace fleetplan::api
