// Expected occupancies are computed by hand from the formulas of map_server.

#include "api/request/map/image/decode_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/base64.h"

namespace fleetplan::api {

namespace TEST_FILE {

using testing::HasSubstr;

std::string decoded(std::string_view text) {
  core::Work stop = core::Work::unbounded();
  const auto bytes = decode_base64(text, stop);
  return bytes ? std::string(bytes->begin(), bytes->end()) : "fault: " + bytes.failure();
}

TEST(Base64, IsDecodedWithEveryPadding) {  // the vectors of RFC 4648
  EXPECT_EQ(decoded(""), "");
  EXPECT_EQ(decoded("Zg=="), "f");
  EXPECT_EQ(decoded("Zm8="), "fo");
  EXPECT_EQ(decoded("Zm9v"), "foo");
  EXPECT_EQ(decoded("Zm9vYg=="), "foob");
  EXPECT_EQ(decoded("Zm9vYmE="), "fooba");
  EXPECT_EQ(decoded("Zm9vYmFy"), "foobar");
}

TEST(Base64, OfAllBytesIsReadBack) {
  std::string bytes;
  for (int round = 0; round < 300; ++round) {
    for (int byte = 0; byte < 256; ++byte) bytes += static_cast<char>(byte);
    bytes += 'x';  // shifts the next round
  }
  EXPECT_EQ(decoded(support::base64(bytes)), bytes);
}

TEST(Base64, OfAnotherFormIsAFault) {
  EXPECT_THAT(decoded("Zm9vYg"), HasSubstr("has 6 characters of base64, not a multiple of 4"));
  EXPECT_THAT(decoded("Zm9v\nYg="), HasSubstr("white space at character 5; write base64 on one line"));
  EXPECT_THAT(decoded("data:image/png;base64,Zm9v"),
              HasSubstr("leave out its prefix \"data:image/png;base64,\""));
  EXPECT_THAT(decoded("data:" + std::string(100, 'x')),
              HasSubstr("leave out its prefix and give the base64"));
  EXPECT_THAT(decoded("Zg==Zm9v"), HasSubstr("padding at character 3, before its end"));
  EXPECT_THAT(decoded("Z==="), HasSubstr("padding at character 2"));
  EXPECT_THAT(decoded("===="), HasSubstr("padding at character 1"));
  EXPECT_THAT(decoded("Zm-_"), HasSubstr("is base64url at character 3"));
  EXPECT_THAT(decoded("Zm9v(a=="), HasSubstr("has \"(\" at character 5, which is not of base64"));
  EXPECT_THAT(decoded("Zm9v\xc3\xa9=="), HasSubstr("has a character at character 5"));
  EXPECT_THAT(decoded("Zh=="), HasSubstr("bits after its last byte"));
  EXPECT_THAT(decoded("Zm9="), HasSubstr("bits after its last byte"));
}

TEST(Base64, IsDecodedNoFurtherWhenStopped) {
  std::stop_source source;
  source.request_stop();
  core::Work stop({.stop = source.get_token()});
  const std::string text(4 * core::Work::kStride, 'A');
  EXPECT_TRUE(decode_base64(text, stop));
  EXPECT_TRUE(stop.met());
}

using testing::ElementsAre;

constexpr int kUnknown = kUnknownOccupancy;

/// The occupancy of grays of 0 to `largest`.
std::vector<int> of_grays(const ShadeRule& rule, const std::vector<int>& grays, int largest = 255) {
  const OccupancyOfPixels occupancy(rule, {static_cast<int>(grays.size()), 1, 1, largest});
  std::vector<int> found;
  for (const int gray : grays) {
    const std::uint16_t channel[] = {static_cast<std::uint16_t>(gray)};
    found.push_back(occupancy.of(channel));
  }
  return found;
}

/// The occupancy of one pixel of 8-bit channels, as a PNG has them.
int of_pixel(const ShadeRule& rule, const std::vector<int>& channels) {
  const OccupancyOfPixels occupancy(rule, {1, 1, static_cast<int>(channels.size()), 65535});
  std::vector<std::uint16_t> wide;
  for (const int channel : channels) wide.push_back(static_cast<std::uint16_t>(257 * channel));
  return occupancy.of(wide);
}

ShadeRule with_humble(ShadeRule rule = {}) {
  rule.release = Release::humble;
  return rule;
}

TEST(ShadeRule, TrinaryHasFreeOccupiedAndUnknown) {
  // 1 - gray / 255 against 0.65 and 0.196: 89 gives 0.651, 90 gives 0.647; 205 gives 0.1961, 206 gives 0.192
  for (const ShadeRule& rule : {ShadeRule{}, with_humble()}) {
    EXPECT_THAT(of_grays(rule, {0, 89, 90, 205, 206, 255}), ElementsAre(100, 100, kUnknown, kUnknown, 0, 0));
  }
}

TEST(ShadeRule, NegateMakesWhiteOccupied) {
  // gray / 255: 49 gives 0.192, 50 gives 0.1961; 165 gives 0.647, 166 gives 0.651
  const ShadeRule rule{ShadeMode::trinary, true, 0.65, 0.196};
  EXPECT_THAT(of_grays(rule, {0, 49, 50, 165, 166, 255}), ElementsAre(0, 0, kUnknown, kUnknown, 100, 100));
}

TEST(ShadeRule, ThresholdsThemselvesAreOccupiedAndFree) {
  const ShadeRule rule{ShadeMode::trinary, false, 1.0, 0.0};
  EXPECT_THAT(of_grays(rule, {255, 0, 128}), ElementsAre(0, 100, kUnknown));
  EXPECT_THAT(of_grays(with_humble(rule), {255, 0, 128}), ElementsAre(kUnknown, kUnknown, kUnknown));
  const ShadeRule equal{ShadeMode::scale, false, 1.0, 1.0};  // what is both is free
  EXPECT_THAT(of_grays(equal, {0, 1}), ElementsAre(0, 0));
}

TEST(ShadeRule, RoundsAsMapServer) {
  // 1 - 204 / 255 in single precision is 0.19999999, below 0.2 in single precision
  EXPECT_THAT(of_grays({ShadeMode::trinary, false, 0.2, 0.1}, {204}), ElementsAre(kUnknown));
  EXPECT_THAT(of_grays({ShadeMode::trinary, false, 0.65, 0.2}, {204}), ElementsAre(0));
  EXPECT_THAT(of_grays(with_humble({ShadeMode::trinary, false, 0.65, 0.2}), {204}), ElementsAre(0));
}

TEST(ShadeRule, ScaleHasPercentBetweenTheThresholds) {
  const ShadeRule rule{ShadeMode::scale, false, 1.0, 0.0};
  // 100 x (1 - gray / 255), rounded: 191 gives 25.1, 128 gives 49.8, 254 gives 0.4
  EXPECT_THAT(of_grays(rule, {0, 128, 191, 254, 255}), ElementsAre(100, 50, 25, 0, 0));
  // (1 - gray / 255 - 0.2) / 0.4 x 100: gray 102 is 0.6, 153 is 0.4, 178 is 0.302, 204 is 0.2
  EXPECT_THAT(of_grays({ShadeMode::scale, false, 0.6, 0.2}, {101, 103, 153, 178, 204, 255}),
              ElementsAre(100, 99, 50, 25, 0, 0));
  const ShadeRule old{ShadeMode::scale, false, 0.9, 0.1};
  EXPECT_THAT(of_grays(with_humble(old), {0, 9, 11, 50, 70, 89, 91, 100}, 100),
              ElementsAre(100, 100, 99, 50, 25, 1, 0, 0));
}

TEST(ShadeRule, ScaleOfHumbleWithoutARangeBetweenTheThresholdsIsUnknownThere) {
  EXPECT_THAT(of_grays(with_humble({ShadeMode::scale, false, 0.5, 0.5}), {1, 2, 3}, 4),
              ElementsAre(100, kUnknown, 0));
}

TEST(ShadeRule, RawHasTheGrayAsPercentWhateverTheThresholds) {
  const ShadeRule rule{ShadeMode::raw, true, 0.65, 0.196};
  EXPECT_THAT(of_grays(rule, {0, 25, 65, 100, 101, 255}), ElementsAre(0, 25, 65, 100, kUnknown, kUnknown));
  // Of 16 bits the upper 8: 255 of 65535 is 0, and 25956 is 100. Humble rounds.
  EXPECT_THAT(of_grays(rule, {255, 257, 25956, 25957}, 65535), ElementsAre(0, 1, 100, kUnknown));
  EXPECT_THAT(of_grays(with_humble(rule), {255, 25700, 25957}, 65535), ElementsAre(1, 100, kUnknown));
}

TEST(ShadeRule, ColoursCountByTheirLuminance) {
  const ShadeRule raw{ShadeMode::raw};
  // 0.299 red + 0.587 green + 0.114 blue in 16 bits, rounded, of which the upper 8 bits are taken
  EXPECT_EQ(of_pixel(raw, {255, 0, 0}), 76);         // 76.245
  EXPECT_EQ(of_pixel(raw, {0, 0, 255}), 29);         // 29.07
  EXPECT_EQ(of_pixel(raw, {118, 100, 3}), 94);       // 94.324
  EXPECT_EQ(of_pixel(raw, {117, 72, 68}), 85);       // 84.999, which the 16 bits round up
  EXPECT_EQ(of_pixel(raw, {163, 99, 0}), kUnknown);  // 106.85
  EXPECT_EQ(of_pixel({}, {0, 255, 0}), kUnknown);    // 149.685: 1 - 149 / 255 = 0.416
  EXPECT_EQ(of_pixel({}, {255, 255, 0}), 0);         // 225.93
}

TEST(ShadeRule, ColoursOfHumbleCountByTheirMean) {
  EXPECT_EQ(of_pixel(with_humble(), {0, 0, 255}), 100);        // 1 - 85 / 255 = 0.667
  EXPECT_EQ(of_pixel(with_humble(), {0, 30, 255}), kUnknown);  // 1 - 95 / 255 = 0.627
  EXPECT_EQ(of_pixel(with_humble(), {200, 210, 255}), 0);      // 1 - 221.7 / 255 = 0.131
  EXPECT_EQ(of_pixel(with_humble({ShadeMode::raw}), {10, 20, 33}), 21);
}

TEST(ShadeRule, AlphaOfHumbleIsAFourthColourInTrinary) {
  EXPECT_EQ(of_pixel(with_humble(), {0, 0, 0, 0}), 100);
  EXPECT_EQ(of_pixel(with_humble(), {0, 0, 0, 255}), 100);          // 1 - 63.75 / 255 = 0.75
  EXPECT_EQ(of_pixel(with_humble(), {40, 40, 40, 255}), kUnknown);  // 1 - 93.75 / 255 = 0.632
  EXPECT_EQ(of_pixel(with_humble(), {40, 255}), kUnknown);          // the same as gray and alpha
  EXPECT_EQ(of_pixel(with_humble(), {255, 0}), kUnknown);           // 1 - 191.25 / 255 = 0.25
}

TEST(ShadeRule, PixelsThatAreNotOpaqueAreUnknownInEveryMode) {
  for (const ShadeMode mode : {ShadeMode::trinary, ShadeMode::scale, ShadeMode::raw}) {
    const ShadeRule rule{mode, false, 0.65, 0.196};
    EXPECT_EQ(of_pixel(rule, {0, 0, 0, 254}), kUnknown);
    EXPECT_EQ(of_pixel(rule, {0, 0}), kUnknown);
    EXPECT_NE(of_pixel(rule, {0, 0, 0, 255}), kUnknown);
    EXPECT_NE(of_pixel(rule, {0, 255}), kUnknown);
  }
  const ShadeRule old = with_humble({ShadeMode::scale, false, 0.65, 0.196});
  EXPECT_EQ(of_pixel(old, {0, 0, 0, 254}), kUnknown);
  EXPECT_EQ(of_pixel(old, {0, 0, 0, 255}), 100);
  EXPECT_EQ(of_pixel(with_humble({ShadeMode::raw}), {42, 0}), 42);
}

/// The gray 205, with which map_saver writes unknown cells, is unknown whatever the form of the image.
TEST(ShadeRule, UnknownGrayIsUnknownInEveryForm) {
  EXPECT_THAT(of_grays({}, {205}), ElementsAre(kUnknown));
  EXPECT_EQ(of_pixel({}, {205, 205, 205}), kUnknown);
  EXPECT_EQ(of_pixel({}, {205, 255}), kUnknown);
  EXPECT_EQ(of_pixel({}, {205, 205, 205, 255}), kUnknown);
  EXPECT_EQ(of_pixel(with_humble(), {205, 205, 205, 255}), 0);
}

TEST(ShadeRule, OfAllGraysIsTheSameWithAndWithoutATable) {
  for (const ShadeMode mode : {ShadeMode::trinary, ShadeMode::scale, ShadeMode::raw}) {
    const ShadeRule rule{mode, false, 0.65, 0.196};
    const OccupancyOfPixels with(rule, {16, 16, 1, 255});  // 256 pixels
    const OccupancyOfPixels without(rule, {15, 17, 1, 255});
    for (std::uint16_t gray = 0; gray < 256; ++gray) {
      const std::uint16_t channel[] = {gray};
      EXPECT_EQ(with.of(channel), without.of(channel)) << gray;
    }
  }
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
