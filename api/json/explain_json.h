#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fleetplan::api {

/// Says where and why a body is not JSON: line, column and byte (each from 1; columns in bytes) and what is
/// there. `position`: how many bytes had been read when the mistake was seen.
std::string explain_malformed(std::string_view body, std::size_t position);

}  // namespace fleetplan::api
