#include "api/json/read_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "api/request/limits.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr int kDepth = 32;

JsonError refused(std::string_view body) {
  const auto read = read_json(body, kDepth);
  const auto* error = std::get_if<JsonError>(&read);
  return error != nullptr ? *error : JsonError{ErrorCode::internal_error, "accepted"};
}

bool accepted(std::string_view body) { return std::holds_alternative<JsonDocument>(read_json(body, kDepth)); }

JsonDocument document(std::string_view body) {
  auto read = read_json(body, kDepth);
  return std::get<JsonDocument>(std::move(read));
}

TEST(ReadJson, ReadsEveryKindOfValue) {
  const JsonDocument read = document(R"({"a": [null, true, -1, 18446744073709551615, 0.5, "ä\n"], "b": {}})");
  const JsonValue::Array& items = *read.root.find("a")->array();
  ASSERT_EQ(items.size(), 6U);
  EXPECT_TRUE(items[0].is_null());
  EXPECT_TRUE(*items[1].boolean());
  EXPECT_EQ(items[2].number(), -1.0);
  EXPECT_FALSE(items[2].natural());
  EXPECT_EQ(items[3].natural(), 18446744073709551615U);
  EXPECT_EQ(items[4].number(), 0.5);
  EXPECT_EQ(*items[5].string(), "ä\n");
  EXPECT_NE(read.root.find("b")->object(), nullptr);
  EXPECT_EQ(read.root.find("c"), nullptr);
}

TEST(ReadJson, TakesFivePointZeroForAWholeNumber) {
  EXPECT_EQ(document("5.0").root.natural(), 5U);
  EXPECT_FALSE(document("5.5").root.natural());
}

TEST(ReadJson, TellsLineColumnAndByteOfAMistake) {
  const JsonError error = refused("{\n  \"a\": 1,\n  \"b\" 2\n}");
  EXPECT_EQ(error.code, ErrorCode::malformed_json);
  EXPECT_THAT(error.detail, HasSubstr("line 3, column 7 (byte 19)"));
  EXPECT_THAT(error.detail, HasSubstr("unexpected \"2\""));
  EXPECT_THAT(error.detail, Not(HasSubstr("exception")));
}

TEST(ReadJson, RefusesWhatIsNotJson) {
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
  for (const auto& [body, wanted] : cases) {
    const JsonError error = refused(body);
    EXPECT_EQ(error.code, ErrorCode::malformed_json) << body;
    EXPECT_THAT(error.detail, HasSubstr(wanted)) << body;
    EXPECT_TRUE(Json::accept(problem_reply(error.code, error.detail, "").body)) << body;
  }
}

TEST(ReadJson, LimitsTheDepthWithoutUsingTheStack) {
  EXPECT_TRUE(accepted(std::string(kDepth, '[') + std::string(kDepth, ']')));
  EXPECT_EQ(refused(std::string(kDepth + 1, '[') + std::string(kDepth + 1, ']')).code, ErrorCode::too_deep);
  EXPECT_EQ(refused(std::string(1'000'000, '[')).code, ErrorCode::too_deep);
  std::string objects;
  for (int level = 0; level < 100'000; ++level) objects += "{\"a\":";
  EXPECT_EQ(refused(objects).code, ErrorCode::too_deep);
  EXPECT_THAT(refused(objects).detail, HasSubstr("32"));
}

TEST(ReadJson, RefusesMegabytesOfJunk) {
  const std::string junk(3'000'000, 'x');
  EXPECT_EQ(refused(junk).code, ErrorCode::malformed_json);
  EXPECT_LT(refused(junk).detail.size(), 300U);
  EXPECT_LT(refused('"' + junk).detail.size(), 300U);
  EXPECT_EQ(refused("[\"" + junk + "\", oops]").code, ErrorCode::malformed_json);
}

TEST(ReadJson, TellsTheLaterOfTwoEqualKeys) {
  const JsonDocument read = document(R"({"a/b": [{}, {"x": 1, "y": 2, "x": 3}]})");
  EXPECT_EQ(brief(read.faults.first(9)), (Faults{{"/a~1b/1/x", "duplicate"}}));
  EXPECT_EQ(read.root.find("a/b")->array()->at(1).find("x")->number(), 1.0);
}

TEST(ReadJson, TellsEqualKeysOfManyToo) {
  std::string body = "{";
  for (int key = 0; key < 1000; ++key) body += "\"k" + std::to_string(key) + "\":0,";
  EXPECT_EQ(brief(document(body + "\"k7\":0}").faults.first(9)), (Faults{{"/k7", "duplicate"}}));
  EXPECT_TRUE(document(body + "\"k\":0}").faults.empty());
}

TEST(ReadJson, HoardsNoLongPointers) {
  const std::size_t length = 1'000'000;
  std::string body = "{\"" + std::string(length, 'k') + "\":{\"a\":0";
  for (int count = 0; count < 1000; ++count) body += ",\"a\":0";
  const JsonDocument read = document(body + "}}");
  EXPECT_EQ(read.faults.count(), 1000U);
  std::size_t bytes = 0;
  for (const Fault& fault : read.faults.first(1000)) bytes += fault.pointer.size();
  EXPECT_GE(bytes, length);
  EXPECT_LE(bytes, 6 * length);
}

TEST(ReadJson, ReadsNumbersTooLargeForADoubleAsInfinite) {
  const JsonDocument read = document(R"(["1e999 \" 1e999", 7, 1e999, 2.5, -1e999, 1e-999])");
  const JsonValue::Array& items = *read.root.array();
  EXPECT_EQ(items[1].number(), 7.0);
  EXPECT_TRUE(std::isinf(*items[2].number()));
  EXPECT_EQ(items[3].number(), 2.5);
  EXPECT_TRUE(std::isinf(*items[4].number()));
  EXPECT_EQ(items[5].number(), 0.0);
}

TEST(ReadJson, LooksAtWhatFollowsANumberTooLargeForADouble) {
  for (const char* body : {"[1e999, oops]", "[1e999e1]", "[1e999-1]", "[1e999.5]", "[1e999, 01e999]",
                           "[1e999, -]", "[1e999, 1e+]", "[1e999, 1.]"}) {
    EXPECT_EQ(refused(body).code, ErrorCode::malformed_json) << body;
  }
}

TEST(ReadJson, BoundsHowManyValuesThereAre) {
  std::string body = "[0";
  for (int count = 0; count < 5'000'000; ++count) body += ",0";
  EXPECT_EQ(refused(body + "]").code, ErrorCode::invalid_request);
}

}  // namespace
}  // namespace fleetplan::api
