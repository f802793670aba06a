#include "api/json/parse_valid_json.h"

#include <charconv>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "api/json/json_string.h"

namespace fleetplan::api {

namespace {

constexpr int kMostDigits = 18;  // any number of so many digits fits in 64 bits

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads a text from front to back. Every function that returns false has met something that is not JSON, or
/// not for this parser.
class Parser {
 public:
  Parser(std::string_view text, std::size_t max_depth, std::size_t max_values, core::Work& stop)
      : text_(text),
        at_(text.data()),
        end_(at_ + text.size()),
        max_depth_(max_depth),
        max_values_(max_values),
        stop_(stop),
        tape_(text) {}

  std::optional<JsonTape> run() {
    // After a value, containers end, or the next item or member begins.
    // Bounded: each byte is passed once; pause() looks at the Work.
    while (value()) {
      if (pause()) return std::nullopt;
      while (!frames_.empty() && skip_space() && *at_ == closing()) close();
      if (frames_.empty()) {
        if (skip_space()) return std::nullopt;
        return std::move(tape_);
      }
      if (at_ == end_ || *at_++ != ',') return std::nullopt;
      if (frames_.back().is_object && !key()) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  struct Frame {
    std::uint32_t container;
    bool is_object;
    std::size_t size = 0;
  };

  /// Reports what was read, a stride at a time.
  bool pause() {
    for (; static_cast<std::size_t>(at_ - looked_at_) > core::Work::kStride;
         looked_at_ += core::Work::kStride) {
      if (stop_.met_after(core::Work::kStride)) return true;
    }
    return false;
  }

  /// False at the end of the text.
  bool skip_space() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
    return at_ != end_;
  }

  char closing() const { return frames_.back().is_object ? '}' : ']'; }

  void close() {
    ++at_;
    tape_.close(frames_.back().container, frames_.back().size);
    frames_.pop_back();
  }

  /// A value; of an array or object that is not empty, as far as its first one that is neither.
  bool value() {
    while (skip_space()) {
      if (!frames_.empty()) ++frames_.back().size;
      if (++values_ > max_values_) return false;
      if (*at_ != '[' && *at_ != '{') return scalar();
      if (frames_.size() >= max_depth_) return false;
      const bool is_object = *at_++ == '{';
      frames_.push_back({tape_.open(is_object ? JsonTape::Kind::object : JsonTape::Kind::array), is_object});
      if (!skip_space()) return false;
      if (*at_ == closing()) {
        close();
        return true;
      }
      if (is_object && !key()) return false;
    }
    return false;
  }

  bool key() {
    if (!skip_space() || *at_ != '"' || !string()) return false;
    return skip_space() && *at_++ == ':';
  }

  bool scalar() {
    switch (*at_) {
      case '"':
        return string();
      case 't':
        return word("true") && (tape_.add_boolean(true), true);
      case 'f':
        return word("false") && (tape_.add_boolean(false), true);
      case 'n':
        return word("null") && (tape_.add_null(), true);
      default:
        return number();
    }
  }

  bool word(std::string_view expected) {
    if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(expected)) return false;
    at_ += expected.size();
    return true;
  }

  bool string() {
    const std::string_view rest(at_ + 1, static_cast<std::size_t>(end_ - at_ - 1));
    const std::size_t plain = plain_length(rest);
    if (plain == rest.size()) return false;
    if (rest[plain] == '"') {
      add(rest.substr(0, plain), plain);
      return true;
    }
    const auto decoded = decode_string(rest);
    if (!decoded) return false;
    add(decoded->text, decoded->length);
    return true;
  }

  /// Adds the string, of so many bytes in the text, and passes it and its quotes.
  void add(std::string_view string, std::size_t length) {
    at_ += length + 2;
    tape_.add_string(string, static_cast<std::size_t>(at_ - text_.data()) - 1);
  }

  bool number() {
    const char* const first = at_;
    const bool negative = *at_ == '-';
    if (negative) ++at_;
    const char* const digits = at_;
    std::uint64_t whole = 0;
    for (; at_ != end_ && is_digit(*at_) && at_ - digits < kMostDigits; ++at_) {
      whole = whole * 10 + static_cast<std::uint64_t>(*at_ - '0');
    }
    if (at_ == digits || (*digits == '0' && at_ - digits > 1)) return false;
    if (at_ != end_ && (is_digit(*at_) || *at_ == '.' || *at_ == 'e' || *at_ == 'E')) return real(first);
    if (negative) {
      tape_.add_integer(-static_cast<std::int64_t>(whole));
    } else {
      tape_.add_natural(whole);
    }
    return true;
  }

  /// A number with a fraction or an exponent, by the grammar of JSON.
  bool real(const char* first) {
    if (is_digit(*at_)) return false;
    if (*at_ == '.' && !digits_after(1)) return false;
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      const bool has_sign = at_ + 1 != end_ && (at_[1] == '+' || at_[1] == '-');
      if (!digits_after(has_sign ? 2 : 1)) return false;
    }
    double number = 0.0;
    const auto [end, error] = std::from_chars(first, at_, number);
    if (error != std::errc() || end != at_) return false;
    tape_.add_real(number);
    return true;
  }

  /// Passes so many characters and at least one digit.
  bool digits_after(int characters) {
    at_ += characters;
    if (at_ == end_ || !is_digit(*at_)) return false;
    while (at_ != end_ && is_digit(*at_)) ++at_;
    return true;
  }

  std::string_view text_;
  const char* at_;
  const char* end_;
  const char* looked_at_ = text_.data();
  std::size_t max_depth_;
  std::size_t max_values_;
  core::Work& stop_;
  JsonTape tape_;
  std::vector<Frame> frames_;
  std::size_t values_ = 0;
};

}  // namespace

std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& stop) {
  return Parser(text, max_depth, max_values, stop).run();
}

}  // namespace fleetplan::api
