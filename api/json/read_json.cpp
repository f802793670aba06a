#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "core/runtime/arrays.h"

namespace fleetplan::api {

namespace {

// The number of members up to which comparing all pairs is faster than sorting.
constexpr std::size_t kFewMembers = 16;

class DuplicateKeys {
 public:
  explicit DuplicateKeys(JsonDocument& document) : document_(document) {}

  void report() {
    for (std::uint32_t node = 0; node < document_.tape.size(); ++node) {
      if (document_.work->met_after(1)) return;
      const JsonValue value = document_.tape.value(node);
      if (value.is_object()) check(value);
    }
  }

 private:
  struct Member {
    std::uint32_t hash;  // hash of the key
    std::uint32_t node;  // node of the value
  };

  std::string_view key(const Member& member) const { return document_.tape.value(member.node).key(); }

  void check(const JsonValue& object) {
    if (object.size() <= kFewMembers) return compare_all(object);
    std::vector<Member> members;
    members.reserve(object.size());
    for (const JsonValue value : object.children()) {
      if (document_.work->met_after(1)) return;
      const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>()(value.key()));
      members.push_back({hash, value.node()});
    }
    if (!sort(members)) return;
    for (std::size_t index = 1; index < members.size(); ++index) {
      if (document_.work->met_after(1)) return;
      if (members[index - 1].hash != members[index].hash) continue;
      if (key(members[index - 1]) == key(members[index])) add(document_.tape.value(members[index].node));
    }
  }

  void compare_all(const JsonValue& object) {
    for (const JsonValue value : object.children()) {
      const auto first = object.find(value.key());
      if (first != value) add(value);
    }
  }

  /// Sorts members by key. Equal members stay in the order of the document. Returns false if it was stopped.
  bool sort(std::vector<Member>& members) {
    const auto before = [this](const Member& a, const Member& b) {
      if (a.hash != b.hash) return a.hash < b.hash;
      const int order = key(a).compare(key(b));
      return order != 0 ? order < 0 : a.node < b.node;
    };
    return core::stoppable_sort(members, before,
                                [this](std::size_t work) { return document_.work->met_after(work); });
  }

  void add(const JsonValue& later) {
    document_.faults.add(later.begins(), [&] {
      return Fault{locate(document_.root(), later).pointer, fault::kDuplicate,
                   "The key " + in_quotes(later.key()) + " occurs twice in this object; keep one of them."};
    });
  }

  JsonDocument& document_;
};

/// Reports every member whose key an earlier member of the same object has; until the document's work is met.
/// Takes n log n time for n members, whatever their keys.
void report_duplicate_keys(JsonDocument& document) { DuplicateKeys(document).report(); }

// The most values of a document. No request comes near: 32 MiB of actions are 4 million values.
constexpr std::size_t kMaxValues = 5'000'000;

/// A text as the parser reads it: as a stream, which ends early when the reading is stopped.
class Input {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = char;

    explicit Iterator(Input* input) : input_(input) {}
    char operator*() const { return *input_->at_; }
    Iterator& operator++() {
      if (++input_->at_ == input_->pause_) input_->pause();
      return *this;
    }
    Iterator operator++(int) { return ++*this; }
    bool operator==(const Iterator& other) const { return at_end() == other.at_end(); }

   private:
    bool at_end() const { return input_ == nullptr || input_->at_ == input_->end_; }

    Input* input_;  // all iterators are at its position; null: the end
  };

  Input(std::string_view text, core::Work& work)
      : begin_(text.data()), at_(begin_), pause_(begin_), end_(begin_ + text.size()), work_(work) {
    pause();
  }

  Iterator begin() { return Iterator(this); }
  Iterator end() { return Iterator(nullptr); }
  std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }

 private:
  void pause() {
    const std::size_t step = std::min(core::Work::kStride, static_cast<std::size_t>(end_ - at_));
    if (work_.met_after(step)) {
      end_ = at_;
    } else {
      pause_ = at_ + step;
    }
  }

  const char* begin_;
  const char* at_;
  const char* pause_;
  const char* end_;
  core::Work& work_;
};

/// Puts on the tape what the parser meets.
class Builder {
 public:
  using Json = nlohmann::json;

  /// `overflowing`: which numbers, counted from 0 in the order of the document, are too large for a double.
  Builder(std::string_view text, const Input& input, int max_depth, std::vector<std::size_t> overflowing)
      : input_(input), max_depth_(max_depth), overflowing_(std::move(overflowing)), tape_(text) {}

  bool null() {
    tape_.add_null();
    return added();
  }
  bool boolean(bool value) {
    tape_.add_boolean(value);
    return added();
  }
  bool number_integer(Json::number_integer_t value) {
    ++numbers_;
    tape_.add_integer(value);
    return added();
  }
  bool number_unsigned(Json::number_unsigned_t value) {
    if (std::binary_search(overflowing_.begin(), overflowing_.end(), numbers_++)) {
      tape_.add_real(std::numeric_limits<double>::infinity());
    } else {
      tape_.add_natural(value);
    }
    return added();
  }
  bool number_float(Json::number_float_t value, const Json::string_t& /*written*/) {
    ++numbers_;
    tape_.add_real(value);
    return added();
  }
  bool string(Json::string_t& value) {
    tape_.add_string(value, input_.position() - 1);
    return added();
  }
  bool binary(Json::binary_t& /*value*/) { return false; }  // not in JSON text
  bool start_object(std::size_t /*size*/) { return open(JsonTape::Kind::object); }
  bool end_object() { return close(); }
  bool start_array(std::size_t /*size*/) { return open(JsonTape::Kind::array); }
  bool end_array() { return close(); }
  bool key(Json::string_t& key) {
    tape_.add_string(key, input_.position() - 1);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/, const Json::exception& error) {
    error_position_ = position;
    overflowed_ = dynamic_cast<const Json::out_of_range*>(&error) != nullptr;
    return false;
  }

  bool too_deep() const { return too_deep_; }
  bool too_many() const { return values_ > kMaxValues; }
  bool overflowed() const { return overflowed_; }
  std::size_t error_position() const { return error_position_; }
  JsonTape take() { return std::move(tape_); }

 private:
  struct Frame {
    std::uint32_t container;
    std::size_t size = 0;
  };

  bool open(JsonTape::Kind kind);
  bool close();
  bool added();

  const Input& input_;
  int max_depth_;
  std::vector<std::size_t> overflowing_;
  std::vector<Frame> frames_;
  JsonTape tape_;
  std::size_t values_ = 0;
  std::size_t numbers_ = 0;
  std::size_t error_position_ = 0;
  bool too_deep_ = false;
  bool overflowed_ = false;
};

bool Builder::open(JsonTape::Kind kind) {
  if (frames_.size() >= static_cast<std::size_t>(max_depth_)) {
    too_deep_ = true;
    return false;
  }
  const bool goes_on = added();
  frames_.push_back({tape_.open(kind)});
  return goes_on;
}

bool Builder::close() {
  tape_.close(frames_.back().container, frames_.back().size);
  frames_.pop_back();
  return true;
}

bool Builder::added() {
  if (!frames_.empty()) ++frames_.back().size;
  ++values_;
  return !too_many();
}

/// Returns where a number ends that begins at the offset, by the grammar of JSON; what follows is not looked
/// at.
std::size_t number_end(std::string_view text, std::size_t at) {
  const auto skip = [&](std::string_view any_of) {
    if (at >= text.size() || any_of.find(text[at]) == std::string_view::npos) return false;
    ++at;
    return true;
  };
  const auto skip_digits = [&] {
    while (skip("0123456789")) {
    }
  };
  skip("-");
  if (!skip("0")) skip_digits();
  if (skip(".")) skip_digits();
  if (skip("eE")) {
    skip("+-");
    skip_digits();
  }
  return at;
}

/// A body in which 0 replaces the numbers that are too large for a double, and the indices of these numbers.
struct Tamed {
  std::string body;
  std::vector<std::size_t> overflowing;
};

/// Replaces numbers that are too large. The parser stops at such a number. To report it together with all
/// other faults, a body with such numbers is read a second time without them.
Tamed tame_overflowing(std::string_view body, core::Work& work) {
  Tamed tamed{std::string(body), {}};
  std::string& text = tamed.body;
  std::size_t numbers = 0;
  for (std::size_t at = 0; at < text.size() && !work.met_after(1); ++at) {
    if (text[at] == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\' ? 1 : 0;
    } else if (text[at] == '-' || (text[at] >= '0' && text[at] <= '9')) {
      const std::size_t end = number_end(text, at);
      if (std::isinf(std::strtod(text.substr(at, end - at).c_str(), nullptr))) {
        text.replace(at, end - at, end - at, ' ');
        text[at] = '0';
        tamed.overflowing.push_back(numbers);
      }
      ++numbers;
      at = end - 1;
    }
  }
  return tamed;
}

JsonError error_of(const Builder& builder, std::string_view body, int max_depth) {
  if (builder.too_deep()) {
    return {JsonError::Kind::too_deep, "The JSON nests arrays and objects deeper than the limit of " +
                                           std::to_string(max_depth) + " levels."};
  }
  if (builder.too_many()) {
    return {JsonError::Kind::too_large,
            std::string("The JSON holds more than ") + std::to_string(kMaxValues) +
                " values, which no request needs; send a large map as an image, best as a PNG."};
  }
  return {JsonError::Kind::malformed, explain_malformed(body, builder.error_position())};
}

}  // namespace

Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth, core::Work& work) {
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return JsonError{JsonError::Kind::malformed, "The body is empty; send the request as a JSON object."};
  }
  // The parser takes a NUL for the end of the input and would not see what follows.
  if (const std::size_t nul = body.find('\0'); nul != std::string_view::npos) {
    return JsonError{JsonError::Kind::malformed, explain_malformed(body, nul + 1)};
  }
  if (body.size() > std::numeric_limits<std::uint32_t>::max()) {
    return JsonError{JsonError::Kind::too_large, "The JSON is longer than 4 GiB, which no request needs."};
  }
  const JsonError unfinished{JsonError::Kind::unfinished, ""};
  const auto finished = [&](JsonTape tape) -> Result<JsonDocument, JsonError> {
    JsonDocument document{std::move(tape), {}, &work};
    report_duplicate_keys(document);
    if (work.met()) return unfinished;
    return document;
  };
  if (auto tape = parse_valid_json(body, static_cast<std::size_t>(max_depth), kMaxValues, work)) {
    return finished(std::move(*tape));
  }
  if (work.met()) return unfinished;

  // The general parser takes several times as long, and finds what is wrong.
  Input input(body, work);
  Builder builder(body, input, max_depth, {});
  if (nlohmann::json::sax_parse(input.begin(), input.end(), &builder)) return finished(builder.take());
  if (work.met()) return unfinished;
  if (!builder.overflowed()) return error_of(builder, body, max_depth);

  Tamed tamed = tame_overflowing(body, work);
  Input tame_input(tamed.body, work);
  Builder again(body, tame_input, max_depth, std::move(tamed.overflowing));
  if (nlohmann::json::sax_parse(tame_input.begin(), tame_input.end(), &again)) return finished(again.take());
  if (work.met()) return unfinished;
  return error_of(again, body, max_depth);
}

}  // namespace fleetplan::api
