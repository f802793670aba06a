#include "api/openapi/document_text.h"

#include <algorithm>

namespace fleetplan::api {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineLength = 110;

std::string key_text(const std::string& key) { return Json(key).dump() + ": "; }

/// Prettier writes exponents without a plus sign.
std::string number_text(const Json& number) {
  std::string text = number.dump();
  std::erase(text, '+');
  return text;
}

std::string on_one_line(const Json& value) {
  if (value.is_number()) return number_text(value);
  if (!value.is_structured() || value.empty()) return value.dump();
  std::string text;
  for (const auto& [key, member] : value.items()) {
    text += (text.empty() ? "" : ", ") + (value.is_object() ? key_text(key) : "") + on_one_line(member);
  }
  return value.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

/// Prettier gives every item its line where several items have several members each.
bool needs_lines(const Json& value) {
  if (!value.is_structured()) return false;
  const auto has_several = [](const Json& item) { return item.is_structured() && item.size() > 1; };
  const bool list = value.is_array() && value.size() > 1;
  return (list && std::all_of(value.begin(), value.end(), has_several)) ||
         std::any_of(value.begin(), value.end(), needs_lines);
}

}  // namespace

std::string document_text(const Json& value, std::size_t indent, std::size_t used) {
  std::string line = on_one_line(value);
  const bool fits = used + line.size() <= kLineLength && !needs_lines(value);
  if (!value.is_structured() || value.empty() || fits) return line;
  const std::size_t inner = indent + 2;
  std::string text;
  for (const auto& [key, member] : value.items()) {
    const std::string name = value.is_object() ? key_text(key) : "";
    const std::size_t before_and_comma = inner + name.size() + 1;
    text += (text.empty() ? "\n" : ",\n") + std::string(inner, ' ') + name +
            document_text(member, inner, before_and_comma);
  }
  text += '\n' + std::string(indent, ' ');
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace fleetplan::api
