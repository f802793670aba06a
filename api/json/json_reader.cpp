#include "api/json/json_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/json/errors.h"

namespace fleetplan::api {

namespace {

std::string range_text(const Range& range) {
  const std::string unit(range.unit);
  if (range.least == std::numeric_limits<double>::lowest()) return "finite, in " + unit;
  if (range.max == std::numeric_limits<double>::max())
    return "at least " + number_text(range.least) + ' ' + unit;
  return "from " + number_text(range.least) + " to " + number_text(range.max) + ' ' + unit;
}

/// Returns the number of characters of UTF-8. Bytes that continue a character do not count.
std::size_t characters_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

JsonReader::Items::Items(const JsonReader& container)
    : begin_(container.document_, std::nullopt), end_(container.document_, std::nullopt) {
  if (!container) return;
  begin_ = {container.document_, container.value_->children().begin()};
  end_ = {container.document_, container.value_->children().end()};
}

JsonReader::Items JsonReader::items() const { return Items(value_ && value_->is_array() ? *this : absent()); }

JsonReader::Items JsonReader::members() const {
  return Items(value_ && value_->is_object() ? *this : absent());
}

std::string JsonReader::pointer() const { return locate(document_->root(), *value_).pointer; }

std::string JsonReader::name_in_messages() const { return locate(document_->root(), *value_).name; }

std::string JsonReader::description() const { return described(*value_); }

Fault JsonReader::unwanted(const char* code, std::string_view wanted, std::string_view note) const {
  const Location location = locate(document_->root(), *value_);
  std::string detail = location.name + " must be ";
  detail.append(wanted).append(", not ").append(described(*value_)).append(note).append(".");
  return {location.pointer, code, std::move(detail)};
}

void JsonReader::wrong_type(std::string_view wanted) const {
  must_be(fault::kWrongType, wanted, note_on_null());
}

std::string_view JsonReader::note_on_null() const {
  return value_->is_null() ? "; omit it to use its default, if it has one" : "";
}

JsonReader JsonReader::object(std::span<const std::string_view> known) const {
  if (!value_) return *this;
  if (!value_->is_object()) {
    must_be(fault::kWrongType, "an object");
    return absent();
  }
  for (const JsonValue member : value_->children()) {
    const std::string_view key = member.key();
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    if (document_->work->met_after(known.size())) break;
    at(member).fault(fault::kUnknownKey, [&] {
      const std::string meant = suggestion(key, known);
      return in_quotes(key) + " is not a known member" +
             (meant.empty() ? "; known members: " + listed(known) + "." : meant);
    });
  }
  return *this;
}

JsonReader JsonReader::find(std::string_view key) const {
  const auto member = value_ ? value_->find(key) : std::nullopt;
  return member ? at(*member) : absent();
}

JsonReader JsonReader::require(std::string_view key, std::string_view remedy) const {
  if (!value_ || !value_->is_object()) return absent();
  if (const JsonReader member = find(key)) return member;
  // The fault is placed after the members that are there.
  document_->faults.add(value_->ends(), [&] {
    return Fault{pointer() + pointer_step(key), fault::kMissing,
                 std::string(key) + " is missing" + std::string(remedy) + "."};
  });
  return absent();
}

JsonReader JsonReader::array() const {
  if (!value_ || value_->is_array()) return *this;
  wrong_type("an array");
  return absent();
}

std::size_t JsonReader::size() const { return value_ && value_->is_array() ? value_->size() : 0; }

std::optional<double> JsonReader::number(const Range& range) const {
  if (!value_) return std::nullopt;
  const auto number = value_->number();
  if (!number) {
    wrong_type("a number");
    return std::nullopt;
  }
  if (std::isfinite(*number) && *number >= range.least && *number <= range.max) return number;
  must_be(fault::kOutOfRange, [&] { return range_text(range); });
  return std::nullopt;
}

std::optional<std::uint64_t> JsonReader::natural() const { return value_ ? value_->natural() : std::nullopt; }

std::optional<std::uint64_t> JsonReader::natural(std::uint64_t max) const {
  if (!value_) return std::nullopt;
  const auto natural = value_->natural();
  if (natural && *natural <= max) return natural;
  const auto number = value_->number();
  const std::string wanted = "a whole number from 0 to " + std::to_string(max);
  const bool fraction = number && std::isfinite(*number) && std::floor(*number) != *number;
  if (!number || fraction) {
    wrong_type(wanted);
  } else {
    must_be(fault::kOutOfRange, wanted);
  }
  return std::nullopt;
}

std::optional<bool> JsonReader::boolean() const {
  if (!value_) return std::nullopt;
  if (const auto boolean = value_->boolean()) return boolean;
  wrong_type("true or false");
  return std::nullopt;
}

std::optional<std::string> JsonReader::name() const {
  if (!value_) return std::nullopt;
  const auto name = value_->string();
  if (!name) {
    wrong_type("a string");
    return std::nullopt;
  }
  const std::size_t length = characters_of(*name);
  if (length > 0 && length <= kLongestName) return std::string(*name);
  if (length == 0) {
    fault(fault::kEmpty, [&] { return name_in_messages() + " must not be empty."; });
  } else {
    fault(fault::kOutOfRange, [&] {
      return name_in_messages() + " must have at most " + std::to_string(kLongestName) + " characters, not " +
             std::to_string(length) + ".";
    });
  }
  return std::nullopt;
}

std::optional<std::size_t> JsonReader::word(std::span<const std::string_view> words) const {
  if (!value_) return std::nullopt;
  const auto word = value_->string();
  if (!word) {
    must_be(
        fault::kWrongType, [&] { return alternatives(words); }, note_on_null());
    return std::nullopt;
  }
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  fault(fault::kUnknownValue, [&] {
    const std::string meant = suggestion(*word, words);
    return name_in_messages() + " must be " + alternatives(words) + ", not " + in_quotes(*word) +
           (meant.empty() ? "." : meant);
  });
  return std::nullopt;
}

}  // namespace fleetplan::api
