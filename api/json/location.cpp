#include "api/json/location.h"

namespace fleetplan::api {

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
  JsonValue outer = root;
  // Bounded: children are skipped whole, so each value is passed at most once; only listed faults are
  // located.
  while (outer != value) {
    std::size_t index = 0;
    auto child = outer.children().begin();
    for (; !(*child).contains(value); ++child) ++index;
    location.name = outer.is_object() ? std::string((*child).key()) : "item " + std::to_string(index);
    location.pointer += pointer_step(outer.is_object() ? location.name : std::to_string(index));
    outer = *child;
  }
  return location;
}

}  // namespace fleetplan::api
