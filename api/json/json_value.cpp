#include "api/json/json_value.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::api {

namespace {

// Beyond 2^53 doubles cannot distinguish neighbouring whole numbers.
constexpr double kLargestExactWhole = 9007199254740992.0;

std::uint32_t narrow(std::size_t size) { return static_cast<std::uint32_t>(size); }

}  // namespace

void JsonTape::add(Kind kind, Data data) { nodes_.push_back({kind, narrow(nodes_.size()) + 1, data}); }

void JsonTape::add_string(std::string_view string, std::size_t end) {
  const std::size_t length = string.size();
  if (end >= length && end <= text_.size() && text_.substr(end - length, length) == string) {
    return add(Kind::text, {.slice = {narrow(end - length), narrow(length)}});
  }
  add(Kind::decoded, {.slice = {narrow(decoded_.size()), narrow(length)}});
  decoded_.append(string);
}

std::uint32_t JsonTape::open(Kind kind) {
  nodes_.push_back({kind, kOpen, {.natural = 0}});
  return narrow(nodes_.size()) - 1;
}

void JsonTape::close(std::uint32_t container, std::size_t size) {
  nodes_[container].next = narrow(nodes_.size());
  nodes_[container].data.natural = size;
}

std::string_view JsonTape::string(const Node& node) const {
  const std::string_view all = node.kind == Kind::text ? text_ : std::string_view(decoded_);
  return all.substr(node.data.slice.offset, node.data.slice.length);
}

std::optional<bool> JsonValue::boolean() const {
  if (held().kind != JsonTape::Kind::boolean) return std::nullopt;
  return held().data.natural != 0;
}

std::optional<double> JsonValue::number() const {
  switch (held().kind) {
    case JsonTape::Kind::real:
      return held().data.real;
    case JsonTape::Kind::natural:
      return static_cast<double>(held().data.natural);
    case JsonTape::Kind::integer:
      return static_cast<double>(held().data.integer);
    default:
      return std::nullopt;
  }
}

std::optional<std::uint64_t> JsonValue::natural() const {
  if (held().kind == JsonTape::Kind::natural) return held().data.natural;
  if (held().kind == JsonTape::Kind::real) {
    const double real = held().data.real;
    const bool whole = real >= 0.0 && real <= kLargestExactWhole && std::floor(real) == real;
    if (whole) return static_cast<std::uint64_t>(real);
  }
  return std::nullopt;
}

std::optional<std::int64_t> JsonValue::integer() const {
  return held().kind == JsonTape::Kind::integer ? std::optional(held().data.integer) : std::nullopt;
}

std::optional<std::string_view> JsonValue::string() const {
  const bool is_string = held().kind == JsonTape::Kind::text || held().kind == JsonTape::Kind::decoded;
  return is_string ? std::optional(tape_->string(held())) : std::nullopt;
}

JsonValue::Children JsonValue::children() const {
  const std::uint32_t keys = is_object() ? 1 : 0;
  const bool holds = is_object() || is_array();
  const std::uint32_t last = std::min(held().next, narrow(tape_->nodes_.size()));
  return {{*tape_, holds ? node_ + 1 : last, keys}, {*tape_, last, keys}};
}

JsonValue JsonValue::item(std::size_t index) const {
  auto child = children().begin();
  for (std::size_t passed = 0; passed < index; ++passed) ++child;
  return *child;
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!is_object()) return std::nullopt;
  const auto& nodes = tape_->nodes_;
  const std::uint32_t last = std::min(held().next, narrow(nodes.size()));
  // Goes as children() do. Every member of a request is looked for, and most keys differ in length.
  for (std::uint32_t node = node_ + 1; node < last; node = nodes[node + 1].next) {
    const JsonTape::Node& name = nodes[node];
    if (name.data.slice.length == key.size() && tape_->string(name) == key)
      return JsonValue(*tape_, node + 1);
  }
  return std::nullopt;
}

JsonPlace JsonValue::ends() const {
  // This is after all that is inside; of two values that end together, the inner one ends first.
  return (JsonPlace{held().next} << 33U) - 1 - node_;
}

}  // namespace fleetplan::api
