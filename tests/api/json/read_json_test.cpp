#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {

namespace TEST_FILE {

using testing::HasSubstr;
using testing::Not;

constexpr int kDepth = 32;

JsonError error_of(std::string_view body) {
  const auto read = read_json(body, kDepth, unbounded_work());
  EXPECT_FALSE(read) << "accepted";
  return read ? JsonError{} : read.failure();
}

bool accepted(std::string_view body) { return static_cast<bool>(read_json(body, kDepth, unbounded_work())); }

JsonDocument document(std::string_view body) {
  auto read = read_json(body, kDepth, unbounded_work());
  return std::move(*read);
}

TEST(ReadJson, ReadsEveryKindOfValue) {
  const JsonDocument read = document(R"({"a": [null, true, -1, 18446744073709551615, 0.5, "ä\n"], "b": {}})");
  const JsonValue items = *read.root().find("a");
  ASSERT_EQ(items.size(), 6U);
  EXPECT_TRUE(items.item(0).is_null());
  EXPECT_TRUE(*items.item(1).boolean());
  EXPECT_EQ(items.item(2).number(), -1.0);
  EXPECT_FALSE(items.item(2).natural());
  EXPECT_EQ(items.item(3).natural(), 18446744073709551615U);
  EXPECT_EQ(items.item(4).number(), 0.5);
  EXPECT_EQ(items.item(5).string(), "ä\n");
  EXPECT_TRUE(read.root().find("b")->is_object());
  EXPECT_FALSE(read.root().find("c"));
}

TEST(ReadJson, ReadsFivePointZeroAsAWholeNumber) {
  EXPECT_EQ(document("5.0").root().natural(), 5U);
  EXPECT_FALSE(document("5.5").root().natural());
}

TEST(ReadJson, ReportsLineColumnAndByteOfAnError) {
  const JsonError error = error_of("{\n  \"a\": 1,\n  \"b\" 2\n}");
  EXPECT_EQ(error.kind, JsonError::Kind::malformed);
  EXPECT_THAT(error.detail, HasSubstr("line 3, column 7 (byte 19)"));
  EXPECT_THAT(error.detail, HasSubstr("unexpected \"2\""));
  EXPECT_THAT(error.detail, Not(HasSubstr("exception")));
}

TEST(ReadJson, RejectsTextThatIsNotJson) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "empty"},
      {" \n\t", "empty"},
      {"{\"a\": 1", "too early"},
      {"[1, 2", "too early"},
      {"\"abc", "too early"},
      {"[1] 2", "unexpected"},
      {"{} {}", "unexpected"},
      {"[NaN]", "NaN and infinities"},
      {"[-Infinity]", "NaN and infinities"},
      {"[1,]", "unexpected"},
      {"{'a': 1}", "double quotes"},
      {"{} // comment", "no comments"},
      {"[01]", "unexpected"},
      {"[\"\xff\"]", "UTF-8"},
      {"[\"\xc3\x28\"]", "UTF-8"},
      {"[\"a\nb\"]", "control character"},
      {"[\"\\x\"]", "escape"},
      {"[True]", "unexpected"},
      {std::string("[1]\0[2]", 7), "control character"},
  };
  for (const auto& [body, expected] : cases) {
    const JsonError error = error_of(body);
    EXPECT_EQ(error.kind, JsonError::Kind::malformed) << body;
    EXPECT_THAT(error.detail, HasSubstr(expected)) << body;
    EXPECT_TRUE(Json::accept(problem_reply(ErrorCode::malformed_json, error.detail, "").body)) << body;
  }
}

TEST(ReadJson, LimitsTheDepthWithoutDeepRecursion) {
  EXPECT_TRUE(accepted(std::string(kDepth, '[') + std::string(kDepth, ']')));
  EXPECT_EQ(error_of(std::string(kDepth + 1, '[') + std::string(kDepth + 1, ']')).kind,
            JsonError::Kind::too_deep);
  EXPECT_EQ(error_of(std::string(1'000'000, '[')).kind, JsonError::Kind::too_deep);
  std::string objects;
  for (int level = 0; level < 100'000; ++level) objects += "{\"a\":";
  EXPECT_EQ(error_of(objects).kind, JsonError::Kind::too_deep);
  EXPECT_THAT(error_of(objects).detail, HasSubstr("32"));
}

TEST(ReadJson, RejectsMegabytesOfJunkWithAShortDetail) {
  const std::string junk(3'000'000, 'x');
  EXPECT_EQ(error_of(junk).kind, JsonError::Kind::malformed);
  EXPECT_LT(error_of(junk).detail.size(), 300U);
  EXPECT_LT(error_of('"' + junk).detail.size(), 300U);
  EXPECT_EQ(error_of("[\"" + junk + "\", oops]").kind, JsonError::Kind::malformed);
}

TEST(ReadJson, ReportsTheLaterOfTwoEqualKeys) {
  const JsonDocument read = document(R"({"a/b": [{}, {"x": 1, "y": 2, "x": 3}]})");
  EXPECT_EQ(brief(read.faults.listed()), (Faults{{"/a~1b/1/x", "duplicate"}}));
  EXPECT_EQ(read.root().find("a/b")->item(1).find("x")->number(), 1.0);
}

TEST(ReadJson, ReportsDuplicatesAmongManyKeys) {
  std::string body = "{";
  for (int key = 0; key < 1000; ++key) body += "\"k" + std::to_string(key) + "\":0,";
  EXPECT_EQ(brief(document(body + "\"k7\":0}").faults.listed()), (Faults{{"/k7", "duplicate"}}));
  EXPECT_TRUE(document(body + "\"k\":0}").faults.empty());
}

TEST(ReadJson, BoundsTheMemoryOfLongPointers) {
  const std::size_t length = 1'000'000;
  std::string body = "{\"" + std::string(length, 'k') + "\":{\"a\":0";
  for (int count = 0; count < 1000; ++count) body += ",\"a\":0";
  const JsonDocument read = document(body + "}}");
  EXPECT_EQ(read.faults.count(), 1000U);
  std::size_t bytes = 0;
  for (const Fault& fault : read.faults.listed()) bytes += fault.pointer.size();
  EXPECT_GE(bytes, length);
  EXPECT_LE(bytes, 3 * length);
}

TEST(ReadJson, ReadsNumbersTooLargeForADoubleAsInfinite) {
  const JsonDocument read = document(R"(["1e999 \" 1e999", 7, 1e999, 2.5, -1e999, 1e-999])");
  const JsonValue items = read.root();
  EXPECT_EQ(items.item(1).number(), 7.0);
  EXPECT_TRUE(std::isinf(*items.item(2).number()));
  EXPECT_EQ(items.item(3).number(), 2.5);
  EXPECT_TRUE(std::isinf(*items.item(4).number()));
  EXPECT_EQ(items.item(5).number(), 0.0);
}

TEST(ReadJson, ChecksTheTextAfterANumberTooLargeForADouble) {
  for (const char* body : {"[1e999, oops]", "[1e999e1]", "[1e999-1]", "[1e999.5]", "[1e999, 01e999]",
                           "[1e999, -]", "[1e999, 1e+]", "[1e999, 1.]"}) {
    EXPECT_EQ(error_of(body).kind, JsonError::Kind::malformed) << body;
  }
}

TEST(ReadJson, KeepsStringsWithAndWithoutEscapes) {
  const std::string_view text = R"({"a\"": "\u0061", "": "", "\"": "\"", "plain": "\\plain"})";
  const JsonDocument read = document(text);
  std::vector<std::pair<std::string, std::string>> members;
  for (const JsonValue member : read.root().children()) members.emplace_back(member.key(), *member.string());
  EXPECT_EQ(members, (std::vector<std::pair<std::string, std::string>>{
                         {"a\"", "a"}, {"", ""}, {"\"", "\""}, {"plain", "\\plain"}}));
}

TEST(ReadJson, MakesAtMostTwentyTextsAndCountsAllFaults) {
  std::string body = "{\"k\":0";
  for (int count = 0; count < 1000; ++count) body += ",\"k\":0";
  JsonDocument read = document(body + "}");
  EXPECT_EQ(read.faults.count(), 1000U);
  EXPECT_EQ(read.faults.listed().size(), FaultList::kMaxListed);
  EXPECT_EQ(read.faults.listed().front().pointer, "/k");
}

TEST(ReadJson, BoundsTheNumberOfValues) {
  std::string body = "[0";
  for (int count = 0; count < 5'000'000; ++count) body += ",0";
  EXPECT_EQ(error_of(body + "]").kind, JsonError::Kind::too_large);
}

TEST(ReadJson, TakesLittleTimeForManyKeysWithEqualBeginnings) {
  std::string body = "{";
  for (int key = 0; key < 300'000; ++key)
    body.append("\"").append(std::to_string(1'000'000 + key)).append("\":0,");
  body += "\"1000001\":0}";
  const auto begin = core::thread_cpu_time();
  const JsonDocument read = document(body);
  EXPECT_LT(core::thread_cpu_time() - begin, std::chrono::seconds(5)) << "minutes if it were quadratic";
  EXPECT_EQ(brief(read.faults.listed()), (Faults{{"/1000001", "duplicate"}}));
}

TEST(FaultList, MakesTheTextsOfListedFaultsOnly) {
  FaultList faults;
  int made = 0;
  const auto make_fault = [&made] {
    ++made;
    return Fault{"/", "code", "detail"};
  };
  for (JsonPlace place = 0; place < 100'000; ++place) faults.add(place, make_fault);
  EXPECT_EQ(made, 20);
  EXPECT_EQ(faults.count(), 100'000U);
  EXPECT_EQ(faults.listed().size(), 20U);
}

TEST(FaultList, ListsTheFirstOfTheDocumentInItsOrder) {
  FaultList faults;
  for (int place = 99; place >= 0; --place) {
    faults.add(static_cast<JsonPlace>(place), [&] { return Fault{std::to_string(place), "code", "detail"}; });
  }
  const auto listed = faults.listed();
  ASSERT_EQ(listed.size(), 20U);
  EXPECT_EQ(listed.front().pointer, "0");
  EXPECT_EQ(listed.back().pointer, "19");
}

using Json = nlohmann::json;

std::optional<JsonTape> parse(std::string_view text) {
  core::Work stop = core::Work::unbounded();
  return parse_valid_json(text, 6, 1000, stop);
}

/// The value as another library has it. If several members have the same key, the last one counts.
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
