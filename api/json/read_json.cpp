#include "api/json/read_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "api/json/explain_json.h"
#include "api/json/fault_text.h"
#include "api/json/location.h"

namespace fleetplan::api {

namespace {

// No request comes near (32 MiB of actions are 2 million values), and memory stays within a few hundred MB.
constexpr std::uint32_t kMostValues = 5'000'000;
// Up to here a linear look for a key that comes twice is faster than a set.
constexpr std::size_t kFewKeys = 16;

/// Builds a JsonValue from what the parser meets.
class Builder {
 public:
  using Json = nlohmann::json;

  /// `overflowing`: which numbers, counted from 0 in the order of the document, are too large for a double.
  Builder(int max_depth, std::vector<std::size_t> overflowing)
      : max_depth_(max_depth), overflowing_(std::move(overflowing)) {}

  bool null() { return add(JsonValue()); }
  bool boolean(bool value) { return add(JsonValue(value)); }
  bool number_integer(Json::number_integer_t value) {
    ++numbers_;
    return add(JsonValue(std::int64_t{value}));
  }
  bool number_unsigned(Json::number_unsigned_t value) {
    const bool overflows = std::binary_search(overflowing_.begin(), overflowing_.end(), numbers_++);
    return add(overflows ? JsonValue(std::numeric_limits<double>::infinity())
                         : JsonValue(std::uint64_t{value}));
  }
  bool number_float(Json::number_float_t value, const Json::string_t& /*written*/) {
    ++numbers_;
    return add(JsonValue(value));
  }
  bool string(Json::string_t& value) { return add(JsonValue(std::move(value))); }
  bool binary(Json::binary_t& /*value*/) { return false; }  // not in JSON text
  bool start_object(std::size_t /*size*/) { return open(true); }
  bool end_object() { return close(); }
  bool start_array(std::size_t /*size*/) { return open(false); }
  bool end_array() { return close(); }
  bool key(Json::string_t& key);

  bool parse_error(std::size_t position, const std::string& /*token*/, const Json::exception& error) {
    error_position_ = position;
    overflowed_ = dynamic_cast<const Json::out_of_range*>(&error) != nullptr;
    return false;
  }

  bool too_deep() const { return too_deep_; }
  bool too_many() const { return clock_ >= kMostValues; }
  bool overflowed() const { return overflowed_; }
  std::size_t error_position() const { return error_position_; }
  JsonDocument take() { return {std::move(root_), std::move(faults_)}; }

 private:
  struct Frame {
    bool is_object = false;
    std::uint32_t begins = 0;
    JsonValue::Array items;
    JsonValue::Object members;  // one more key than values while a value is being read
    // The keys, once there are more than a few; ordered, as keys can be made whose hashes are all the same.
    std::set<std::string> seen;
  };

  bool open(bool is_object);
  bool close();
  bool add(JsonValue value);
  void attach(JsonValue value);
  static bool came_before(Frame& frame, const std::string& key);
  std::string pointer() const;

  int max_depth_;
  std::vector<std::size_t> overflowing_;
  std::vector<Frame> frames_;
  JsonValue root_;
  FaultList faults_;
  std::uint32_t clock_ = 0;
  std::size_t numbers_ = 0;
  std::size_t error_position_ = 0;
  bool too_deep_ = false;
  bool overflowed_ = false;
};

bool Builder::open(bool is_object) {
  if (frames_.size() >= static_cast<std::size_t>(max_depth_)) {
    too_deep_ = true;
    return false;
  }
  Frame frame;
  frame.is_object = is_object;
  frame.begins = clock_++;
  frames_.push_back(std::move(frame));
  return !too_many();
}

bool Builder::close() {
  Frame frame = std::move(frames_.back());
  frames_.pop_back();
  JsonValue value = frame.is_object ? JsonValue(std::move(frame.members)) : JsonValue(std::move(frame.items));
  value.set_place(frame.begins, clock_++);
  attach(std::move(value));
  return !too_many();
}

bool Builder::add(JsonValue value) {
  value.set_place(clock_, clock_);
  ++clock_;
  attach(std::move(value));
  return !too_many();
}

void Builder::attach(JsonValue value) {
  if (frames_.empty()) {
    root_ = std::move(value);
  } else if (frames_.back().is_object) {
    frames_.back().members.values.push_back(std::move(value));
  } else {
    frames_.back().items.push_back(std::move(value));
  }
}

bool Builder::key(Json::string_t& key) {
  Frame& frame = frames_.back();
  const bool duplicate = came_before(frame, key);
  frame.members.keys.push_back(std::move(key));
  if (duplicate) {
    faults_.add(clock_, [&] {
      return Fault{pointer(), fault::kDuplicate,
                   "The key " + in_quotes(frame.members.keys.back()) +
                       " occurs twice in this object; keep one of them."};
    });
  }
  return true;
}

bool Builder::came_before(Frame& frame, const std::string& key) {
  const auto& keys = frame.members.keys;
  if (keys.size() < kFewKeys) return std::find(keys.begin(), keys.end(), key) != keys.end();
  if (frame.seen.empty()) frame.seen.insert(keys.begin(), keys.end());
  return !frame.seen.insert(key).second;
}

std::string Builder::pointer() const {
  std::string pointer;
  for (const Frame& frame : frames_) {
    pointer += pointer_step(frame.is_object ? frame.members.keys.back() : std::to_string(frame.items.size()));
  }
  return pointer;
}

/// Where a number ends that begins at the offset, by the grammar of JSON; what follows is not looked at.
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

/// The parser stops at a number that is too large; to report it together with all other faults, a body that
/// has one is read a second time without them.
Tamed tame_overflowing(std::string_view body) {
  Tamed tamed{std::string(body), {}};
  std::string& text = tamed.body;
  std::size_t numbers = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
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
            "The JSON holds more than " + std::to_string(kMostValues) + " values, which no request needs."};
  }
  return {JsonError::Kind::malformed, explain_malformed(body, builder.error_position())};
}

}  // namespace

Result<JsonDocument, JsonError> read_json(std::string_view body, int max_depth) {
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return JsonError{JsonError::Kind::malformed, "The body is empty; send the request as a JSON object."};
  }
  // The parser takes a NUL for the end of the input and would not see what follows.
  if (const std::size_t nul = body.find('\0'); nul != std::string_view::npos) {
    return JsonError{JsonError::Kind::malformed, explain_malformed(body, nul + 1)};
  }
  Builder builder(max_depth, {});
  if (nlohmann::json::sax_parse(body.begin(), body.end(), &builder)) return builder.take();
  if (!builder.overflowed()) return error_of(builder, body, max_depth);

  Tamed tamed = tame_overflowing(body);
  Builder again(max_depth, std::move(tamed.overflowing));
  if (nlohmann::json::sax_parse(tamed.body.begin(), tamed.body.end(), &again)) return again.take();
  return error_of(again, body, max_depth);
}

}  // namespace fleetplan::api
