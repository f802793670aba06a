#include "api/json/printable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/runtime/random.h"

namespace fleetplan::api {
namespace TEST_FILE {

using std::string_literals::operator""s;

/// A character as UTF-8; bytes that are no UTF-8 for a surrogate.
std::string utf8(char32_t code) {
  const auto tail = [code](unsigned shift) { return static_cast<char>(0x80U | (code >> shift & 0x3FU)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0U | code >> 6U), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0U | code >> 12U), tail(6), tail(0)};
  return {static_cast<char>(0xF0U | code >> 18U), tail(12), tail(6), tail(0)};
}

TEST(Printable, EscapesWhatTerminalsAndPicturesMustNotHave) {
  struct Case {
    std::string text;
    std::string shown;
  };
  const std::vector<Case> cases{
      {"", ""},
      {"robot 7, \"Förderband\" 車 🤖", "robot 7, \"Förderband\" 車 🤖"},
      {"\x1b[31m", "\\u001b[31m"},
      {"\x1b]0;title\a", "\\u001b]0;title\\u0007"},
      {"a\0b"s, "a\\u0000b"},
      {"one\r\ntwo\tthree", "one\\u000d\\u000atwo\\u0009three"},
      {"\x7f", "\\u007f"},
      {"\u0080\u009b31m\u009f\u00a0", "\\u0080\\u009b31m\\u009f\u00a0"},
      {"\u061c\u200e\u200f", "\\u061c\\u200e\\u200f"},
      {"\u2027\u2028\u2029\u202a\u202e\u202f", "\u2027\\u2028\\u2029\\u202a\\u202e\u202f"},
      {"\u2065\u2066\u2069\u206a", "\u2065\\u2066\\u2069\\u206a"},
      {"\ufdcf\ufdd0\ufeff\ufffd\ufffe\uffff", "\ufdcf\\ufdd0\\ufeff\ufffd\\ufffe\\uffff"},
      {"\U0001fffe\U000e0041\U0010ffff", "\\ud83f\\udffe\\udb40\\udc41\\udbff\\udfff"},
      {"\x9b"
       "31m",
       "\ufffd31m"},                                     // C1 as a byte
      {"a\xc2", "a\ufffd"},                              // cut off
      {"\xc1\x9b", "\ufffd\ufffd"},                      // overlong
      {"\xed\xa0\x80", "\ufffd\ufffd\ufffd"},            // a surrogate
      {"\xf4\x90\x80\x80", "\ufffd\ufffd\ufffd\ufffd"},  // beyond Unicode
      {"\xe2\x80", "\ufffd\ufffd"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(printable(one.text), one.shown);
    EXPECT_EQ(printable(one.shown), one.shown);
  }
}

TEST(Printable, KeepsTheLinesOfTextsThatHaveSome) {
  EXPECT_EQ(printable("one\n\ttwo\r\n\x1b", Lines::kept), "one\n\ttwo\\u000d\n\\u001b");
}

TEST(Printable, LeavesNoCharacterThatIsForbidden) {
  for (char32_t code = 0; code < 0x110000; ++code) {
    const bool is_control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    const bool turns_text = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    const bool is_surrogate = code >= 0xD800 && code < 0xE000;
    const bool is_no_xml = code == 0xFFFE || code == 0xFFFF;
    if (!is_control && !turns_text && !is_surrogate && !is_no_xml) continue;
    const std::string shown = printable("a" + utf8(code) + "b");
    if (is_surrogate) {
      EXPECT_EQ(shown, "a\ufffd\ufffd\ufffdb");
    } else {
      EXPECT_TRUE(shown.starts_with("a\\u") && shown.size() == 8) << shown;
    }
  }
}

TEST(Printable, OfJsonIsTheSameJson) {
  core::Random random(1);
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (int k = 0; k < 12; ++k) {
      const auto code = static_cast<char32_t>(random.below(random.below(2) == 0 ? 0x3000 : 0x110000));
      if (code < 0xD800 || code > 0xDFFF) text += utf8(code);
    }
    const nlohmann::json json{{"id", text}, {"list", {1, text}}};
    const std::string shown = printable(json.dump(2), Lines::kept);
    EXPECT_EQ(nlohmann::json::parse(shown), json);
    EXPECT_EQ(printable(shown, Lines::kept), shown);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
