#include "api/json/json_path.h"

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
  if (parent_ == nullptr) return "";
  return parent_->pointer() + pointer_step(index_ == kNoIndex ? key_ : std::to_string(index_));
}

std::string JsonPath::name() const {
  if (parent_ == nullptr) return "the document";
  return index_ == kNoIndex ? std::string(key_) : "item " + std::to_string(index_);
}

}  // namespace fleetplan::api
