#pragma once

#include <utility>
#include <variant>

namespace fleetplan::api {

/// The outcome of an operation that can fail in an expected way: either its value or its failure, two
/// different types. Ask first:
///
///   auto document = read_json(body, depth);
///   if (!document) return report(document.failure());
///   use(*document);
template <typename Value, typename Failure>
class [[nodiscard]] Result {
 public:
  Result(Value value) : held_(std::in_place_index<0>, std::move(value)) {}        // NOLINT: implicit
  Result(Failure failure) : held_(std::in_place_index<1>, std::move(failure)) {}  // NOLINT: implicit

  explicit operator bool() const { return held_.index() == 0; }
  /// The value; std::bad_variant_access when there is none.
  const Value& operator*() const { return std::get<0>(held_); }
  Value& operator*() { return std::get<0>(held_); }
  const Value* operator->() const { return &std::get<0>(held_); }
  Value* operator->() { return &std::get<0>(held_); }
  /// The failure; std::bad_variant_access when there is none.
  const Failure& failure() const { return std::get<1>(held_); }

 private:
  std::variant<Value, Failure> held_;
};

}  // namespace fleetplan::api
