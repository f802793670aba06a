#include "api/json/location.h"

#include <algorithm>
#include <vector>

namespace fleetplan::api {

namespace {

/// The index of the last of these values that begins at or before the place.
std::size_t index_at(const std::vector<JsonValue>& values, std::uint32_t place) {
  const auto after =
      std::upper_bound(values.begin(), values.end(), place,
                       [](std::uint32_t wanted, const JsonValue& value) { return wanted < value.begins(); });
  return static_cast<std::size_t>(after - values.begin()) - 1;
}

}  // namespace

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char character : key) {
    if (character == '~') {
      step += "~0";
    } else if (character == '/') {
      step += "~1";
    } else {
      step += character;
    }
  }
  return step;
}

Location locate(const JsonValue& root, const JsonValue& value) {
  Location location{"", "the document"};
  const JsonValue* outer = &root;
  while (outer->begins() != value.begins()) {
    if (const JsonValue::Object* object = outer->object()) {
      const std::size_t index = index_at(object->values, value.begins());
      location.name = object->keys[index];
      location.pointer += pointer_step(location.name);
      outer = &object->values[index];
    } else {
      const std::size_t index = index_at(*outer->array(), value.begins());
      location.name = "item " + std::to_string(index);
      location.pointer += pointer_step(std::to_string(index));
      outer = &(*outer->array())[index];
    }
  }
  return location;
}

}  // namespace fleetplan::api
