#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fleetplan::api {

/// Where a reader is in a document: a chain of keys and indices that live on its call stack and become an
/// RFC 6901 JSON Pointer only when there is a fault to tell. A path refers to its parent and to its key.
class JsonPath {
 public:
  JsonPath() = default;  // the whole document

  JsonPath operator/(std::string_view key) const { return {this, key, kNoIndex}; }
  JsonPath operator/(std::size_t index) const { return {this, {}, index}; }

  /// RFC 6901: "" for the whole document, "/robots/0/start" below it; ~ and / in keys are escaped.
  std::string pointer() const;
  /// The last step for people: the key, or "item 3" for an index, or "the document".
  std::string name() const;

 private:
  static constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);
  JsonPath(const JsonPath* parent, std::string_view key, std::size_t index)
      : parent_(parent), key_(key), index_(index) {}

  const JsonPath* parent_ = nullptr;
  std::string_view key_;
  std::size_t index_ = kNoIndex;
};

/// One step of a JSON Pointer: "/" and the key, with ~ and / escaped.
std::string pointer_step(std::string_view key);

}  // namespace fleetplan::api
