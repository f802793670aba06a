#include "api/json/location.h"

#include <gtest/gtest.h>

#include "api/json/read_json.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

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
