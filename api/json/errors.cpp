#include "api/json/errors.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace fleetplan::api {

namespace {

constexpr std::size_t kMaxBytes = 1 << 20;  // a pointer can be as long as the keys in the document

}  // namespace

bool FaultList::wanted(JsonPlace place) const {
  const bool full = placed_.size() >= kMaxListed || bytes_ >= kMaxBytes;
  return !full || place < placed_.back().place;
}

void FaultList::keep(Placed placed) {
  bytes_ += placed.bytes();
  const auto after =
      std::upper_bound(placed_.begin(), placed_.end(), placed.place,
                       [](JsonPlace place, const Placed& other) { return place < other.place; });
  placed_.insert(after, std::move(placed));
  while (placed_.size() > kMaxListed || bytes_ - placed_.back().bytes() >= kMaxBytes) {
    bytes_ -= placed_.back().bytes();
    placed_.pop_back();
  }
}

void FaultList::add_all(FaultList other) {
  count_ += other.count_;
  for (Placed& placed : other.placed_) {
    if (wanted(placed.place)) keep(std::move(placed));
  }
}

std::vector<Fault> FaultList::listed() const {
  std::vector<Fault> faults;
  faults.reserve(placed_.size());
  for (const Placed& placed : placed_) faults.push_back(placed.fault);
  return faults;
}

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char character : key) {
    if (character == '~') {
      step += "~0";
    } else if (character == '/') {
      step += "~1";
    } else {
      step += character;
    }
  }
  return step;
}

Location locate(const JsonValue& root, const JsonValue& value) {
  Location location{"", "the document"};
  JsonValue outer = root;
  // Bounded: children are skipped whole, so each value is passed at most once; only listed faults are
  // located.
  while (outer != value) {
    std::size_t index = 0;
    auto child = outer.children().begin();
    for (; !(*child).contains(value); ++child) ++index;
    location.name = outer.is_object() ? std::string((*child).key()) : "item " + std::to_string(index);
    location.pointer += pointer_step(outer.is_object() ? location.name : std::to_string(index));
    outer = *child;
  }
  return location;
}

namespace {

constexpr std::size_t kLongestQuote = 64;  // bytes
constexpr std::size_t kLongestWord = 32;   // longer words are not typing mistakes of a key

std::string lower(std::string_view text) {
  std::string lowered(text);
  for (char& character : lowered) {
    character = static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  }
  return lowered;
}

/// Returns Levenshtein's distance: how many letters to insert, remove or replace.
std::size_t edit_distance(std::string_view left, std::string_view right) {
  std::vector<std::size_t> row(right.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  // Bounded: the words have at most kLongestWord letters.
  for (std::size_t i = 1; i <= left.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= right.size(); ++j) {
      const std::size_t replaced = diagonal + (left[i - 1] == right[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string in_quotes(std::string_view text) {
  std::size_t end = std::min(text.size(), kLongestQuote);
  const auto inside_character = [&] { return (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U; };
  while (end > 0 && end < text.size() && inside_character()) --end;
  std::string quote = "\"";
  quote += text.substr(0, end);
  quote += end < text.size() ? "…\"" : "\"";
  return quote;
}

std::string number_text(double number) {
  if (std::isinf(number)) return number > 0 ? "a number too large for a double" : "a number below any double";
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), result.ptr};
}

std::string described(const JsonValue& value) {
  if (value.is_null()) return "null";
  if (const auto boolean = value.boolean()) return *boolean ? "true" : "false";
  if (const auto natural = value.natural()) return std::to_string(*natural);
  if (const auto number = value.number()) return number_text(*number);
  if (const auto string = value.string()) return "the string " + in_quotes(*string);
  return value.is_array() ? "an array" : "an object";
}

std::string listed(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + in_quotes(word);
  return text;
}

std::string alternatives(std::span<const std::string_view> words) {
  if (words.size() < 2) return listed(words);
  return listed(words.first(words.size() - 1)) + " or " + in_quotes(words.back());
}

std::string suggestion(std::string_view text, std::span<const std::string_view> words) {
  if (text.size() > kLongestWord) return "";
  const std::string wanted = lower(text);
  std::size_t nearest = kLongestWord;
  std::string_view best;
  for (const std::string_view word : words) {
    const std::size_t distance = edit_distance(wanted, lower(word));
    // A third of the word may be wrong; a beginning such as "lin" for "linear_speed" is meant as well.
    const bool close = distance <= std::max<std::size_t>(1, word.size() / 3);
    const bool prefix = wanted.size() >= 3 && word.starts_with(wanted);
    if ((close || prefix) && distance < nearest) {
      nearest = distance;
      best = word;
    }
  }
  if (best.empty()) return "";
  std::string meant = "; did you mean ";
  meant += in_quotes(best);
  meant += '?';
  return meant;
}

namespace {

std::string place(std::string_view body, std::size_t offset) {
  const std::string_view before = body.substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t newline = before.rfind('\n');
  const std::size_t column = newline == std::string_view::npos ? offset + 1 : offset - newline;
  return "line " + std::to_string(line) + ", column " + std::to_string(column) + " (byte " +
         std::to_string(offset + 1) + ")";
}

bool is_ascii_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

bool starts_non_finite(std::string_view rest) {
  if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
  return rest.starts_with("NaN") || rest.starts_with("nan") || rest.starts_with("Inf") ||
         rest.starts_with("inf");
}

bool in_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '+' || c == '-' ||
         c == '.' || c == '_';
}

/// Returns where the string, word or sign begins that the byte at `offset` belongs to.
std::size_t token_start(std::string_view body, std::size_t offset) {
  std::size_t at = 0;
  // Bounded: each byte is passed once.
  while (at <= offset) {
    const std::size_t start = at++;
    if (body[start] == '"') {
      while (at < body.size() && body[at] != '"') at += body[at] == '\\' ? 2 : 1;
      ++at;
    } else if (in_word(body[start])) {
      while (at < body.size() && in_word(body[at])) ++at;
    }
    if (at > offset) return start;
  }
  return offset;
}

/// Returns the fault where the parser stopped. `start` to `stop`: the bytes that could not be placed.
std::string reason(std::string_view body, std::size_t start, std::size_t stop) {
  const std::string_view rest = body.substr(start);
  const auto last = static_cast<unsigned char>(body[stop - 1]);
  const auto before = stop - start >= 2 ? static_cast<unsigned char>(body[stop - 2]) : 0U;
  if (starts_non_finite(rest)) return "NaN and infinities are not JSON; give a finite number";
  if (last >= 0x80 || (before >= 0x80 && last != '"' && last >= 0x20)) {
    return rest.starts_with('"') ? "this string is not valid UTF-8"
                                 : "a character that JSON allows in strings only, or invalid UTF-8";
  }
  if (last < 0x20 && rest.starts_with('"'))
    return "a raw control character in a string; escape it as \\u00XX";
  if (last < 0x20 && last != '\n' && last != '\r' && last != '\t') return "a control character";
  if (rest.starts_with('\'')) return "strings and keys need double quotes, not single quotes";
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#')) {
    return "JSON has no comments";
  }
  const std::string_view token = body.substr(start, stop - start);
  if (token.starts_with('"') && token.find('\\') != std::string_view::npos && !token.ends_with('"')) {
    return "a bad escape in a string";
  }
  return is_ascii_printable(token) ? "unexpected " + in_quotes(token) : "unexpected text";
}

}  // namespace

std::string explain_malformed(std::string_view body, std::size_t position) {
  // Past the last byte the parser counts the end of the input as one more.
  if (position == 0 || position > body.size()) {
    return "Not JSON: the text ends too early, at " + place(body, body.size()) + ".";
  }
  const std::size_t start = token_start(body, position - 1);
  return "Not JSON at " + place(body, start) + ": " + reason(body, start, position) + ".";
}

namespace {

constexpr std::array<ErrorRow, 21> kTable{{
    {ErrorCode::malformed_json, 400, "malformed_json", "Malformed JSON", "The body is not JSON."},
    {ErrorCode::too_deep, 400, "too_deep", "JSON Nested Too Deep",
     "The JSON of the body nests deeper than `max_depth` of `GET /v1/limits`."},
    {ErrorCode::malformed_request, 400, "malformed_request", "Bad Request",
     "The HTTP request itself is malformed."},
    {ErrorCode::unauthorized, 401, "unauthorized", "Unauthorized",
     "The service requires a token, and the request has none or a wrong one."},
    {ErrorCode::foreign_origin, 403, "foreign_origin", "Forbidden",
     "The request comes from a page of another origin (`Origin`), which `--cors-origin` does not list."},
    {ErrorCode::not_found, 404, "not_found", "Not Found", "There is no such path or example."},
    {ErrorCode::method_not_allowed, 405, "method_not_allowed", "Method Not Allowed",
     "The path does not support this method."},
    {ErrorCode::not_acceptable, 406, "not_acceptable", "Not Acceptable",
     "`Accept` excludes every media type of the answer."},
    {ErrorCode::request_timeout, 408, "request_timeout", "Request Timeout",
     "The head or the body of the request did not arrive in time."},
    {ErrorCode::body_too_large, 413, "body_too_large", "Content Too Large",
     "The body exceeds `max_body` of `GET /v1/limits`, as sent or decompressed."},
    {ErrorCode::target_too_long, 414, "target_too_long", "URI Too Long",
     "The path with its query is longer than 8 KiB."},
    {ErrorCode::unsupported_media_type, 415, "unsupported_media_type", "Unsupported Media Type",
     "The body is not declared to be JSON (`Content-Type: application/json`), plain or with gzip."},
    {ErrorCode::wrong_host, 421, "wrong_host", "Misdirected Request",
     "The service listens on loopback, and `Host` is neither a local name nor in `--allowed-hosts`."},
    {ErrorCode::invalid_request, 422, "invalid_request", "Invalid Request",
     "The body is JSON, but not a valid request. `errors` lists the first twenty faults in the order "
     "of the document; `errors_total` counts all."},
    {ErrorCode::check_unfinished, 422, "check_unfinished", "Check Not Finished",
     "`/v1/validate` could not check the plans within the budget, `/v1/simulate` finished no run, "
     "`/v1/margins` too few, or `/v1/matrix` or `/v1/assign` did not have all travel times."},
    {ErrorCode::memory_exceeded, 422, "memory_exceeded", "Memory Limit Exceeded",
     "The request needs more memory than `max_plan_memory` of `GET /v1/limits`, so that there is not even a "
     "partial plan."},
    {ErrorCode::parse_unfinished, 422, "parse_unfinished", "Request Not Read",
     "The request is too large for this service: reading the body took more CPU time than allowed. This is "
     "one "
     "second before the time budget is read, three seconds in all, or the budget."},
    {ErrorCode::head_too_large, 431, "head_too_large", "Request Header Fields Too Large",
     "The head of the request is larger than 32 KiB, or has more than 100 fields."},
    {ErrorCode::internal_error, 500, "internal_error", "Internal Server Error",
     "A bug of the service, such as a plan that its checker rejected."},
    {ErrorCode::overloaded, 503, "overloaded", "Service Unavailable",
     "The queue is full, or the time budget would be spent in the queue. Or large bodies that arrive at once "
     "would take too much memory together, or the process has no memory left."},
    {ErrorCode::draining, 503, "draining", "Service Unavailable", "The service is shutting down."},
}};

constexpr bool is_in_order() {
  for (std::size_t index = 0; index < kTable.size(); ++index) {
    if (static_cast<std::size_t>(kTable[index].code) != index) return false;
  }
  return static_cast<std::size_t>(ErrorCode::draining) + 1 == kTable.size();
}
static_assert(is_in_order(), "every ErrorCode has its row, in the order of the enumeration");

}  // namespace

std::span<const ErrorRow> error_table() { return kTable; }

const ErrorRow& row_of(ErrorCode code) { return kTable[static_cast<std::size_t>(code)]; }

std::string too_large_body_detail(std::string_view size, std::uint64_t limit) {
  return "The body has " + std::string(size) + " bytes; the limit is " + std::to_string(limit) + "." +
         kLargeMapRemedy;
}

}  // namespace fleetplan::api
