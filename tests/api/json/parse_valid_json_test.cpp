#include "api/json/parse_valid_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace fleetplan::api {
namespace TEST_FILE {

using Json = nlohmann::json;

std::optional<JsonTape> parse(std::string_view text) {
  core::Work stop = core::Work::unbounded();
  return parse_valid_json(text, 6, 1000, stop);
}

/// The value as another library has it. Of members with the same key, the last one.
Json json_of(const JsonValue& value) {
  if (value.is_null()) return nullptr;
  if (const auto boolean = value.boolean()) return *boolean;
  if (const auto number = value.number()) return *number;
  if (const auto string = value.string()) return std::string(*string);
  Json json = value.is_array() ? Json::array() : Json::object();
  for (const JsonValue child : value.children()) {
    if (value.is_array()) {
      json.push_back(json_of(child));
    } else {
      json[std::string(child.key())] = json_of(child);
    }
  }
  EXPECT_TRUE(value.is_object() || json.size() == value.size());
  return json;
}

/// Expects that the text, if it is parsed, is what another library reads.
bool expect_the_same(const std::string& text) {
  const auto tape = parse(text);
  if (!tape) return false;
  const Json expected = Json::parse(text, nullptr, false);
  EXPECT_FALSE(expected.is_discarded()) << text;
  EXPECT_EQ(json_of(tape->root()), expected) << text;
  return true;
}

TEST(ValidJson, IsReadAsByTheGeneralParser) {
  const std::vector<std::string> texts{
      "0",
      " -0 ",
      "[]",
      "{}",
      "[[],{},[{}]]",
      "\ttrue\r\n",
      "null",
      "[false,null,true]",
      R"("")",
      "[1, -2, 3.5, -0.25e-3, 1E+2, 123456789012345678, -123456789012345678, 0.1, 1e308, 5e-324]",
      R"({"a": {"b": [1, {"c": "d"}], "": 2}, "e": "f"})",
      R"(["plain text that is longer than eight bytes", "\"\\\/\b\f\n\r\t", "\u0041\u00e9\u20ac\ud83e\udd16"])",
      "[\"\xc3\xa9\xe2\x82\xac\xf0\x9f\xa4\x96 and more\", \"12345678\xc3\xa9\", \"\\u0000\", \"\x7f\"]"};
  for (const std::string& text : texts) EXPECT_TRUE(expect_the_same(text)) << text;
}

TEST(ValidJson, IsNotWhatTheGrammarForbids) {
  const std::vector<std::string> texts{"",
                                       " ",
                                       "[",
                                       "{",
                                       "]",
                                       "[1,]",
                                       "[,1]",
                                       "[1 2]",
                                       "{\"a\"}",
                                       "{\"a\":}",
                                       "{\"a\":1,}",
                                       "{a:1}",
                                       "{1:2}",
                                       "01",
                                       "-",
                                       "1.",
                                       ".5",
                                       "+1",
                                       "1e",
                                       "1e+",
                                       "0x1",
                                       "NaN",
                                       "tru",
                                       "truer",
                                       "nul",
                                       "[1]]",
                                       "[1] 2",
                                       "[1}",
                                       "{\"a\":1]",
                                       "\"",
                                       "\"abc",
                                       "\"\\\"",
                                       "\"\\x\"",
                                       "\"\\u12g4\"",
                                       "\"\\ud800\"",
                                       "\"\\udc00\"",
                                       "\"\\ud800\\u0041\"",
                                       "\"\n\"",
                                       "\"\x01\"",
                                       "\"\xff\"",
                                       "\"\xc0\x80\"",
                                       "\"\xc3\"",
                                       "\"\xe0\x80\x80\"",
                                       "\"\xed\xa0\x80\"",
                                       "\"\xf4\x90\x80\x80\"",
                                       "'a'",
                                       "/**/1",
                                       "[1]//"};
  for (const std::string& text : texts) {
    EXPECT_FALSE(parse(text)) << text;
    EXPECT_FALSE(Json::accept(text)) << text;
  }
}

TEST(ValidJson, LeavesToTheGeneralParserWhatIsRare) {
  EXPECT_FALSE(parse("1234567890123456789"));
  EXPECT_FALSE(parse("1e999"));
  EXPECT_FALSE(parse("\xef\xbb\xbf[]"));
  EXPECT_TRUE(parse("[[[[[[]]]]]]"));
  EXPECT_FALSE(parse("[[[[[[[]]]]]]]"));
  std::string many = "[0";
  for (int count = 2; count < 1000; ++count) many += ",0";
  EXPECT_TRUE(parse(many + "]"));
  EXPECT_FALSE(parse(many + ",0]"));
}

TEST(ValidJson, EndsWhenItIsStopped) {
  std::stop_source source;
  source.request_stop();
  core::Work stop({.stop = source.get_token()});
  std::string text = "[0";
  while (text.size() < 3 * core::Work::kStride) text += ",0";
  EXPECT_FALSE(parse_valid_json(text + "]", 6, text.size(), stop));
  EXPECT_TRUE(stop.met());
}

TEST(ValidJson, WithRandomChangesIsReadAsByTheGeneralParserOrNotAtAll) {
  const std::string seed_text =
      "{\"a\\n\": [1, -2.5e3, \"x\xc3\xa9y\\u00e9 \\ud83e\\udd16\"], \"b\": {\"c\": null, \"d\": true}}";
  const std::string letters = "[]{}\",:\\ueE+-.0189 tfn\n\x01\x80\xc3\xe2\xf0\xff";
  std::mt19937 random(7);
  SCOPED_TRACE("seed 7");
  int read = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = seed_text;
    for (int change = 0; change <= round % 3; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0) {
        text.erase(at, 1 + random() % 4);
      } else {
        text.insert(at, 1, letters[random() % letters.size()]);
      }
    }
    if (expect_the_same(text)) ++read;
  }
  EXPECT_GT(read, 1000);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
