#include "api/request/map/image/base64.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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

}  // namespace TEST_FILE
}  // namespace fleetplan::api
