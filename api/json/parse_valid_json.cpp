#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "api/json/json_reader.h"

namespace fleetplan::api {

namespace {

constexpr std::uint64_t kOnes = 0x0101010101010101U;
constexpr std::uint64_t kHighs = 0x8080808080808080U;

/// Whether any of eight bytes is zero.
bool has_zero(std::uint64_t bytes) { return ((bytes - kOnes) & ~bytes & kHighs) != 0; }

/// Whether any of eight bytes is a quote, a backslash, a control character or not ASCII.
bool has_special(std::uint64_t bytes) {
  const bool not_ascii = (bytes & kHighs) != 0;
  const bool control = ((bytes - kOnes * 0x20U) & ~bytes & kHighs) != 0;
  return not_ascii || control || has_zero(bytes ^ kOnes * '"') || has_zero(bytes ^ kOnes * '\\');
}

std::uint32_t byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

/// Returns the length of the character of UTF-8 at the offset, which is not ASCII; 0 if it is invalid.
std::size_t character_length(std::string_view text, std::size_t at) {
  const auto continues = [&](std::size_t offset) { return (byte_at(text, at + offset) & 0xC0U) == 0x80U; };
  const std::uint32_t first = byte_at(text, at);
  const std::uint32_t second = byte_at(text, at + 1);
  if (first >= 0xC2U && first <= 0xDFU) return continues(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {  // not overlong, no surrogates
    if ((first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second > 0x9FU)) return 0;
    return continues(1) && continues(2) ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {  // not overlong, up to U+10FFFF
    if ((first == 0xF0U && second < 0x90U) || (first == 0xF4U && second > 0x8FU)) return 0;
    return continues(1) && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto rest = [&](std::uint32_t shift) { text += static_cast<char>(0x80U | (code >> shift & 0x3FU)); };
  if (code < 0x80U) {
    text += static_cast<char>(code);
  } else if (code < 0x800U) {
    text += static_cast<char>(0xC0U | code >> 6U);
    rest(0);
  } else if (code < 0x10000U) {
    text += static_cast<char>(0xE0U | code >> 12U);
    rest(6);
    rest(0);
  } else {
    text += static_cast<char>(0xF0U | code >> 18U);
    rest(12);
    rest(6);
    rest(0);
  }
}

/// Returns the number that four hexadecimal digits stand for.
std::optional<std::uint32_t> hexadecimal(std::string_view text, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t index = at; index < at + 4; ++index) {
    const std::uint32_t c = byte_at(text, index);
    const std::uint32_t lower = c | 0x20U;
    if (c >= '0' && c <= '9') {
      number = number * 16 + (c - '0');
    } else if (lower >= 'a' && lower <= 'f') {
      number = number * 16 + (lower - 'a' + 10);
    } else {
      return std::nullopt;
    }
  }
  return number;
}

/// Appends the character of an escape that begins with \u. Returns the length of the escape, or 0.
std::size_t append_coded(std::string& text, std::string_view from, std::size_t at) {
  const auto code = hexadecimal(from, at + 2);
  if (!code || (*code >= 0xDC00U && *code <= 0xDFFFU)) return 0;
  if (*code < 0xD800U || *code > 0xDBFFU) {
    append_utf8(text, *code);
    return 6;
  }
  const bool is_pair = byte_at(from, at + 6) == '\\' && byte_at(from, at + 7) == 'u';
  const auto low = is_pair ? hexadecimal(from, at + 8) : std::nullopt;
  if (!low || *low < 0xDC00U || *low > 0xDFFFU) return 0;
  append_utf8(text, 0x10000U + ((*code - 0xD800U) << 10U) + (*low - 0xDC00U));
  return 12;
}

/// Appends the character of an escape. Returns the length of the escape, or 0.
std::size_t append_escaped(std::string& text, std::string_view from, std::size_t at) {
  constexpr std::string_view kLetters = "\"\\/bfnrt";
  constexpr std::string_view kMeant = "\"\\/\b\f\n\r\t";
  if (at + 1 >= from.size()) return 0;
  if (from[at + 1] == 'u') return append_coded(text, from, at);
  const std::size_t letter = kLetters.find(from[at + 1]);
  if (letter == std::string_view::npos) return 0;
  text += kMeant[letter];
  return 2;
}

}  // namespace

std::size_t plain_length(std::string_view text) {
  std::size_t at = 0;
  // Bounded: each byte is passed once or, of eight with something special, twice.
  while (true) {
    for (std::uint64_t bytes = 0; at + sizeof(bytes) <= text.size(); at += sizeof(bytes)) {
      std::memcpy(&bytes, text.data() + at, sizeof(bytes));
      if (has_special(bytes)) break;
    }
    // The eight bytes with something special, or the last ones.
    while (true) {
      const std::uint32_t byte = byte_at(text, at);
      if (byte >= 0x80U) {
        const std::size_t length = character_length(text, at);
        if (length == 0) return at;
        at += length;
        break;
      }
      if (at == text.size() || byte < 0x20U || byte == '"' || byte == '\\') return at;
      ++at;
    }
  }
}

namespace {

/// A string with its escapes resolved, and its length in the text.
struct DecodedString {
  std::string text;
  std::size_t length = 0;
};

/// Returns the string at the begin of a text, as far as its quote; none if it is not valid.
std::optional<DecodedString> decode_string(std::string_view text) {
  DecodedString decoded;
  std::size_t at = 0;
  while (true) {
    const std::size_t plain = plain_length(text.substr(at));
    decoded.text.append(text.substr(at, plain));
    at += plain;
    if (at == text.size()) return std::nullopt;
    if (text[at] == '"') break;
    const std::size_t length = text[at] == '\\' ? append_escaped(decoded.text, text, at) : 0;
    if (length == 0) return std::nullopt;
    at += length;
  }
  decoded.length = at;
  return decoded;
}

constexpr int kMaxDigits = 18;  // any number of so many digits fits in 64 bits

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads a text from front to back. Every function that returns false has met something that is not JSON, or
/// not for this parser.
class Parser {
 public:
  Parser(std::string_view text, std::size_t max_depth, std::size_t max_values, core::Work& work)
      : text_(text),
        at_(text.data()),
        end_(at_ + text.size()),
        max_depth_(max_depth),
        max_values_(max_values),
        work_(work),
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

  /// Reports what was read to the Work, a stride at a time. Returns true when reading has to end.
  bool pause() {
    for (; static_cast<std::size_t>(at_ - looked_at_) > core::Work::kStride;
         looked_at_ += core::Work::kStride) {
      if (work_.met_after(core::Work::kStride)) return true;
    }
    return false;
  }

  /// Skips white space. Returns false at the end of the text.
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

  /// Reads a value. If it is an array or object that is not empty, reads as far as its first value that is
  /// neither.
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
    for (; at_ != end_ && is_digit(*at_) && at_ - digits < kMaxDigits; ++at_) {
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

  /// Reads a number with a fraction or an exponent, by the grammar of JSON.
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
  core::Work& work_;
  JsonTape tape_;
  std::vector<Frame> frames_;
  std::size_t values_ = 0;
};

}  // namespace

std::optional<JsonTape> parse_valid_json(std::string_view text, std::size_t max_depth, std::size_t max_values,
                                         core::Work& work) {
  return Parser(text, max_depth, max_values, work).run();
}

}  // namespace fleetplan::api
