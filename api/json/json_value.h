#pragma once

// A JSON document in memory: one node of 16 bytes for each value and each key, in the order of the document.
// Strings stay in the text, unless they have escapes.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::api {

class JsonValue;

/// The place of something in its document. Comparable, otherwise meaningless.
using JsonPlace = std::uint64_t;

/// The nodes of a document. The text must outlive it.
class JsonTape {
 public:
  enum class Kind : std::uint8_t { null, boolean, natural, integer, real, text, decoded, array, object };

  explicit JsonTape(std::string_view text) : text_(text) {}

  void add_null() { add(Kind::null, {}); }
  void add_boolean(bool boolean) { add(Kind::boolean, {.natural = boolean ? 1U : 0U}); }
  void add_natural(std::uint64_t number) { add(Kind::natural, {.natural = number}); }
  void add_integer(std::int64_t number) { add(Kind::integer, {.integer = number}); }
  void add_real(double number) { add(Kind::real, {.real = number}); }
  /// Adds a string or a key. If its characters have no escapes, they end before `end` in the text.
  void add_string(std::string_view string, std::size_t end);
  /// Begins an array or object; returns its node.
  std::uint32_t open(Kind kind);
  void close(std::uint32_t container, std::size_t size);

  std::size_t size() const { return nodes_.size(); }
  JsonValue root() const;
  /// Returns the value at a node. At the node of a key, returns its string.
  JsonValue value(std::uint32_t node) const;

 private:
  friend class JsonValue;

  static constexpr std::uint32_t kOpen = UINT32_MAX;

  struct Slice {
    std::uint32_t offset;
    std::uint32_t length;
  };
  union Data {
    std::uint64_t natural;
    std::int64_t integer;
    double real;
    Slice slice;
  };
  struct Node {
    Kind kind;
    std::uint32_t next;  // the node after this one and all that is in it
    Data data;           // for an array or object: the number of items or members
  };
  static_assert(sizeof(Node) == 16);

  void add(Kind kind, Data data);
  std::string_view string(const Node& node) const;

  std::string_view text_;
  std::string decoded_;
  std::deque<Node> nodes_;  // grows without copies, and without room for twice as many
};

/// One value of a document. It is a handle and may be copied freely. Its tape must outlive it and must not
/// move. Numbers keep their 64-bit integers exactly. A number too large for a double is infinite.
class JsonValue {
 public:
  class Children;

  bool is_null() const { return held().kind == JsonTape::Kind::null; }
  std::optional<bool> boolean() const;
  /// Returns any number as a double; infinite if it is too large.
  std::optional<double> number() const;
  /// Returns a whole number from 0 to 2^64 - 1, even if written like 5.0. None for other values.
  std::optional<std::uint64_t> natural() const;
  /// Returns a number that is written as a whole number from -2^63 to -1. None for other values.
  std::optional<std::int64_t> integer() const;
  std::optional<std::string_view> string() const;
  bool is_array() const { return held().kind == JsonTape::Kind::array; }
  bool is_object() const { return held().kind == JsonTape::Kind::object; }
  /// The number of items of an array or members of an object; 0 for another value.
  std::size_t size() const { return is_array() || is_object() ? held().data.natural : 0; }

  /// Returns the items of an array, or the values of the members of an object.
  Children children() const;
  /// Returns an item of an array, in time proportional to the index.
  JsonValue item(std::size_t index) const;
  /// Returns the first member of an object with this name.
  std::optional<JsonValue> find(std::string_view key) const;
  /// The key of a value that is a member of an object.
  std::string_view key() const { return tape_->string(tape_->nodes_[node_ - 1]); }

  bool contains(const JsonValue& other) const { return node_ <= other.node_ && other.node_ < held().next; }
  bool operator==(const JsonValue& other) const { return node_ == other.node_; }
  std::uint32_t node() const { return node_; }
  /// Where the value begins and ends in the document.
  JsonPlace begins() const { return JsonPlace{node_} << 33U; }
  JsonPlace ends() const;

 private:
  friend class JsonTape;

  JsonValue(const JsonTape& tape, std::uint32_t node) : tape_(&tape), node_(node) {}
  const JsonTape::Node& held() const { return tape_->nodes_[node_]; }

  const JsonTape* tape_;
  std::uint32_t node_;
};

/// A range over the values that are directly in an array or object.
class JsonValue::Children {
 public:
  class Iterator {
   public:
    Iterator(const JsonTape& tape, std::uint32_t node, std::uint32_t keys)
        : tape_(&tape), node_(node), keys_(keys) {}
    JsonValue operator*() const { return {*tape_, node_ + keys_}; }
    Iterator& operator++() {
      node_ = tape_->nodes_[node_ + keys_].next;
      return *this;
    }
    bool operator==(const Iterator& other) const { return node_ == other.node_; }

   private:
    const JsonTape* tape_;
    std::uint32_t node_;  // the node of the value, or of its key
    std::uint32_t keys_;  // nodes of a key before each value: 1 in an object
  };

  Children(Iterator begin, Iterator end) : begin_(begin), end_(end) {}
  Iterator begin() const { return begin_; }
  Iterator end() const { return end_; }

 private:
  Iterator begin_;
  Iterator end_;
};

inline JsonValue JsonTape::root() const { return value(0); }
inline JsonValue JsonTape::value(std::uint32_t node) const { return {*this, node}; }

}  // namespace fleetplan::api
