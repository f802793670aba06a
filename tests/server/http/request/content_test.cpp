#include "server/http/request/content.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace fleetplan::server {
namespace TEST_FILE {

TEST(Accept, SelectsJsonWhenAbsentNamedOrCoveredByARange) {
  for (const char* accept : {"", "  ", "*/*", "application/json", "application/*", "text/html, */*;q=0.1",
                             "Application/JSON; charset=utf-8", "application/json;q=0.001"}) {
    EXPECT_EQ(plan_form(accept), PlanForm::json) << accept;
  }
}

TEST(Accept, SelectsEventsWhenTheirQualityIsHigher) {
  for (const char* accept :
       {"text/event-stream", "text/*", "Text/Event-Stream;q=0.1", "text/event-stream, application/json;q=0.9",
        "application/json;q=0, */*", "text/event-stream, */*;q=0.1", "application/*;q=0.5, text/*;q=0.6"}) {
    EXPECT_EQ(plan_form(accept), PlanForm::events) << accept;
  }
}

TEST(Accept, SelectsJsonWhenQualitiesAreEqual) {
  for (const char* accept :
       {"text/event-stream, application/json", "text/event-stream, */*",
        "text/event-stream;q=0.3, application/*;q=0.3",
        "text/*, text/event-stream;q=0.2, application/json;q=0.2", "text/event-stream;q=0, */*"}) {
    EXPECT_EQ(plan_form(accept), PlanForm::json) << accept;
  }
}

TEST(Accept, ExcludesBothWhenAbsentFromTheListOrOfQualityZero) {
  for (const char* accept :
       {"text/html", "application/json;q=0", "*/*; q=0.0", "application/json;q=0, text/event-stream;q=0, */*",
        "application/xml, application/*;q=0", "application/json;q=-1", "text/*;q=0, image/*"}) {
    EXPECT_EQ(plan_form(accept), std::nullopt) << accept;
  }
}

TEST(AcceptEncoding, AllowsGzipByNameOrStarUnlessOfQualityZero) {
  for (const char* accept : {"gzip", "br, gzip", "GZIP;q=0.5", "*", "deflate, x-gzip"}) {
    EXPECT_TRUE(accepts_gzip(accept)) << accept;
  }
  for (const char* accept : {"", "br", "identity", "gzip;q=0", "*;q=0", "*, gzip;q=0"}) {
    EXPECT_FALSE(accepts_gzip(accept)) << accept;
  }
}

TEST(ContentType, IsJson) {
  for (const char* type : {"application/json", "application/json; charset=utf-8",
                           "Application/JSON;charset=UTF-8", "application/vnd.fleet+json"}) {
    EXPECT_EQ(content_type_fault(type), std::nullopt) << type;
  }
  for (const char* type :
       {"", ";", "text/plain", "application/xml", "application/jsonx", "application/json; charset=utf-16"}) {
    EXPECT_NE(content_type_fault(type), std::nullopt) << type;
  }
}

TEST(ContentType, ThatIsAbsentIsRejectedWithARemedy) {
  EXPECT_NE(content_type_fault("").value_or("").find("send 'Content-Type: application/json'"),
            std::string::npos);
}

TEST(ContentType, OfAWebFormIsRejectedWithARemedy) {
  const auto fault = content_type_fault("application/x-www-form-urlencoded");
  ASSERT_NE(fault, std::nullopt);
  EXPECT_NE(fault->find("--json"), std::string::npos);
  EXPECT_NE(fault->find("Content-Type: application/json"), std::string::npos);
}

TEST(ContentEncoding, IsGzipOrPlain) {
  EXPECT_EQ(content_coding(""), ContentCoding::identity);
  EXPECT_EQ(content_coding("identity"), ContentCoding::identity);
  EXPECT_EQ(content_coding("GZip"), ContentCoding::gzip);
  EXPECT_EQ(content_coding("br"), ContentCoding::unknown);
  EXPECT_EQ(content_coding("gzip, gzip"), ContentCoding::unknown);
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string coded(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(coded.data());
  stream.avail_out = static_cast<uInt>(coded.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  coded.resize(stream.total_out);
  deflateEnd(&stream);
  return coded;
}

class Gzip : public testing::Test {
 protected:
  std::variant<std::string, BodyFault> decode(const std::string& coded, std::uint64_t limit = 1 << 20) {
    BodyMemory::Share share(memory);
    return gunzip(coded, limit, share, core::StopCondition::never());
  }

  void expect_text(const std::string& coded, const std::string& text) {
    const auto decoded = decode(coded);
    ASSERT_TRUE(std::holds_alternative<std::string>(decoded)) << coded.size();
    EXPECT_EQ(std::get<std::string>(decoded), text);
  }

  void expect_fault(const std::string& coded, BodyFault::Kind kind, std::uint64_t limit = 1 << 20) {
    const auto decoded = decode(coded, limit);
    ASSERT_TRUE(std::holds_alternative<BodyFault>(decoded)) << coded.size();
    EXPECT_EQ(std::get<BodyFault>(decoded).kind, kind) << coded.size();
  }

  BodyMemory memory{1 << 20, 1, 1};
};

TEST_F(Gzip, OfSeveralMembersIsOneText) {
  const std::string large(300'000, 'x');
  expect_text(gzipped("abc"), "abc");
  expect_text(gzipped(""), "");
  expect_text(gzipped("abc") + gzipped("") + gzipped(large), "abc" + large);
  expect_text(gzipped(large) + gzipped("abc"), large + "abc");
}

TEST_F(Gzip, ThatIsCutAnywhereIsMalformed) {
  const std::string one = gzipped("abcdef");
  const std::string two = one + gzipped("ghi");
  for (std::size_t size = 0; size < two.size(); ++size) {
    if (size == one.size()) continue;
    expect_fault(two.substr(0, size), BodyFault::Kind::malformed);
  }
}

TEST_F(Gzip, WithAWrongChecksumOrLengthIsMalformed) {
  const std::string good = gzipped("abcdef");
  for (std::size_t from_end = 1; from_end <= 8; ++from_end) {
    std::string bad = good;
    bad[bad.size() - from_end] ^= 1;
    expect_fault(bad, BodyFault::Kind::malformed);
    expect_fault(bad + good, BodyFault::Kind::malformed);
  }
}

TEST_F(Gzip, FollowedByAnythingElseIsMalformed) {
  for (const std::string& rest :
       {std::string("x"), std::string(1, '\0'), std::string(100'000, '\0'), std::string("\x1f\x8b")}) {
    expect_fault(gzipped("abc") + rest, BodyFault::Kind::malformed);
  }
}

TEST_F(Gzip, CodesWhatItDecodes) {
  std::string text;
  for (std::int64_t k = 0; k < 60'000; ++k) text += std::to_string(k * k) + ',';
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{64 * 1024}, text.size()}) {
    const auto coded = gzip(text.substr(0, size), core::StopCondition::never());
    ASSERT_TRUE(coded);
    expect_text(*coded, text.substr(0, size));
  }
  EXPECT_LT(gzip(text, core::StopCondition::never())->size(), text.size() / 2);
}

TEST_F(Gzip, EndsWhenItIsStopped) {
  const core::StopCondition met(core::StopCondition::Clock::time_point::min());
  EXPECT_FALSE(gzip(std::string(1'000'000, 'a'), met));
  std::string members;  // that decode to nothing
  for (int k = 0; k < 1000; ++k) members += gzipped("");
  for (const std::string& coded : {members, gzipped(std::string(1000, ' '))}) {
    BodyMemory::Share share(memory);
    const auto decoded = gunzip(coded, 1 << 20, share, met);
    ASSERT_TRUE(std::holds_alternative<BodyFault>(decoded));
    EXPECT_EQ(std::get<BodyFault>(decoded).kind, BodyFault::Kind::stopped);
  }
}

TEST_F(Gzip, IsBoundedByTheLimitAndTheMemory) {
  expect_fault(gzipped(std::string(1001, ' ')), BodyFault::Kind::too_large, 1000);
  expect_fault(gzipped(std::string(600, ' ')) + gzipped(std::string(600, ' ')), BodyFault::Kind::too_large,
               1000);
  expect_fault(gzipped(std::string(4 << 20, ' ')), BodyFault::Kind::no_room, 8 << 20);
  expect_text(gzipped(std::string(1000, ' ')), std::string(1000, ' '));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
