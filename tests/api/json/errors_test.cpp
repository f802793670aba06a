#include "api/json/errors.h"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "api/json/json_reader.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr std::array<std::string_view, 3> kWords{"radius", "linear_speed", "goal"};

TEST(Suggestion, FindsTheIntendedKey) {
  EXPECT_EQ(suggestion("raduis", kWords), "; did you mean \"radius\"?");
  EXPECT_EQ(suggestion("linearSpeed", kWords), "; did you mean \"linear_speed\"?");
  EXPECT_EQ(suggestion("GOAL", kWords), "; did you mean \"goal\"?");
  EXPECT_EQ(suggestion("linear", kWords), "; did you mean \"linear_speed\"?");
}

TEST(Suggestion, IsEmptyWhenNoWordIsClose) {
  EXPECT_EQ(suggestion("colour", kWords), "");
  EXPECT_EQ(suggestion("", kWords), "");
  EXPECT_EQ(suggestion(std::string(1'000'000, 'r'), kWords), "");
}

TEST(Quotes, CutLongTextAtACharacter) {
  std::string text = "x";
  for (int count = 0; count < 40; ++count) text += "ä";
  const std::string quote = in_quotes(text);
  std::string cut = "\"";
  cut += text.substr(0, 63);
  cut += "…\"";
  EXPECT_EQ(quote, cut);
  EXPECT_EQ(in_quotes("short"), "\"short\"");
}

TEST(Descriptions, NameTypesAndValues) {
  const auto description_of = [](std::string_view text) {
    return described(read_json(text, 9, unbounded_work())->root());
  };
  EXPECT_EQ(description_of("null"), "null");
  EXPECT_EQ(description_of("true"), "true");
  EXPECT_EQ(description_of("-1.5"), "-1.5");
  EXPECT_EQ(description_of("18446744073709551615"), "18446744073709551615");
  EXPECT_EQ(description_of("\"a\""), "the string \"a\"");
  EXPECT_EQ(description_of("[]"), "an array");
  EXPECT_EQ(description_of("{}"), "an object");
  EXPECT_EQ(description_of("1e999"), "a number too large for a double");
}

TEST(Alternatives, ReadLikeASentence) {
  EXPECT_EQ(alternatives(kWords), R"("radius", "linear_speed" or "goal")");
}

JsonDocument document(std::string_view body) {
  auto read = read_json(body, 32, unbounded_work());
  return std::move(*read);
}

TEST(Location, HasAJsonPointer) {
  const JsonDocument read =
      document(R"({"": 0, "robots": [1, {"id": "a"}, [], {"x": {}, "goal": {"x": 4}}]})");
  const JsonValue robots = *read.root().find("robots");
  const JsonValue robot = robots.item(3);
  EXPECT_EQ(locate(read.root(), read.root()).pointer, "");
  EXPECT_EQ(locate(read.root(), robots).pointer, "/robots");
  EXPECT_EQ(locate(read.root(), robots.item(0)).pointer, "/robots/0");
  EXPECT_EQ(locate(read.root(), *robot.find("goal")).pointer, "/robots/3/goal");
  EXPECT_EQ(locate(read.root(), *robot.find("goal")->find("x")).pointer, "/robots/3/goal/x");
  EXPECT_EQ(locate(read.root(), *read.root().find("")).pointer, "/");
}

TEST(Location, EscapesTildeAndSlash) {
  const JsonDocument read = document(R"({"a/b": 1, "m~n": 2, "~1": 3})");
  EXPECT_EQ(locate(read.root(), *read.root().find("a/b")).pointer, "/a~1b");
  EXPECT_EQ(locate(read.root(), *read.root().find("m~n")).pointer, "/m~0n");
  EXPECT_EQ(locate(read.root(), *read.root().find("~1")).pointer, "/~01");
}

TEST(Location, HasTheNameOfTheLastStep) {
  const JsonDocument read = document(R"({"map": [1, 2, 3]})");
  const JsonValue map = *read.root().find("map");
  EXPECT_EQ(locate(read.root(), read.root()).name, "the document");
  EXPECT_EQ(locate(read.root(), map).name, "map");
  EXPECT_EQ(locate(read.root(), map.item(2)).name, "item 2");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
