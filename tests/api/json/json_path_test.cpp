#include "api/json/json_path.h"

#include <gtest/gtest.h>

namespace fleetplan::api {
namespace {

TEST(JsonPath, BecomesAJsonPointer) {
  const JsonPath root;
  const JsonPath robots = root / "robots";
  const JsonPath robot = robots / std::size_t{3};
  EXPECT_EQ(root.pointer(), "");
  EXPECT_EQ(robots.pointer(), "/robots");
  EXPECT_EQ((robot / "goal").pointer(), "/robots/3/goal");
  EXPECT_EQ((root / "").pointer(), "/");
}

TEST(JsonPath, EscapesTildeAndSlash) {
  const JsonPath root;
  EXPECT_EQ((root / "a/b").pointer(), "/a~1b");
  EXPECT_EQ((root / "m~n").pointer(), "/m~0n");
  EXPECT_EQ((root / "~1").pointer(), "/~01");
}

TEST(JsonPath, NamesItsLastStep) {
  const JsonPath root;
  EXPECT_EQ(root.name(), "the document");
  EXPECT_EQ((root / "map").name(), "map");
  EXPECT_EQ((root / std::size_t{2}).name(), "item 2");
}

}  // namespace
}  // namespace fleetplan::api
