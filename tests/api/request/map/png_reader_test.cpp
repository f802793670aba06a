// PNG files that encoders do not write. PNG files of ordinary forms are in image_reader_test.cpp.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "api/request/map/image/decode_image.h"
#include "core/runtime/memory_account.h"
#include "tests/support/png_chunks.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using support::big_endian;
using support::chunk;
using support::deflated;
using support::png_header;
using support::png_of;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;

constexpr std::int64_t kMax = 1'000'000;

struct Read {
  std::vector<std::uint16_t> channels;
  std::string fault;
  bool too_large = false;
};

Read read_png(const std::string& file, core::Work& work = unbounded_work()) {
  const auto opened = open_png({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, kMax, work);
  if (!opened) return {{}, opened.failure().detail, opened.failure().too_large};
  Read read;
  for (int row = 0; row < (*opened)->header().rows; ++row) {
    const auto pixels = (*opened)->next_row();
    if (!pixels) {
      read.fault = pixels.failure();
      return read;
    }
    read.channels.insert(read.channels.end(), pixels->begin(), pixels->end());
  }
  return read;
}

/// How often the stop condition looks at the clock while the file is read.
std::size_t looks(const std::string& file) {
  auto count = std::make_shared<std::size_t>(0);
  const auto clock = [count] {
    ++*count;
    return std::chrono::nanoseconds(0);
  };
  core::Work stop({.cpu_clock = clock});
  *count = 0;
  read_png(file, stop);
  return *count;
}

/// The most memory that reading the file takes.
std::int64_t memory(const std::string& file) {
  core::MemoryAccount account(1U << 30U);
  const core::MemoryScope scope(&account);
  read_png(file);
  return account.peak();
}

std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += part;
  return text;
}

const std::string kEnd = chunk("IEND");
const std::string kTwoPixels = std::string("\0\x07\x09", 3);  // with the filter of the row

std::string two_pixels(const std::string& between = {}, const std::string& behind = {}) {
  return png_of({png_header(2, 1), between, chunk("IDAT", deflated(kTwoPixels)), behind, kEnd});
}

const auto kPixels = ElementsAre(7 * 257, 9 * 257);

TEST(PngReader, RejectsAFileWhoseFirstChunkIsNotTheHeader) {
  for (const std::uint32_t columns : {1U, 2000U}) {
    const std::string sizes = chunk("abCd", big_endian(columns) + big_endian(1) + std::string(1000, '\0'));
    for (const std::uint32_t real : {1U, 2000U}) {
      const std::string pixels(real + 1, '\0');
      const Read read = read_png(png_of({sizes, png_header(real, 1), chunk("IDAT", deflated(pixels)), kEnd}));
      EXPECT_THAT(read.fault, HasSubstr("Its first chunk is not the header, IHDR"));
      EXPECT_THAT(read.fault, HasSubstr("Save it as PNG again"));
    }
  }
}

TEST(PngReader, RejectsASecondHeaderAndOneOfAnotherLength) {
  EXPECT_THAT(read_png(two_pixels(png_header(200, 1))).fault, HasSubstr("IHDR"));
  const std::string sizes = big_endian(2) + big_endian(1) + std::string("\x08\0\0\0\0\0", 6);
  EXPECT_THAT(read_png(png_of({chunk("IHDR", sizes), chunk("IDAT", deflated(kTwoPixels)), kEnd})).fault,
              HasSubstr("It is damaged: "));
}

TEST(PngReader, RejectsATooLargeImageBeforeItTakesMemoryForARow) {
  const std::string large = png_of({png_header(1'000'000, 1000, 16, 6), chunk("IDAT", deflated("")), kEnd});
  EXPECT_TRUE(read_png(large).too_large);
  EXPECT_THAT(read_png(large).fault, HasSubstr("1000000 x 1000 = 1000000000 pixels"));
  EXPECT_THAT(memory(large), Lt(256 * 1024));
  const Read wide = read_png(png_of({png_header(1'000'001, 1), chunk("IDAT"), kEnd}));
  EXPECT_TRUE(wide.too_large);
  EXPECT_THAT(wide.fault, HasSubstr("at most 1000000 pixels wide and high"));
}

TEST(PngReader, CountsTheMemoryOfTheLibraryOnTheAccountOfTheJob) {
  const std::string wide = png_of({png_header(500'000, 1, 16, 6), chunk("IDAT", deflated("")), kEnd});
  EXPECT_THAT(memory(wide), Gt(2 * 4'000'000));  // two rows of the library, beside the reader's
  core::MemoryAccount account(2'000'000);
  const core::MemoryScope scope(&account);
  EXPECT_THROW(read_png(wide), std::bad_alloc);
}

TEST(PngReader, SkipsTextsProfilesAndUnknownChunksWithoutDecompressingThem) {
  const std::string bomb = deflated(std::string(900'000, '\0'));
  const std::string text = chunk("zTXt", std::string("a\0\0", 3) + bomb);
  const std::string international = chunk("iTXt", std::string("a\0\1\0\0\0", 6) + bomb);
  const std::string profile = chunk("iCCP", std::string("a\0\0", 3) + bomb);
  const std::string palette = chunk("sPLT", std::string("a\0\x08", 3) + std::string(600'000, '\0'));
  const std::string all =
      repeated(text + international, 300) + profile + palette + chunk("abCd", std::string(1000, '\0'));
  const Read read = read_png(two_pixels(all));
  EXPECT_THAT(read.fault, IsEmpty());
  EXPECT_THAT(read.channels, kPixels);
  EXPECT_THAT(memory(two_pixels(all)), Lt(256 * 1024));
}

TEST(PngReader, AsksTheStopConditionByTheBytesOfSkippedAndEmptyChunks) {
  for (const std::string& each : {chunk("tEXt"), chunk("IDAT"), chunk("tEXt", std::string(1 << 20, 'a'))}) {
    const std::string between = repeated(each, (5U << 20U) / each.size());
    EXPECT_THAT(read_png(two_pixels(between)).channels, kPixels);
    EXPECT_THAT(looks(two_pixels(between)), Gt(between.size() / core::Work::kStride / 2));
  }
}

TEST(PngReader, AsksTheStopConditionWhileCompressedDataYieldNoPixels) {
  const std::string compressed = deflated(kTwoPixels);
  const std::string empty = repeated(std::string("\0\0\0\xff\xff", 5), 1000);  // blocks of no bytes
  const std::string in_many =
      png_of({png_header(2, 1), chunk("IDAT", compressed.substr(0, 2)), repeated(chunk("IDAT", empty), 1000),
              chunk("IDAT", compressed.substr(2)), kEnd});
  EXPECT_THAT(read_png(in_many).channels, kPixels);
  EXPECT_THAT(looks(in_many), Gt(in_many.size() / core::Work::kStride / 2));
}

TEST(PngReader, AsksTheStopConditionInEveryPassOfAnInterlacedImage) {
  const std::size_t side = 1000;
  const std::string pixels(side * side + 4 * side, '\0');
  const std::string file = png_of({png_header(side, side, 8, 0, 1), chunk("IDAT", deflated(pixels)), kEnd});
  EXPECT_THAT(read_png(file).fault, IsEmpty());
  EXPECT_THAT(looks(file), Gt(6 * side * side / core::Work::kStride));
}

TEST(PngReader, EndsWhenItIsStopped) {
  std::stop_source source;
  source.request_stop();
  core::Work stop({.stop = source.get_token()});
  const Read read = read_png(two_pixels(chunk("tEXt", std::string(1 << 20, 'a'))), stop);
  EXPECT_THAT(read.fault, HasSubstr("stopped"));
}

TEST(PngReader, ReadsNothingBehindTheLastPixel) {
  const std::string more(10 * core::Work::kStride, 'a');
  const std::string behind = two_pixels("", chunk("zTXt", more));
  EXPECT_THAT(read_png(behind).channels, kPixels);
  EXPECT_EQ(looks(behind), 0U);
  std::string cut = png_of({png_header(2, 1), chunk("IDAT", deflated(kTwoPixels) + more)});
  cut.resize(cut.size() - core::Work::kStride);
  EXPECT_THAT(read_png(cut).fault, IsEmpty());
  EXPECT_THAT(read_png(cut).channels, kPixels);
  EXPECT_EQ(looks(cut), 0U);
}

TEST(PngReader, DecompressesNoMoreThanABlockBehindTheLastPixel) {
  const std::string zeros(64U << 20U, '\0');
  const std::string in_passes("\0\x07\0\x09", 4);
  for (const int interlace : {0, 1}) {
    const std::string bomb = deflated((interlace == 0 ? kTwoPixels : in_passes) + zeros);
    std::string file = png_of({png_header(2, 1, 8, 0, interlace), chunk("IDAT", bomb)});
    file.resize(2048);  // what follows is not there
    EXPECT_THAT(read_png(file).fault, IsEmpty());
    EXPECT_THAT(read_png(file).channels, kPixels);
  }
}

TEST(PngReader, ChecksTheSumsOfPixelsThatEndInAChunkOfTheirOwn) {
  const std::string compressed = deflated(kTwoPixels);
  const std::size_t sum_at = compressed.size() - 4;
  std::string file = png_of({png_header(2, 1), chunk("IDAT", compressed.substr(0, sum_at)),
                             chunk("IDAT", compressed.substr(sum_at))});
  EXPECT_THAT(read_png(file).channels, kPixels);
  file.back() ^= 1;
  EXPECT_THAT(read_png(file).fault, HasSubstr("CRC error"));
}

TEST(PngReader, RejectsAnUnknownChunkThatIsCritical) {
  EXPECT_THAT(read_png(two_pixels(chunk("ABCD", "x"))).fault, HasSubstr("ABCD"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
