#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/request/map/image/decode_image.h"
#include "tests/api/support/images.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kMax = 1000;

/// The channels of all pixels of an image, or why it cannot be read.
struct Read {
  ImageHeader header;
  std::vector<std::uint16_t> channels;
  std::string fault;
  bool too_large = false;
};

Read read_all(const OpenedImage& opened) {
  if (!opened) return {{}, {}, opened.failure().detail, opened.failure().too_large};
  Read read{(*opened)->header(), {}, "", false};
  for (int row = 0; row < read.header.rows; ++row) {
    const auto pixels = (*opened)->next_row();
    if (!pixels) {
      read.fault = pixels.failure();
      return read;
    }
    read.channels.insert(read.channels.end(), pixels->begin(), pixels->end());
  }
  return read;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Read read_pgm(const std::string& text) { return read_all(open_pgm(bytes_of(text), kMax)); }

Read read_png(const std::string& text) {
  core::Work stop = core::Work::unbounded();
  return read_all(open_png(bytes_of(text), kMax, stop));
}

TEST(Pgm, PlainHasAnyWhiteSpaceAndComments) {
  const Read read = read_pgm("P2 # gray\r\n# by hand\r\n3\t2 #size\n15 0 1 2 # top\n3 14 15");
  EXPECT_THAT(read.fault, IsEmpty());
  EXPECT_EQ(read.header.columns, 3);
  EXPECT_EQ(read.header.rows, 2);
  EXPECT_EQ(read.header.largest, 15);
  EXPECT_THAT(read.channels, ElementsAre(0, 1, 2, 3, 14, 15));
}

TEST(Pgm, RawHasOneByteForEachPixel) {
  EXPECT_THAT(read_pgm("P5\n# CREATOR: GIMP 2.10\n2 1\n255\n\x0a\xff").channels, ElementsAre(10, 255));
  EXPECT_THAT(read_pgm("P5 4 1 255\n\x0a# \r").channels, ElementsAre(10, 35, 32, 13));
}

TEST(Pgm, RawOfMoreThan255GraysHasTwoBytesTheHighOneFirst) {
  EXPECT_THAT(read_pgm("P5 2 1 65535\n\x01\x02\xff\xff").channels, ElementsAre(258, 65535));
  EXPECT_THAT(read_pgm(std::string("P5 1 1 256\n\x01\x00", 13)).channels, ElementsAre(256));
}

TEST(Pgm, HeaderMayEndInCarriageReturnAndLineFeed) {
  EXPECT_THAT(read_pgm("P5\r\n2 1\r\n255\r\n\x07\x08").channels, ElementsAre(7, 8));
  EXPECT_THAT(read_pgm("P5 2 1 255\r\x0a\x08").channels, ElementsAre(10, 8));
}

TEST(Pgm, ThatIsDamagedIsAFault) {
  EXPECT_THAT(read_pgm("").fault, HasSubstr("does not begin as a PGM"));
  EXPECT_THAT(read_pgm("GIF89a").fault, HasSubstr("does not begin as a PGM"));
  EXPECT_THAT(read_pgm("P6 1 1 255\n123").fault, HasSubstr("of the kind P6, not a graymap"));
  EXPECT_THAT(read_pgm("P5").fault, HasSubstr("no width from 1"));
  EXPECT_THAT(read_pgm("P5 2").fault, HasSubstr("no height from 1"));
  EXPECT_THAT(read_pgm("P5 0 2 255\n").fault, HasSubstr("no width from 1"));
  EXPECT_THAT(read_pgm("P5 1 1 65536\n\x01\x01").fault, HasSubstr("no largest gray from 1 to 65535"));
  EXPECT_THAT(read_pgm("P5 1 1 255").fault, HasSubstr("need 1 bytes, but 0 follow"));
  EXPECT_THAT(read_pgm("P5 2 2 255\n\x01\x02\x03").fault, HasSubstr("need 4 bytes, but 3 follow"));
  EXPECT_THAT(read_pgm("P5 2 1 7\n\x07\x08").fault, HasSubstr("Pixel 1 of row 0 (from 0) is 8, above"));
  EXPECT_THAT(read_pgm("P2 2 2 255 1 2 3").fault, HasSubstr("truncated"));
  EXPECT_THAT(read_pgm("P2 2 1 255 1 x 3").fault,
              HasSubstr("1 of its 2 pixels are followed by something else"));
  EXPECT_THAT(read_pgm("P2 2 1 255 1 99999999999999999999").fault, HasSubstr("above the largest gray 255"));
}

TEST(Pgm, WithTooManyPixelsIsRejectedByItsHeader) {
  const Read read = read_pgm("P5 100000 100000 255\n");
  EXPECT_TRUE(read.too_large);
  EXPECT_THAT(read.fault,
              HasSubstr("100000 x 100000 = 10000000000 pixels; this service accepts at most 1000"));
  EXPECT_THAT(read_pgm("P5 99999999999999999999 1 255\n").fault, HasSubstr("at most 1000000 pixels wide"));
  EXPECT_EQ(read_pgm(pgm(Samples(20, std::vector<std::uint8_t>(50)))).channels.size(), 1000U);
}

TEST(Png, OfGraysIsReadWithAnyDepth) {
  EXPECT_THAT(read_png(png(2, {{0, 255}, {7, 100}})).channels, ElementsAre(0, 65535, 7 * 257, 100 * 257));
  EXPECT_THAT(read_png(png(3, {{0xA0}}, {PNG_COLOR_TYPE_GRAY, 1})).channels, ElementsAre(65535, 0, 65535));
  EXPECT_THAT(read_png(png(3, {{0x6C}}, {PNG_COLOR_TYPE_GRAY, 2})).channels,
              ElementsAre(21845, 43690, 65535));
  EXPECT_THAT(read_png(png(2, {{1, 2, 255, 255}}, {PNG_COLOR_TYPE_GRAY, 16})).channels,
              ElementsAre(258, 65535));
}

TEST(Png, OfColoursHasThreeChannels) {
  const Read read = read_png(png(1, {{1, 2, 3}}, {PNG_COLOR_TYPE_RGB}));
  EXPECT_EQ(read.header.channels, 3);
  EXPECT_FALSE(read.header.has_alpha());
  EXPECT_THAT(read.channels, ElementsAre(257, 514, 771));
}

TEST(Png, OfAPaletteHasItsColours) {
  PngForm form{PNG_COLOR_TYPE_PALETTE};
  form.palette = {{10, 20, 30}, {1, 1, 1}};
  const Read read = read_png(png(2, {{1, 0}}, form));
  EXPECT_THAT(read.channels, ElementsAre(257, 257, 257, 2570, 5140, 7710));
  form.palette_alpha = {0, 255};
  EXPECT_THAT(read_png(png(2, {{1, 0}}, form)).channels,
              ElementsAre(257, 257, 257, 65535, 2570, 5140, 7710, 0));
}

TEST(Png, WithTransparencyHasAnAlphaChannel) {
  EXPECT_TRUE(read_png(png(1, {{5, 128}}, {PNG_COLOR_TYPE_GRAY_ALPHA})).header.has_alpha());
  EXPECT_THAT(read_png(png(1, {{5, 128}}, {PNG_COLOR_TYPE_GRAY_ALPHA})).channels,
              ElementsAre(1285, 128 * 257));
  EXPECT_EQ(read_png(png(1, {{1, 2, 3, 4}}, {PNG_COLOR_TYPE_RGB_ALPHA})).header.channels, 4);
  PngForm clear;
  clear.transparent_gray = 5;
  EXPECT_THAT(read_png(png(2, {{5, 6}}, clear)).channels, ElementsAre(1285, 0, 1542, 65535));
}

TEST(Png, InterlacedHasTheSamePixels) {
  Samples rows;
  for (int row = 0; row < 11; ++row) {
    rows.emplace_back();
    for (int column = 0; column < 13; ++column)
      rows.back().push_back(static_cast<std::uint8_t>(20 * row + column));
  }
  const Read plain = read_png(png(13, rows));
  const Read interlaced = read_png(png(13, rows, {PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_ADAM7}));
  EXPECT_THAT(interlaced.fault, IsEmpty());
  EXPECT_EQ(interlaced.channels, plain.channels);
  EXPECT_EQ(plain.channels[13 * 10 + 12], 212 * 257);
}

TEST(Png, ThatIsDamagedIsAFault) {
  const std::string whole = png(4, Samples(4, {1, 2, 3, 4}));
  EXPECT_THAT(read_png("P5 1 1 255\n\x01").fault, HasSubstr("does not begin as a PNG"));
  const std::size_t end_of_pixels = whole.size() - 12;  // the chunk IEND is not read
  EXPECT_THAT(read_png(whole.substr(0, 20)).fault, HasSubstr("the file ends too early"));
  EXPECT_THAT(read_png(whole.substr(0, end_of_pixels)).fault, IsEmpty());
  for (std::size_t length = 8; length < end_of_pixels; ++length) {
    EXPECT_THAT(read_png(whole.substr(0, length)).fault, HasSubstr("It is damaged")) << length;
  }
  for (std::size_t at = 8; at < end_of_pixels; ++at) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    EXPECT_FALSE(read_png(flipped).fault.empty()) << at;
  }
}

TEST(Png, WithTooManyPixelsIsRejectedByItsHeader) {
  const Read read = read_png(png(65537, {std::vector<std::uint8_t>(65537)}));
  EXPECT_TRUE(read.too_large);
  EXPECT_THAT(read.fault, HasSubstr("65537 x 1 = 65537 pixels; this service accepts at most 1000"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
