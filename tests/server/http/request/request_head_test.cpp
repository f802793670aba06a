#include "server/http/request/request_head.h"

#include <gtest/gtest.h>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

TEST(Authority, IsAHostInLowerCaseWithAnOptionalPort) {
  const auto name = parse_authority("Fleet.Example:8080");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->host, "fleet.example");
  EXPECT_EQ(name->port, "8080");
  const auto address = parse_authority("[::1]");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->host, "[::1]");
  EXPECT_EQ(address->port, "");
}

TEST(Authority, ThatIsMalformedIsNone) {
  for (const char* text : {"", ":80", "a b", "a/b", "user@a", "a:b", "a:123456", "[::1", "[::1]80", "[]",
                           "[a]", "::1", "a,b c", "\xff"}) {
    EXPECT_EQ(parse_authority(text), std::nullopt) << text;
  }
}

TEST(LocalName, IsLocalhostOrALoopbackAddress) {
  for (const char* host : {"localhost", "LocalHost", "127.0.0.1", "127.8.9.10", "::1", "[::1]", "[0:0::1]"}) {
    EXPECT_TRUE(is_local_name(host)) << host;
  }
  for (const char* host :
       {"", "0.0.0.0", "::", "128.0.0.1", "localhost.example", "127.0.0.1.example", "127.1", "[::2]"}) {
    EXPECT_FALSE(is_local_name(host)) << host;
  }
}

RequestHead parsed(const std::string& text) {
  auto result = parse_request_head(text);
  const auto* bad = std::get_if<BadHead>(&result);
  EXPECT_EQ(bad, nullptr) << text << (bad != nullptr ? bad->detail : "");
  return bad == nullptr ? std::get<RequestHead>(result) : RequestHead{};
}

bool is_refused(const std::string& text) { return std::holds_alternative<BadHead>(parse_request_head(text)); }

bool is_refused_with_fields(const std::string& fields) {
  return is_refused("POST / HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n");
}

TEST(RequestHead, HasMethodPathWithoutQueryAndFields) {
  const auto head = parsed("POST /v1/pl%61n?x=1 HTTP/1.1\r\nHost: a\r\nContent-Length:  12 \r\n\r\n");
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.raw_path, "/v1/pl%61n");
  EXPECT_EQ(head.path, "/v1/plan");
  EXPECT_EQ(head.field("host"), "a");
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_FALSE(head.chunked);
}

TEST(RequestHead, AcceptsTheAbsoluteFormOfATarget) {
  EXPECT_EQ(parsed("GET http://host:80/healthz?q HTTP/1.1\r\nHost: a\r\n\r\n").path, "/healthz");
  EXPECT_EQ(parsed("GET http://host HTTP/1.1\r\nHost: a\r\n\r\n").path, "/");
  EXPECT_EQ(parsed("GET HTTPS://host?a=/b HTTP/1.1\r\nHost: a\r\n\r\n").path, "/");
  EXPECT_EQ(parsed("GET http://[::1]:80/a://b?c HTTP/1.1\r\nHost: a\r\n\r\n").path, "/a://b");
}

TEST(RequestHead, HasTheHostOfItsTargetElseOfItsField) {
  EXPECT_EQ(parsed("GET http://Host:80/ HTTP/1.1\r\nHost: other\r\n\r\n").host, "Host:80");
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\nHost: [::1]:8080\r\n\r\n").host, "[::1]:8080");
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\nHost:\r\n\r\n").host, "");
  EXPECT_EQ(parsed("GET / HTTP/1.0\r\n\r\n").host, std::nullopt);
}

TEST(RequestHead, RejectsHostFieldsThatAreMissingRepeatedOrMalformed) {
  EXPECT_TRUE(is_refused("GET / HTTP/1.1\r\n\r\n"));
  EXPECT_TRUE(is_refused("GET http://host/ HTTP/1.1\r\n\r\n"));
  for (const char* fields :
       {"Host: a\r\nHost: a\r\n", "Host: a\r\nhost: b\r\n", "Host: a b\r\n", "Host: a/b\r\n", "Host: a:b\r\n",
        "Host: :80\r\n", "Host: user@a\r\n", "Host: [::1\r\n", "Host: [a]:1\r\n", "Host: a, b\r\n"}) {
    EXPECT_TRUE(is_refused(std::string("GET / HTTP/1.1\r\n") + fields + "\r\n")) << fields;
  }
}

TEST(RequestHead, RejectsTargetsThatAreNeitherAPathNorAnHttpAddress) {
  for (const char* target :
       {"healthz", "*", "http", "https", "HTTP", "/healthz#a", "http://host/#", "http://host#a", "http://",
        "http:///healthz", "http://?a", "http://user@host/", "ftp://host/", "host:80", "?a", "://host/"}) {
    EXPECT_TRUE(is_refused(std::string("GET ") + target + " HTTP/1.1\r\nHost: a\r\n\r\n")) << target;
  }
  EXPECT_EQ(parsed("OPTIONS * HTTP/1.1\r\nHost: a\r\n\r\n").path, "*");
}

TEST(RequestHead, JoinsFieldsOfOneName) {
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\nHost: a\r\nAccept: a\r\naccept: b\r\n\r\n").field("accept"), "a, b");
}

TEST(RequestHead, RejectsAContentLengthThatIsNotACount) {
  EXPECT_TRUE(is_refused_with_fields("Content-Length: -1\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Content-Length: +1\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Content-Length: 1x\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Content-Length: \r\n"));
  EXPECT_TRUE(is_refused_with_fields("Content-Length: 1\r\nContent-Length: 2\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Content-Length: 99999999999999999999\r\n"));
}

TEST(RequestHead, RejectsContentLengthTogetherWithTransferEncoding) {
  EXPECT_TRUE(is_refused_with_fields("Content-Length: 1\r\nTransfer-Encoding: chunked\r\n"));
}

TEST(RequestHead, AcceptsOnlyChunkedAsTransferCoding) {
  EXPECT_TRUE(parsed("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: Chunked\r\n\r\n").chunked);
  EXPECT_TRUE(is_refused_with_fields("Transfer-Encoding: gzip, chunked\r\n"));
  EXPECT_TRUE(is_refused("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"));
}

TEST(RequestHead, RejectsMalformedLines) {
  EXPECT_TRUE(is_refused("GET /\r\n\r\n"));
  EXPECT_TRUE(is_refused("GET / HTTP/2.0\r\n\r\n"));
  EXPECT_TRUE(is_refused("GET /a b HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_TRUE(is_refused("G@T / HTTP/1.1\r\n\r\n"));
  EXPECT_TRUE(is_refused("GET /%zz HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_TRUE(is_refused("GET /%00 HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Name : value\r\n"));
  EXPECT_TRUE(is_refused_with_fields(" folded\r\n"));
  EXPECT_TRUE(is_refused_with_fields("no colon\r\n"));
  EXPECT_TRUE(is_refused_with_fields("Name: a\rb\r\n"));
}

TEST(RequestHead, RejectsTooManyFields) {
  std::string fields;
  for (std::size_t i = 1; i < kMaxHeaderFields; ++i) fields += "A: b\r\n";
  EXPECT_FALSE(is_refused_with_fields(fields));
  EXPECT_TRUE(is_refused_with_fields(fields + "A: b\r\n"));
}

TEST(RequestHead, KeepsAliveAccordingToVersionAndConnectionField) {
  EXPECT_TRUE(parsed("GET / HTTP/1.1\r\nHost: a\r\n\r\n").keeps_alive());
  EXPECT_FALSE(parsed("GET / HTTP/1.1\r\nHost: a\r\nConnection: x, Close\r\n\r\n").keeps_alive());
  EXPECT_FALSE(parsed("GET / HTTP/1.0\r\n\r\n").keeps_alive());
  EXPECT_TRUE(parsed("GET / HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n").keeps_alive());
}

TEST(HeadScanner, FindsTheEmptyLineHoweverTheBytesAreCut) {
  const std::string text = "GET / HTTP/1.1\r\nA: b\r\n\r\nbody";
  HeadScanner scanner;
  for (std::size_t size = 0; size < 24; ++size) {
    EXPECT_EQ(scanner.scan(std::string_view(text).substr(0, size)), HeadScanner::State::incomplete) << size;
  }
  EXPECT_EQ(scanner.scan(text), HeadScanner::State::complete);
  EXPECT_EQ(scanner.size(), 24u);
}

TEST(HeadScanner, RejectsALoneLineFeed) {
  EXPECT_EQ(HeadScanner().scan("GET / HTTP/1.1\n\n"), HeadScanner::State::malformed);
}

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
