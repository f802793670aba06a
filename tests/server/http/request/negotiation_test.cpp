
#include "server/http/request/negotiation.h"

#include <gtest/gtest.h>

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

}  // namespace TEST_FILE
}  // namespace fleetplan::server
