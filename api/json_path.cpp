#include "api/json_path.h"

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

std::string JsonPath::pointer() const {
  std::string pointer;
  for (const JsonPath* step = this; step->parent_ != nullptr; step = step->parent_) {
    pointer.insert(0, step->index_ == kNoIndex ? pointer_step(step->key_) : "/" + std::to_string(step->index_));
  }
  return pointer;
}

std::string JsonPath::name() const {
  if (parent_ == nullptr) return "the document";
  return index_ == kNoIndex ? std::string(key_) : "item " + std::to_string(index_);
}

}  // namespace fleetplan::api
