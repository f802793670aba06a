#pragma once

#include <string>

namespace fleetplan::api {

/// Returns the text of api/openapi.json. The parts that come from tables, `components.responses` and the
/// schema PlanOptions, are replaced by the tables' content. Everything else stays as it is. Throws
/// std::runtime_error if the document lacks a part.
std::string with_generated_parts(const std::string& document);

}  // namespace fleetplan::api
