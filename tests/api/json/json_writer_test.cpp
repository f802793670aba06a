#include "api/json/json_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace fleetplan::api {
namespace TEST_FILE {

std::string written(double number) {
  JsonWriter json;
  return json.value(number).take();
}

std::string written(const std::string& text) {
  JsonWriter json;
  return json.value(std::string_view(text)).take();
}

TEST(JsonWriter, WritesNumbersThatRoundTrip) {
  for (const double number : {0.1, 1.0 / 3.0, 1e-9, 5e-324, 1.7976931348623157e308, 123456789.125, -2.5}) {
    EXPECT_EQ(nlohmann::json::parse(written(number)).get<double>(), number);
  }
}

TEST(JsonWriter, WritesWholeDoublesAsRealNumbers) {
  EXPECT_EQ(written(5.0), "5.0");
  EXPECT_EQ(written(1e30), "1e+30");
  EXPECT_EQ(written(0.25), "0.25");
}

TEST(JsonWriter, WritesNoNegativeZero) { EXPECT_EQ(written(-0.0), "0.0"); }

TEST(JsonWriter, WritesNullForNonFiniteNumbers) {
  EXPECT_EQ(written(std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(written(std::numeric_limits<double>::quiet_NaN()), "null");
}

TEST(JsonWriter, EscapesStrings) {
  EXPECT_EQ(written("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(written("\n\t\x01\x1f"), R"("\n\t\u0001\u001f")");
  EXPECT_EQ(written("Wägelchen 🚚"), "\"Wägelchen 🚚\"");
}

TEST(JsonWriter, KeepsValidUtf8) {
  for (const std::string text : {"\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xef\xbf\xbf",
                                 "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(written(text), '"' + text + '"');
  }
}

TEST(JsonWriter, ReplacesInvalidUtf8) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"\xff", "\uFFFD"},
      {"a\x80z", "a\uFFFDz"},
      {"\xc3", "\uFFFD"},  // ends within a character
      {"\xc3(", "\uFFFD("},
      {"\xf0\x9f\x9a\"", "\uFFFD\\\""},
      {"\xc0\xaf", "\uFFFD\uFFFD"},                      // overlong
      {"\xe0\x9f\xbf", "\uFFFD\uFFFD\uFFFD"},            // overlong
      {"\xed\xa0\x80", "\uFFFD\uFFFD\uFFFD"},            // a surrogate
      {"\xf4\x90\x80\x80", "\uFFFD\uFFFD\uFFFD\uFFFD"},  // beyond U+10FFFF
      {"\xe2\x82\xe2\x82\xac", "\uFFFD\u20AC"}};
  for (const auto& [text, expected] : texts) {
    EXPECT_EQ(written(text), '"' + expected + '"');
    EXPECT_EQ(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
              written(text));
  }
}

TEST(JsonWriter, SeparatesMembersAndItems) {
  JsonWriter json;
  json.begin_object().member("a", 1).key("b").begin_array().value(true).value("x");
  json.begin_object().end_object().end_array().member("c", std::optional<double>{}).end_object();
  EXPECT_EQ(json.take(), R"({"a":1,"b":[true,"x",{}],"c":null})");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
