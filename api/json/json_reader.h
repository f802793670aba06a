#pragma once

// Strict JSON: UTF-8, no NaN, no comments, nothing after the document, no key twice, bounded depth. A body is
// read into a document. A reader gives access to its values and reports what is wrong with them.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/json/json_value.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A JSON document. It has the faults that only its reader can see (duplicate keys), and the condition that
/// ends reading it. The text must outlive it.
struct JsonDocument {
  JsonTape tape;
  FaultList faults;
  core::Work* work = nullptr;  // counts the work of reading the document

  JsonValue root() const { return tape.root(); }
};

/// Why a body cannot be read as a document.
struct JsonError {
  enum class Kind {
    malformed,  // the detail has line, column and byte
    too_deep,
    too_large,   // more values than any request needs
    unfinished,  // the work was met first; no detail
  };
  Kind kind = Kind::malformed;
  std::string detail;
};

/// Reads a body. Arrays and objects may nest up to `max_depth` deep. If two members have the same key, the
/// first counts, and the second is a fault. The use of the stack does not grow with the body.
Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth, core::Work& work);

/// Returns the values of a text that is JSON. Several times as fast as the general parser, which matters for
/// megabytes of numbers or a large image. Returns none in these cases; then the general parser has the
/// answer, and says what is wrong:
///
/// - The text is not JSON, or nests deeper than `max_depth`.
/// - It has more than `max_values` values.
/// - It has a number beyond the range of doubles, or of 18 digits.
/// - `work` is met.
std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& work);

/// Returns how many bytes at the begin are plain characters of a JSON string (RFC 8259, section 7). Plain is
/// valid UTF-8 without quotes, backslashes and control characters.
std::size_t plain_length(std::string_view text);

/// A closed range of numbers, and their unit for messages.
struct Range {
  double least;
  double max;
  std::string_view unit;
};

/// The most characters of a name. An answer repeats names as often as robots conflict.
inline constexpr std::size_t kLongestName = 256;  // characters

/// A value of a document, or the absence of a value, with typed access. If something is wrong with the value,
/// reading it adds a fault at the value's place, and returns nothing. Reading an absent value also returns
/// nothing.
///
/// A reader is a handle and may be copied freely. The document must outlive it and must not move. A reader of
/// an absent value knows its document, too.
class JsonReader {
 public:
  JsonReader() = default;  // absent, and of no document
  /// Reads the root of a document.
  explicit JsonReader(JsonDocument& document) : JsonReader(document, document.root()) {}

  explicit operator bool() const { return value_.has_value(); }
  bool is_null() const { return value_ && value_->is_null(); }
  bool is_number() const { return value_ && value_->number().has_value(); }
  std::optional<std::uint64_t> natural() const;
  /// The text of a string. None if the value is something else, which is no fault.
  std::optional<std::string_view> string() const { return value_ ? value_->string() : std::nullopt; }

  /// The value itself if it is an object, otherwise absent. Members that are not `known` are faults.
  JsonReader object(std::span<const std::string_view> known) const;
  /// Returns a member of an object; absent if it is not there.
  JsonReader find(std::string_view key) const;
  /// Returns a member that an object must have. `remedy` ends the fault's sentence: "; give ...".
  JsonReader require(std::string_view key, std::string_view remedy = {}) const;

  /// The value itself if it is an array, otherwise absent.
  JsonReader array() const;
  std::size_t size() const;  // of an array; 0 when absent
  /// Returns one item of an array, in time proportional to the index.
  JsonReader item(std::size_t index) const { return at(value_->item(index)); }
  /// Returns all items of the array, for a range-based loop; ends early when the reading of the document is
  /// stopped.
  class Items;
  Items items() const;
  /// Returns all members of the object, for a range-based loop that ends early in the same way. Their keys
  /// are value().key(). For objects of many members, because `find` looks at all members before its result.
  Items members() const;

  std::optional<double> number(const Range& range) const;
  /// Returns a whole number from 0 to `max`. Anything else is a fault.
  std::optional<std::uint64_t> natural(std::uint64_t max) const;
  std::optional<bool> boolean() const;
  /// Returns a string of 1 to kLongestName characters. Anything else is a fault.
  std::optional<std::string> name() const;
  /// Returns the index of the string among the words. Anything else is a fault.
  std::optional<std::size_t> word(std::span<const std::string_view> words) const;

  /// The value, which must be there.
  const JsonValue& value() const { return *value_; }
  /// The value in words, for a message: `the string "abc"`, `-1`, `an array`. The value must be there.
  std::string description() const;
  /// Adds a fault at the value. The value must be there.
  void fault(const char* code, const std::string& detail) const {
    fault(code, [&] { return detail; });
  }
  /// Adds a fault at a value. There may be many such values, so the text is made only if it will be listed.
  template <std::invocable MakeDetail>
  void fault(const char* code, const MakeDetail& make_detail) const {
    document_->faults.add(value_->begins(), [&] { return Fault{pointer(), code, make_detail()}; });
  }
  /// Adds a fault with the detail "<name> must be <wanted>, not <value><note>."
  void must_be(const char* code, std::string_view wanted, std::string_view note = {}) const {
    must_be(
        code, [&] { return wanted; }, note);
  }
  template <std::invocable MakeWanted>
  void must_be(const char* code, const MakeWanted& make_wanted, std::string_view note = {}) const {
    document_->faults.add(value_->begins(), [&] { return unwanted(code, make_wanted(), note); });
  }
  /// Returns a fault at the value, but does not add it to the faults of the document. The value must be
  /// there.
  Fault described_fault(const char* code, std::string detail) const {
    return {pointer(), code, std::move(detail)};
  }
  /// Returns the faults that `read` finds. They are not added to the document.
  template <std::invocable Read>
  FaultList faults_of(const Read& read) const {
    FaultList of_document = std::exchange(document_->faults, {});
    read();
    return std::exchange(document_->faults, std::move(of_document));
  }
  /// The work that ends the reading of the document. The value may be absent.
  core::Work& work() const { return *document_->work; }
  /// Counts faults of the document that are not described.
  void count_more_faults(std::size_t faults) const { document_->faults.count_more(faults); }
  /// The number of faults of the document so far.
  std::size_t fault_count() const { return document_ != nullptr ? document_->faults.count() : 0; }

 private:
  JsonReader(JsonDocument& document, const JsonValue& value) : document_(&document), value_(value) {}
  JsonReader at(const JsonValue& value) const { return JsonReader(*document_, value); }
  JsonReader absent() const {
    JsonReader absent;
    absent.document_ = document_;
    return absent;
  }
  std::string pointer() const;
  std::string name_in_messages() const;
  Fault unwanted(const char* code, std::string_view wanted, std::string_view note) const;
  void wrong_type(std::string_view wanted) const;
  std::string_view note_on_null() const;

  JsonDocument* document_ = nullptr;
  std::optional<JsonValue> value_;  // the value in the document; none: absent
};

class JsonReader::Items {
 public:
  class Iterator {
   public:
    Iterator(JsonDocument* document, const std::optional<JsonValue::Children::Iterator>& at)
        : document_(document), at_(at) {}
    JsonReader operator*() const { return {*document_, **at_}; }
    Iterator& operator++() {
      ++*at_;
      return *this;
    }
    /// Whether the loop ends. Also true when the reading is stopped. Compare it only with the end.
    bool operator==(const Iterator& end) const {
      return !end.at_ || *at_ == *end.at_ || document_->work->met_after(kWorkOfAValue);
    }

   private:
    JsonDocument* document_;
    std::optional<JsonValue::Children::Iterator> at_;  // none: the array is absent
  };

  explicit Items(const JsonReader& container);
  Iterator begin() const { return begin_; }
  Iterator end() const { return end_; }

 private:
  // The work of reading an item, in bytes of text.
  static constexpr std::size_t kWorkOfAValue = 64;

  Iterator begin_;
  Iterator end_;
};

}  // namespace fleetplan::api
