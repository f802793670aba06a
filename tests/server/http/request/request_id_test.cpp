
#include <gtest/gtest.h>

#include "server/http/request/request_head.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

const std::string kTraceId = "0af7651916cd43dd8448eb211c80319c";
const std::string kParentId = "b7ad6b7169203331";

std::string traceparent(const std::string& version, const std::string& trace_id, const std::string& parent_id,
                        const std::string& rest) {
  return version + '-' + trace_id + '-' + parent_id + '-' + rest;
}

TEST(TraceContext, IsThatOfAWellFormedField) {
  EXPECT_EQ(trace_id_of(traceparent("00", kTraceId, kParentId, "01")), kTraceId);
  EXPECT_EQ(trace_id_of(traceparent("00", kTraceId, kParentId, "ff")), kTraceId);
}

TEST(TraceContext, OfALaterVersionMayHaveFurtherParts) {
  EXPECT_EQ(trace_id_of(traceparent("01", kTraceId, kParentId, "00")), kTraceId);
  EXPECT_EQ(trace_id_of(traceparent("cc", kTraceId, kParentId, "01-what-follows")), kTraceId);
  EXPECT_EQ(trace_id_of(traceparent("cc", kTraceId, kParentId, "01.what-follows")), std::nullopt);
}

TEST(TraceContext, IsAbsentFromAMalformedField) {
  for (const std::string& malformed : {
           std::string(),
           std::string("00"),
           std::string(55, '-'),
           std::string(55, '0'),
           traceparent("00", std::string(32, '0'), kParentId, "01"),
           traceparent("00", kTraceId, std::string(16, '0'), "01"),
           traceparent("00", "0AF7651916CD43DD8448EB211C80319C", kParentId, "01"),
           traceparent("00", kTraceId, "b7ad6b716920333g", "01"),
           traceparent("00", kTraceId, kParentId, "0x"),
           traceparent("00", kTraceId, kParentId, "1"),
           traceparent("00", kTraceId, kParentId, "01-"),
           traceparent("ff", kTraceId, kParentId, "01"),
           traceparent("0z", kTraceId, kParentId, "01"),
           "00-" + kTraceId + '_' + kParentId + "-01",
       }) {
    EXPECT_EQ(trace_id_of(malformed), std::nullopt) << malformed;
  }
}

TEST(TraceContext, IsReturnedByEveryAnswer) {
  const TestServer server;
  auto client = server.client();
  const std::string sent = traceparent("00", kTraceId, kParentId, "01");
  const httplib::Headers fields{{"traceparent", sent}};
  const auto expect_kept = [&](const httplib::Result& result, int status) {
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, status);
    EXPECT_EQ(result->get_header_value("traceparent"), sent);
  };
  expect_kept(client.Post("/v1/plan", fields, "abc", "application/json"), 200);
  expect_kept(client.Post("/v1/plan", fields, "throw", "application/json"), 500);
  expect_kept(client.Get("/nowhere", fields), 404);
}

TEST(TraceContext, IsAbsentFromAnswersToRequestsWithoutOne) {
  const TestServer server;
  auto client = server.client();
  const std::string one = traceparent("00", kTraceId, kParentId, "01");
  for (const httplib::Headers& fields : {httplib::Headers{}, httplib::Headers{{"traceparent", "none"}},
                                         httplib::Headers{{"traceparent", one}, {"traceparent", one}}}) {
    const auto result = client.Get("/healthz", fields);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200);
    EXPECT_FALSE(result->has_header("traceparent"));
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
