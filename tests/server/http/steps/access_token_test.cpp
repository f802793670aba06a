#include "server/http/steps/access_token.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_file.h"

namespace fleetplan::server {
namespace TEST_FILE {

using support::TemporaryFile;

constexpr const char* kToken = "s3cret/token+of~the-house==";

AccessToken token() { return std::get<AccessToken>(AccessToken::from_text(kToken)); }

std::string fault_of(const std::string& path) {
  const auto read = AccessToken::from_file(path);
  return std::holds_alternative<std::string>(read) ? std::get<std::string>(read) : "";
}

TEST(AccessToken, IsAcceptedAsBearer) {
  const AccessToken known = token();
  EXPECT_TRUE(known.admits(std::string("Bearer ") + kToken));
  EXPECT_TRUE(known.admits(std::string("bearer   ") + kToken));
  for (const std::string& wrong :
       {std::string(), std::string("Bearer"), std::string("Bearer "), std::string(kToken),
        std::string("Bearer ") + kToken + "x", std::string("Bearer ") + std::string(kToken).substr(1),
        std::string("Bearer ") + kToken + kToken, std::string("Token ") + kToken,
        std::string("Bearer S3cret/token+of~the-house==")}) {
    EXPECT_FALSE(known.admits(wrong)) << wrong;
  }
}

TEST(AccessToken, IsAcceptedAsThePasswordOfBasic) {
  const AccessToken known = std::get<AccessToken>(AccessToken::from_text("pass:word-of-sixteen"));
  EXPECT_TRUE(known.admits("Basic YW55b25lOnBhc3M6d29yZC1vZi1zaXh0ZWVu"));   // anyone:pass:word-of-sixteen
  EXPECT_TRUE(known.admits("basic OnBhc3M6d29yZC1vZi1zaXh0ZWVu"));           // :pass:word-of-sixteen
  EXPECT_FALSE(known.admits("Basic YW55b25lOnBhc3M6d29yZC1vZi1zaXh0ZWU="));  // without its last letter
  EXPECT_FALSE(known.admits("Basic cGFzczp3b3JkLW9mLXNpeHRlZW4="));          // pass:word-of-sixteen, no user
  EXPECT_FALSE(known.admits("Basic YW55b25l"));                              // no colon
  EXPECT_FALSE(known.admits("Basic ***"));
}

TEST(AccessToken, IsReadFromTheLineOfAFile) {
  const TemporaryFile unix_lines(std::string(kToken) + "\n");
  const TemporaryFile other_lines(std::string(kToken) + "\r\n");
  for (const auto* file : {&unix_lines, &other_lines}) {
    const auto read = AccessToken::from_file(file->path());
    ASSERT_TRUE(std::holds_alternative<AccessToken>(read)) << std::get<std::string>(read);
    EXPECT_TRUE(std::get<AccessToken>(read).admits(std::string("Bearer ") + kToken));
  }
}

TEST(AccessToken, IsRejectedFromABadFileWithoutShowingIt) {
  EXPECT_EQ(fault_of("/no/such/file"), "it cannot be read");
  const TemporaryFile empty("");
  EXPECT_EQ(fault_of(empty.path()), "it is empty");
  const TemporaryFile blank("\n\n");
  EXPECT_EQ(fault_of(blank.path()), "it is empty");
  const TemporaryFile two("first-secret-of-all\nsecond-secret-of-all\n");
  EXPECT_NE(fault_of(two.path()).find("one token"), std::string::npos);
  EXPECT_EQ(fault_of(two.path()).find("secret"), std::string::npos);
  EXPECT_EQ(fault_of("/"), "it cannot be read");
}

TEST(Base64, IsDecoded) {
  EXPECT_EQ(base64_decoded(""), "");
  EXPECT_EQ(base64_decoded("Zg=="), "f");
  EXPECT_EQ(base64_decoded("Zm8="), "fo");
  EXPECT_EQ(base64_decoded("Zm9v"), "foo");
  EXPECT_EQ(base64_decoded("Zm9vYg"), "foob");
  EXPECT_EQ(base64_decoded("/+8="), "\xff\xef");
  EXPECT_EQ(base64_decoded("Z"), std::nullopt);
  EXPECT_EQ(base64_decoded("Zm 9v"), std::nullopt);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
