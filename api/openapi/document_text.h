#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace fleetplan::api {

/// The text of a value in the layout of Prettier: two spaces of indent, lines of at most 110 characters,
/// values that fit on one line. `indent`: of the line on which it begins; `used`: characters on that line
/// before it.
std::string document_text(const nlohmann::ordered_json& value, std::size_t indent, std::size_t used);

}  // namespace fleetplan::api
