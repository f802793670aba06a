#include "api/json/json_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/json/fault_text.h"
#include "api/json/location.h"

namespace fleetplan::api {

namespace {

std::string range_text(const Range& range) {
  const std::string unit(range.unit);
  if (range.least == std::numeric_limits<double>::lowest()) return "finite, in " + unit;
  if (range.most == std::numeric_limits<double>::max())
    return "at least " + number_text(range.least) + ' ' + unit;
  return "from " + number_text(range.least) + " to " + number_text(range.most) + ' ' + unit;
}

/// Of UTF-8: all bytes but those that continue a character.
std::size_t characters_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::string JsonReader::description() const { return described(*value_); }

void JsonReader::fault(const char* code, const std::string& detail) const {
  const auto make_fault = [&] { return Fault{locate(document_->root, *value_).pointer, code, detail}; };
  document_->faults.add(value_->begins(), make_fault);
}

void JsonReader::must_be(const char* code, std::string_view wanted, std::string_view note) const {
  document_->faults.add(value_->begins(), [&] {
    const Location location = locate(document_->root, *value_);
    std::string detail = location.name + " must be ";
    detail.append(wanted).append(", not ").append(described(*value_)).append(note).append(".");
    return Fault{location.pointer, code, std::move(detail)};
  });
}

void JsonReader::wrong_type(std::string_view wanted) const {
  must_be(fault::kWrongType, wanted, value_->is_null() ? "; omit it to use its default, if it has one" : "");
}

JsonReader JsonReader::object(std::span<const std::string_view> known) const {
  if (value_ == nullptr) return {};
  const JsonValue::Object* object = value_->object();
  if (object == nullptr) {
    must_be(fault::kWrongType, "an object");
    return {};
  }
  for (std::size_t index = 0; index < object->keys.size(); ++index) {
    const std::string& key = object->keys[index];
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string meant = suggestion(key, known);
    at(&object->values[index])
        .fault(fault::kUnknownKey, in_quotes(key) + " is not a known member" +
                                       (meant.empty() ? "; known members: " + listed(known) + "." : meant));
  }
  return *this;
}

JsonReader JsonReader::find(std::string_view key) const {
  return value_ != nullptr ? at(value_->find(key)) : JsonReader();
}

JsonReader JsonReader::require(std::string_view key, std::string_view remedy) const {
  if (value_ == nullptr || value_->object() == nullptr) return {};
  if (const JsonReader member = find(key)) return member;
  // After the members that are there.
  document_->faults.add(value_->ends(), [&] {
    const Location location = locate(document_->root, *value_);
    return Fault{location.pointer + pointer_step(key), fault::kMissing,
                 std::string(key) + " is missing" + std::string(remedy) + "."};
  });
  return {};
}

JsonReader JsonReader::array() const {
  if (value_ == nullptr) return {};
  if (value_->array() != nullptr) return *this;
  wrong_type("an array");
  return {};
}

std::size_t JsonReader::size() const {
  const JsonValue::Array* items = value_ != nullptr ? value_->array() : nullptr;
  return items != nullptr ? items->size() : 0;
}

JsonReader JsonReader::item(std::size_t index) const { return at(&(*value_->array())[index]); }

std::optional<double> JsonReader::number(const Range& range) const {
  if (value_ == nullptr) return std::nullopt;
  const auto number = value_->number();
  if (!number) {
    wrong_type("a number");
    return std::nullopt;
  }
  if (std::isfinite(*number) && *number >= range.least && *number <= range.most) return number;
  must_be(fault::kOutOfRange, range_text(range));
  return std::nullopt;
}

std::optional<std::uint64_t> JsonReader::natural() const {
  return value_ != nullptr ? value_->natural() : std::nullopt;
}

std::optional<std::uint64_t> JsonReader::natural(std::uint64_t most) const {
  if (value_ == nullptr) return std::nullopt;
  const auto natural = value_->natural();
  if (natural && *natural <= most) return natural;
  const auto number = value_->number();
  const std::string wanted = "a whole number from 0 to " + std::to_string(most);
  const bool fraction = number && std::isfinite(*number) && std::floor(*number) != *number;
  if (!number || fraction) {
    wrong_type(wanted);
  } else {
    must_be(fault::kOutOfRange, wanted);
  }
  return std::nullopt;
}

std::optional<bool> JsonReader::boolean() const {
  if (value_ == nullptr) return std::nullopt;
  if (const bool* boolean = value_->boolean()) return *boolean;
  wrong_type("true or false");
  return std::nullopt;
}

std::optional<std::string> JsonReader::name() const {
  if (value_ == nullptr) return std::nullopt;
  const std::string* name = value_->string();
  if (name == nullptr) {
    wrong_type("a string");
    return std::nullopt;
  }
  const std::size_t length = characters_of(*name);
  if (length > 0 && length <= kLongestName) return *name;
  const std::string key = locate(document_->root, *value_).name;
  if (length == 0) {
    fault(fault::kEmpty, key + " must not be empty.");
  } else {
    fault(fault::kOutOfRange, key + " must have at most " + std::to_string(kLongestName) +
                                  " characters, not " + std::to_string(length) + ".");
  }
  return std::nullopt;
}

std::optional<std::size_t> JsonReader::word(std::span<const std::string_view> words) const {
  if (value_ == nullptr) return std::nullopt;
  const std::string* word = value_->string();
  if (word == nullptr) {
    wrong_type(alternatives(words));
    return std::nullopt;
  }
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string key = locate(document_->root, *value_).name;
  const std::string meant = suggestion(*word, words);
  fault(fault::kUnknownValue, key + " must be " + alternatives(words) + ", not " + in_quotes(*word) +
                                  (meant.empty() ? "." : meant));
  return std::nullopt;
}

}  // namespace fleetplan::api
