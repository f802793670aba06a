#pragma once

// The characters of strings of JSON, RFC 8259, section 7.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::api {

/// How many bytes from the begin are characters of a string as they are: valid UTF-8 without quotes,
/// backslashes and control characters.
std::size_t plain_length(std::string_view text);

/// A string with its escapes resolved, and its length in the text.
struct DecodedString {
  std::string text;
  std::size_t length = 0;
};

/// The string at the begin of a text, as far as its quote. Nothing if it is not valid.
std::optional<DecodedString> decode_string(std::string_view text);

}  // namespace fleetplan::api
