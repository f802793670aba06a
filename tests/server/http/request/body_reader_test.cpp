#include "server/http/request/body_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

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

constexpr std::uint64_t kMegabyte = 1 << 20;

TEST(BodyMemory, IsGrantedUntilExhaustedAndAgainWhenARequestEnds) {
  BodyMemory memory(kMegabyte, 3, 1);
  BodyMemory::Share first(memory);
  EXPECT_TRUE(first.grow_to(3 * kMegabyte));
  {
    BodyMemory::Share second(memory);
    EXPECT_TRUE(second.grow_to(kMegabyte));
    EXPECT_FALSE(second.grow_to(kMegabyte + 1));
    EXPECT_FALSE(first.grow_to(4 * kMegabyte));
  }
  EXPECT_TRUE(first.grow_to(4 * kMegabyte));
}

TEST(BodyMemory, IsAlwaysAvailableForASmallBody) {
  BodyMemory memory(0, 1, 1);
  BodyMemory::Share share(memory);
  EXPECT_TRUE(share.grow_to(BodyMemory::kSmall));
  EXPECT_FALSE(share.grow_to(BodyMemory::kSmall + 1));
}

TEST(BodyMemory, OfSmallBodiesIsApartAndBoundedToo) {
  BodyMemory memory(kMegabyte, 1, 2);
  BodyMemory::Share large(memory);
  EXPECT_TRUE(large.grow_to(2 * kMegabyte));
  BodyMemory::Share first(memory);
  EXPECT_TRUE(first.grow_to(BodyMemory::kSmall));
  {
    BodyMemory::Share second(memory);
    EXPECT_TRUE(second.grow_to(1));
    EXPECT_TRUE(second.grow_to(BodyMemory::kSmall));
    BodyMemory::Share third(memory);
    EXPECT_FALSE(third.grow_to(1));
  }
  BodyMemory::Share fourth(memory);
  EXPECT_TRUE(fourth.grow_to(BodyMemory::kSmall));
}

TEST(BodyMemory, SufficesForTheLargestBodyAsSentAndDecoded) {
  for (const std::uint64_t size : {std::uint64_t{1}, 2 * BodyMemory::kSmall, kMegabyte + 1}) {
    BodyMemory memory(size, 1, 1);
    BodyMemory::Share share(memory);
    EXPECT_TRUE(share.grow_to(size)) << size;
    EXPECT_TRUE(share.grow_to(2 * size)) << size;
  }
}

TEST(BodyMemory, IsNotReducedByRejectedRequests) {
  BodyMemory memory(kMegabyte, 1, 1);
  const std::jthread greedy([&memory](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      BodyMemory::Share share(memory);
      EXPECT_FALSE(share.grow_to(3 * kMegabyte));
    }
  });
  for (int i = 0; i < 100'000; ++i) {
    BodyMemory::Share share(memory);
    ASSERT_TRUE(share.grow_to(2 * kMegabyte));
  }
}

TEST(BodyMemory, CountsCorrectlyAcrossThreads) {
  BodyMemory memory(2 * kMegabyte, 3, 1);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) {
        BodyMemory::Share share(memory);
        for (std::uint64_t size = 1; size <= 4; ++size) {
          if (!share.grow_to(size * kMegabyte)) break;
        }
      }
    });
  }
  for (auto& thread : threads) thread.join();
  BodyMemory::Share all(memory);
  EXPECT_TRUE(all.grow_to(8 * kMegabyte));
  EXPECT_FALSE(all.grow_to(8 * kMegabyte + 1));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
