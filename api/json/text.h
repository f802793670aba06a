#pragma once

// Words for details: what a client reads when something is wrong.

#include <span>
#include <string>
#include <string_view>

#include "api/json/json_value.h"

namespace fleetplan::api {

/// The text in double quotes, cut to a length that one can read (at a character of UTF-8).
std::string in_quotes(std::string_view text);

/// The shortest decimal text that reads back as the same double.
std::string number_text(double number);

/// What a value is, for people: `the string "abc"`, `-1`, `an array`.
std::string described(const JsonValue& value);

/// `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> words);

/// `; did you mean "radius"?` when one of the words is close enough to the text to be meant, or nothing.
std::string suggestion(std::string_view text, std::span<const std::string_view> words);

}  // namespace fleetplan::api
