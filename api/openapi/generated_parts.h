#pragma once

#include <string>

namespace fleetplan::api {

/// Returns the text of api/openapi.json with the parts that come from tables, `components.responses` and the
/// schema PlanOptions, as the tables give them. Everything else stays as it is. Throws std::runtime_error
/// where the document lacks a part.
std::string with_generated_parts(const std::string& document);

}  // namespace fleetplan::api
