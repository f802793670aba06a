#pragma once

// Phrases for the details of faults.

#include <span>
#include <string>
#include <string_view>

#include "api/json/json_value.h"

namespace fleetplan::api {

/// The text in double quotes, cut to a readable length (at a character of UTF-8).
std::string in_quotes(std::string_view text);

/// The shortest decimal text that reads back as the same double.
std::string number_text(double number);

/// A value in words: `the string "abc"`, `-1`, `an array`.
std::string described(const JsonValue& value);

/// `"a", "b", "c"`.
std::string listed(std::span<const std::string_view> words);

/// `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> words);

/// `; did you mean "radius"?` when one of the words is close enough to the text, or nothing.
std::string suggestion(std::string_view text, std::span<const std::string_view> words);

}  // namespace fleetplan::api
