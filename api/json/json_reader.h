#pragma once

// Strict JSON: UTF-8, no NaN, no comments, nothing after the document, no key twice, bounded depth. A body is
// read into a document, and a reader gives access to its values and reports what is wrong with them.

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

/// A document that is JSON, with the faults that only its reader can see (duplicate keys), and when to end
/// reading it. The text has to outlive it.
struct JsonDocument {
  JsonTape tape;
  FaultList faults;
  core::Work* work = nullptr;  // counts the work of reading the document

  JsonValue root() const { return tape.root(); }
};

/// Why a body is not a document that can be read.
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

/// Reads a body. Arrays and objects may nest up to `max_depth` deep. Of two members with the same key the
/// first counts, and the later one is a fault. Uses no stack that grows with the body.
Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth, core::Work& work);

/// Returns the values of a text that is JSON. Reads them several times as fast as the general parser, which
/// megabytes of numbers or a large image need. Returns none if the text is not JSON, nests deeper than
/// `max_depth`, has more than `max_values` values or a number beyond the range of doubles or of 18 digits, or
/// if `work` is met. Then the general parser has the answer, and says what is wrong.
std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& work);

/// Returns how many bytes from the begin are characters of a JSON string as they are (RFC 8259, section 7):
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

/// A value of a document, or the absence of one, with typed access. What is wrong with the value becomes a
/// fault of the document, at the value's place; the read then returns nothing, as it does for an absent
/// value. A reader is a handle, copied freely; the document must outlive it and stay where it is. What is
/// absent from a document knows which one, too.
class JsonReader {
 public:
  JsonReader() = default;  // absent, and of no document
  /// Reads the root of a document.
  explicit JsonReader(JsonDocument& document) : JsonReader(document, document.root()) {}

  explicit operator bool() const { return value_.has_value(); }
  bool is_null() const { return value_ && value_->is_null(); }
  bool is_number() const { return value_ && value_->number().has_value(); }
  std::optional<std::uint64_t> natural() const;
  /// The text of a string; none when the value is something else, which is no fault.
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
  /// Returns all members of the object, for a range-based loop that ends early in the same way; their keys
  /// are value().key(). It is meant for objects of many members, as `find` looks at all members that come
  /// before.
  Items members() const;

  std::optional<double> number(const Range& range) const;
  /// Returns a whole number from 0 to `max`; anything else is a fault.
  std::optional<std::uint64_t> natural(std::uint64_t max) const;
  std::optional<bool> boolean() const;
  /// Returns a string of 1 to kLongestName characters; anything else is a fault.
  std::optional<std::string> name() const;
  /// Returns the index of the word that the string is; anything else is a fault.
  std::optional<std::size_t> word(std::span<const std::string_view> words) const;

  /// The value, which must be there.
  const JsonValue& value() const { return *value_; }
  /// The value, which must be there, for a message: `the string "abc"`, `-1`, `an array`.
  std::string description() const;
  /// Adds a fault at the value, which must be there.
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
  /// Returns a fault at the value, which must be there, without adding it to those of the document.
  Fault described_fault(const char* code, std::string detail) const {
    return {pointer(), code, std::move(detail)};
  }
  /// Returns the faults that `read` finds, which are then none of the document.
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
    /// Whether the loop ends, which is also true when the reading is stopped. Compare it with the end only.
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
