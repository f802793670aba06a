#include "api/openapi/generated_parts.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/openapi/document_text.h"
#include "api/openapi/error_responses.h"
#include "api/openapi/options_schema.h"

namespace fleetplan::api {

namespace {

/// Replaces the member that stands on lines of its own at this indent: up to the brace at the same indent.
std::string with_member(const std::string& document, const std::string& key, std::size_t indent,
                        const nlohmann::ordered_json& value) {
  const std::string margin = '\n' + std::string(indent, ' ');
  const std::string name = margin + '"' + key + "\": ";
  const std::size_t begin = document.find(name + "{\n");
  const std::size_t end = begin == std::string::npos ? begin : document.find(margin + '}', begin);
  if (end == std::string::npos) throw std::runtime_error("The document has no " + key + " at its place.");
  const std::string text = document_text(value, indent, name.size());
  return document.substr(0, begin) + name + text + document.substr(end + margin.size() + 1);
}

}  // namespace

std::string with_generated_parts(const std::string& document) {
  const std::string with_responses = with_member(document, "responses", 4, error_responses());
  return with_member(with_responses, "PlanOptions", 6, options_schema());
}

}  // namespace fleetplan::api
