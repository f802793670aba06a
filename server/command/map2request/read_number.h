#pragma once

#include <optional>
#include <string_view>

namespace fleetplan::server {

/// A finite number with a point, such as "-1.5e3" or "+2"; nothing if the text is anything else.
std::optional<double> read_number(std::string_view text);

}  // namespace fleetplan::server
