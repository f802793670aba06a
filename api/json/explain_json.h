#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fleetplan::api {

/// Where and why a body is not JSON: line, column and byte (each from 1; columns in bytes) and the text
/// there. `position`: how many bytes had been read when the parser stopped.
std::string explain_malformed(std::string_view body, std::size_t position);

}  // namespace fleetplan::api
