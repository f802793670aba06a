#include "api/json/fault_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace fleetplan::api {

namespace {

constexpr std::size_t kLongestQuote = 64;  // bytes
constexpr std::size_t kLongestWord = 32;   // longer ones are no typing mistakes of a key

std::string lower(std::string_view text) {
  std::string lowered(text);
  for (char& character : lowered) {
    character = static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  }
  return lowered;
}

/// Levenshtein's distance: how many letters to insert, remove or replace.
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

}  // namespace fleetplan::api
