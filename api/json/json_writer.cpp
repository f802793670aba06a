#include "api/json/json_writer.h"

#include <array>
#include <charconv>
#include <cmath>

#include "api/json/json_reader.h"

namespace fleetplan::api {

namespace {

/// Returns the number of invalid bytes at the begin of a text that is not valid UTF-8, at least one. They end
/// before the first byte that cannot continue the character.
std::size_t invalid_bytes(std::string_view text) {
  const auto byte = [&](std::size_t index) { return static_cast<unsigned char>(text[index]); };
  const unsigned lead = byte(0);
  if (lead < 0xC2 || lead > 0xF4) return 1;
  const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  // The second byte excludes overlong forms, surrogates and what is beyond U+10FFFF.
  unsigned lowest = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  unsigned highest = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  std::size_t bytes = 1;
  while (bytes < length && bytes < text.size() && byte(bytes) >= lowest && byte(bytes) <= highest) {
    lowest = 0x80;
    highest = 0xBF;
    ++bytes;
  }
  return bytes;
}

}  // namespace

JsonWriter& JsonWriter::begin_object() {
  separate();
  text_ += '{';
  return *this;
}

JsonWriter& JsonWriter::end_object() {
  text_ += '}';
  return *this;
}

JsonWriter& JsonWriter::begin_array() {
  separate();
  text_ += '[';
  return *this;
}

JsonWriter& JsonWriter::end_array() {
  text_ += ']';
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  append_string(name);
  text_ += ':';
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) return raw("null");
  std::array<char, 32> buffer{};
  // -0.0 + 0.0 is 0.0
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size() - 2, number + 0.0).ptr;
  const std::string_view digits(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  raw(digits);
  // A real number stays one for clients that distinguish 5 from 5.0.
  if (digits.find_first_of(".e") == std::string_view::npos) text_ += ".0";
  return *this;
}

JsonWriter& JsonWriter::value(const std::optional<double>& number) {
  return number ? value(*number) : raw("null");
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  append_string(text);
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

void JsonWriter::separate() {
  if (text_.empty()) return;
  const char last = text_.back();
  if (last != '{' && last != '[' && last != ':') text_ += ',';
}

void JsonWriter::append_string(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  constexpr std::string_view kReplacement = "\uFFFD";
  text_ += '"';
  for (std::size_t index = 0; index < text.size(); ++index) {
    const std::size_t plain = plain_length(text.substr(index));
    text_.append(text.substr(index, plain));
    index += plain;
    if (index == text.size()) break;
    const char character = text[index];
    const auto byte = static_cast<unsigned char>(character);
    if (character == '"' || character == '\\') {
      text_ += '\\';
      text_ += character;
    } else if (character == '\n') {
      text_ += "\\n";
    } else if (character == '\t') {
      text_ += "\\t";
    } else if (byte < 0x20) {
      text_ += "\\u00";
      text_ += kHex[byte >> 4U];
      text_ += kHex[byte & 0x0FU];
    } else {
      text_ += kReplacement;
      index += invalid_bytes(text.substr(index)) - 1;
    }
  }
  text_ += '"';
}

// The recursion ends, because the depth of a document is limited when it is read.
namespace {

enum class Nulls : std::uint8_t { kept, left_out };

void copy(JsonWriter& json, const JsonValue& value, Nulls nulls) {  // NOLINT(misc-no-recursion)
  const auto is_left_out = [&](const JsonValue& child) {
    return nulls == Nulls::left_out && child.is_null();
  };
  if (value.is_object()) {
    json.begin_object();
    for (const JsonValue member : value.children()) {
      if (is_left_out(member)) continue;
      json.key(member.key());
      copy(json, member, nulls);
    }
    json.end_object();
  } else if (value.is_array()) {
    json.begin_array();
    for (const JsonValue item : value.children()) {
      if (!is_left_out(item)) copy(json, item, nulls);
    }
    json.end_array();
  } else if (const auto text = value.string()) {
    json.value(*text);
  } else if (const auto natural = value.natural()) {
    json.value(*natural);
  } else if (const auto integer = value.integer()) {
    json.value(*integer);
  } else if (const auto boolean = value.boolean()) {
    json.value(*boolean);
  } else {
    json.value(value.number());  // null for none
  }
}

}  // namespace

void copy_json(JsonWriter& json, const JsonValue& value) { copy(json, value, Nulls::kept); }

void copy_without_null(JsonWriter& json, const JsonValue& value) { copy(json, value, Nulls::left_out); }

}  // namespace fleetplan::api
