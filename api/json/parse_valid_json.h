#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "api/json/json_value.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The values of a text that is JSON, read several times as fast as by the general parser, which megabytes of
/// numbers or a large image need. Nothing if it is not JSON, nests deeper than `max_depth`, has more than
/// `max_values` values or a number beyond the range of doubles or of 18 digits, or if the stop is met: then
/// the general parser has the answer, and says what is wrong.
std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& stop);

}  // namespace fleetplan::api
