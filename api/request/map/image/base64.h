#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/result.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

using Bytes = std::vector<std::uint8_t>;

/// The bytes of a base64 text of RFC 4648, section 4: padded, without line breaks. The failure says what is
/// wrong, after "it ". When the stop is met, what was decoded so far.
Result<Bytes, std::string> decode_base64(std::string_view text, core::Work& stop);

}  // namespace fleetplan::api
