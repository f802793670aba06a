#include "server/http/guard/chunk_line.h"

#include <gtest/gtest.h>

#include <string>

namespace fleetplan::server {
namespace TEST_FILE {

TEST(ChunkLine, IsASizeWithExtensions) {
  for (const char* line :
       {"1f", "1F", "01f", "1f;a", "1f;a=b", "1f ;\ta = \"c\"", "1f;a=\"x;\\\"y\\\\\";b;c=d", "1f;a=\"\""}) {
    const auto chunk = parse_chunk_line(line);
    ASSERT_TRUE(chunk) << line;
    EXPECT_EQ(chunk->size, 31U) << line;
  }
  EXPECT_EQ(parse_chunk_line("FFFFFFFFFFFFFFFF")->size, ~std::uint64_t{0});
  EXPECT_EQ(parse_chunk_line("0;ext=1")->extension_bytes, 6U);
}

TEST(ChunkLine, RejectsAnythingElse) {
  for (const char* line : {"",
                           " 1",
                           "1 ",
                           "1\t",
                           "0x1",
                           "-1",
                           "+1",
                           "1g",
                           "1 x",
                           "1;",
                           "1;;a",
                           "1; ",
                           "1;a=",
                           "1;a=b c",
                           "1;a=\"b",
                           "1;a=\"b\"c",
                           "1;a=\"\\",
                           "1;a\r",
                           "1;a=\"\r\"",
                           "1,a",
                           "1;a@b",
                           "10000000000000000",
                           "00000000000000001"}) {
    EXPECT_FALSE(parse_chunk_line(line)) << line;
  }
  EXPECT_FALSE(parse_chunk_line(std::string_view("1;a\0", 4)));
  EXPECT_FALSE(parse_chunk_line(std::string_view("1\0", 2)));
  EXPECT_FALSE(parse_chunk_line(std::string_view("1;a=\"\0\"", 7)));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
