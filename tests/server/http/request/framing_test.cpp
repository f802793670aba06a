// Requests that no HTTP client sends.

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "server/http/request/request_head.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

class Framing : public testing::Test {
 protected:
  static Settings settings() {
    Settings settings;
    settings.limits.max_body = 1000;
    return settings;
  }

  static std::string post(const std::string& fields, const std::string& body) {
    return "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" + fields +
           "\r\n" + body;
  }

  static std::string status_of(const std::string& answer) { return answer.substr(0, answer.find("\r\n")); }

  void expect_400_and_close(const std::string& text) {
    expect_refused_and_closed(text, "400 Bad Request", "malformed_request");
  }

  /// Sends on a connection of its own; expects a problem, then the end of the connection.
  void expect_refused_and_closed(const std::string& text, const std::string& status,
                                 const std::string& code) {
    RawConnection raw(server.server.port());
    raw.send(text);
    const std::string answer = raw.receive();
    EXPECT_EQ(status_of(answer), "HTTP/1.1 " + status) << text.substr(0, 100);
    EXPECT_NE(answer.find("application/problem+json"), std::string::npos);
    EXPECT_NE(answer.find("X-Request-Id: "), std::string::npos);
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
    EXPECT_NE(answer.find(code), std::string::npos) << answer;
    EXPECT_TRUE(raw.closed_by_server());
  }

  TestServer server{settings()};
};

TEST_F(Framing, MalformedFramingIs400AndEndsTheConnection) {
  expect_400_and_close(post("Content-Length: -1\r\n", ""));
  expect_400_and_close(post("Content-Length: ten\r\n", ""));
  expect_400_and_close(post("Content-Length: 3\r\nTransfer-Encoding: chunked\r\n", "3\r\nabc\r\n0\r\n\r\n"));
  expect_400_and_close(post("Transfer-Encoding: gzip\r\n", ""));
  expect_400_and_close(post("Transfer-Encoding: chunked\r\n", "xyz\r\n"));
  expect_400_and_close(post("Transfer-Encoding: chunked\r\n", "3\r\nabcd\r\n0\r\n\r\n"));
  expect_400_and_close("GET / HTTP/1.1\n\n");
  expect_400_and_close("GET / HTTP/1.1\r\n\r\n");
  expect_400_and_close("GET / HTTP/1.1\r\nHost: a\r\nHost: a\r\n\r\n");
  expect_400_and_close("PRI * HTTP/2.0\r\n\r\n");
}

TEST_F(Framing, TooLongTargetIs414) {
  const auto get = [](std::size_t length) {
    return "GET /healthz?" + std::string(length - 9, 'a') + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  };
  expect_refused_and_closed(get(kMaxTargetBytes + 1), "414 URI Too Long", "target_too_long");
  expect_refused_and_closed(get(40'000), "414 URI Too Long", "target_too_long");
  expect_refused_and_closed("GET /" + std::string(40'000, 'a'), "414 URI Too Long", "target_too_long");
  RawConnection raw(server.server.port());
  raw.send(get(kMaxTargetBytes));
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 200 OK");
}

TEST_F(Framing, TooManyOrTooLargeHeaderFieldsAre431) {
  const auto get = [](std::size_t fields, const std::string& value) {
    std::string text = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n";
    for (std::size_t i = 0; i < fields; ++i) text += "X-" + std::to_string(i) + ": " + value + "\r\n";
    return text + "\r\n";
  };
  const std::string status = "431 Request Header Fields Too Large";
  expect_refused_and_closed(get(kMaxHeaderFields + 1, "a"), status, "head_too_large");
  expect_refused_and_closed(get(1, std::string(kMaxHeadBytes, 'a')), status, "head_too_large");
  RawConnection raw(server.server.port());
  raw.send(get(kMaxHeaderFields - 1, "a"));  // with Host
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 200 OK");
}

TEST_F(Framing, BodyThatEndsEarlyIs400) {
  RawConnection raw(server.server.port());
  raw.send(post("Content-Length: 10\r\n", "abc"));
  raw.end_of_sending();
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 400 Bad Request");
}

TEST_F(Framing, ChunkedBodyIsRead) {
  RawConnection raw(server.server.port());
  raw.send(
      post("Transfer-Encoding: chunked\r\n", "3;ext=1\r\nabc\r\nA\r\n0123456789\r\n0\r\nTrailer: x\r\n\r\n"));
  EXPECT_NE(raw.receive().find(R"({"size":13})"), std::string::npos);
}

TEST_F(Framing, ChunksAndTrailersAreAsStrictAsHeads) {
  using std::string_literals::operator""s;
  for (const std::string& body :
       {"3\nabc\r\n0\r\n\r\n"s, "3\rabc\r\n0\r\n\r\n"s, "3\r\nabc\n0\r\n\r\n"s, "3 \r\nabc\r\n0\r\n\r\n"s,
        "3 x\r\nabc\r\n0\r\n\r\n"s, "3;\r\nabc\r\n0\r\n\r\n"s, "3;a=\x01\r\nabc\r\n0\r\n\r\n"s,
        "3;a\0\r\nabc\r\n0\r\n\r\n"s, "3;a\rb\r\nabc\r\n0\r\n\r\n"s, "3;a\nb\r\nabc\r\n0\r\n\r\n"s,
        "0\r\n\n"s, "0\r\nA: b\n\r\n"s, "0\r\nA: b\rc\r\n\r\n"s, "0\r\nA: b\0\r\n\r\n"s, "0\r\nA b\r\n\r\n"s,
        "0\r\nA : b\r\n\r\n"s, "0\r\n folded\r\n\r\n"s, "0\r\n\r\r\n"s}) {
    expect_400_and_close(post("Transfer-Encoding: chunked\r\n", body));
  }
}

TEST_F(Framing, ChunkedBodyThatExceedsLimitIs413) {
  RawConnection raw(server.server.port());
  std::string body;
  for (int i = 0; i < 20; ++i) body += "64\r\n" + std::string(100, ' ') + "\r\n";
  raw.send(post("Transfer-Encoding: chunked\r\n", body));
  const std::string answer = raw.receive();
  EXPECT_EQ(status_of(answer), "HTTP/1.1 413 Content Too Large");
  EXPECT_NE(answer.find("1000"), std::string::npos);
}

TEST_F(Framing, ChunksOfOneByteAreReadAndTheNextRequestIsKept) {
  RawConnection raw(server.server.port());
  std::string body;
  for (int i = 0; i < 1000; ++i) body += "1\r\nx\r\n";
  raw.send(post("Transfer-Encoding: chunked\r\n", body + "0\r\n\r\n") + post("Content-Length: 2\r\n", "ab"));
  EXPECT_NE(raw.receive().find(R"({"size":1000})"), std::string::npos);
  EXPECT_NE(raw.receive().find(R"({"size":2})"), std::string::npos);
}

TEST_F(Framing, TooManyChunkExtensionsAre400) {
  std::string body;
  for (int i = 0; i < 20; ++i) body += "1;" + std::string(4000, 'e') + "\r\nx\r\n";
  expect_400_and_close(post("Transfer-Encoding: chunked\r\n", body + "0\r\n\r\n"));
}

TEST_F(Framing, HugeChunkSizeIs413BeforeTheChunkArrives) {
  RawConnection raw(server.server.port());
  raw.send(post("Transfer-Encoding: chunked\r\n", "FFFFFFFFFFFFFFFE\r\n"));
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 413 Content Too Large");
}

TEST_F(Framing, MissingBodyIsAnEmptyBody) {
  RawConnection raw(server.server.port());
  raw.send(post("", ""));
  EXPECT_NE(raw.receive().find(R"({"size":0})"), std::string::npos);
}

TEST_F(Framing, PipelinedRequestsAreKeptApart) {
  RawConnection raw(server.server.port());
  raw.send(post("Content-Length: 2\r\n", "ab") + "\r\n" + post("Content-Length: 3\r\n", "abc") +
           "GET /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nGET /" +
           post("Content-Length: 4\r\n", "abcd"));
  EXPECT_NE(raw.receive().find(R"({"size":2})"), std::string::npos);
  EXPECT_NE(raw.receive().find(R"({"size":3})"), std::string::npos);
  EXPECT_NE(raw.receive().find("version"), std::string::npos);
  EXPECT_NE(raw.receive().find(R"({"size":4})"), std::string::npos);
}

TEST_F(Framing, BodyOfARejectedRequestIsSkipped) {
  RawConnection raw(server.server.port());
  raw.send(
      "POST /nowhere HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "4\r\n\r\nGET " +
      post("Content-Length: 1\r\n", "a"));
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 404 Not Found");
  EXPECT_NE(raw.receive().find(R"({"size":1})"), std::string::npos);
}

TEST_F(Framing, Expect100IsAnsweredWithContinue) {
  RawConnection raw(server.server.port());
  raw.send(post("Content-Length: 2\r\nExpect: 100-continue\r\n", ""));
  EXPECT_EQ(raw.receive(), "HTTP/1.1 100 Continue\r\n\r\n");
  raw.send("ab");
  EXPECT_NE(raw.receive().find(R"({"size":2})"), std::string::npos);
}

TEST_F(Framing, Expect100ForTooLargeABodyIs413AtOnce) {
  RawConnection raw(server.server.port());
  raw.send(post("Content-Length: 1001\r\nExpect: 100-continue\r\n", ""));
  EXPECT_EQ(status_of(raw.receive()), "HTTP/1.1 413 Content Too Large");
}

TEST_F(Framing, Http10EndsTheConnectionUnlessKeepAliveIsRequested) {
  RawConnection once(server.server.port());
  once.send("GET /healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(status_of(once.receive()), "HTTP/1.1 200 OK");
  EXPECT_TRUE(once.closed_by_server());
  RawConnection kept(server.server.port());
  for (int i = 0; i < 2; ++i) {
    kept.send("GET /healthz HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    EXPECT_NE(kept.receive().find("Connection: keep-alive"), std::string::npos);
  }
}

TEST_F(Framing, UnknownMethodIs405) {
  RawConnection raw(server.server.port());
  raw.send("BREW /v1/plan HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string answer = raw.receive();
  EXPECT_EQ(status_of(answer), "HTTP/1.1 405 Method Not Allowed");
  EXPECT_NE(answer.find("Allow: POST\r\n"), std::string::npos);
}

/// Sends something and then nothing; expects a timeout and the end of the connection.
void expect_timeout_after(const std::string& sent) {
  Settings settings;
  settings.read_timeout = std::chrono::milliseconds(50);
  const TestServer server(settings);
  RawConnection raw(server.server.port());
  raw.send(sent);
  const std::string answer = raw.receive();
  EXPECT_EQ(answer.find("HTTP/1.1 408 Request Timeout\r\n"), 0u) << answer;
  EXPECT_NE(answer.find("request_timeout"), std::string::npos) << answer;
  EXPECT_TRUE(raw.closed_by_server());
}

TEST(SlowClient, GetsATimeoutWhenItsHeadDoesNotArrive) {
  expect_timeout_after("GET /healthz HTTP/1.1\r\nHost:");
}

TEST(SlowClient, GetsATimeoutWhenItsBodyDoesNotArrive) {
  expect_timeout_after(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "10\r\n\r\nabc");
}

TEST(SlowClient, GetsATimeoutWhenItStopsWithinALargeBody) {
  const auto begin = std::chrono::steady_clock::now();
  expect_timeout_after(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "4000000\r\n\r\n" +
      std::string(3'000'000, ' '));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));  // 30 s at 100 kB/s
}

TEST(SlowClient, GetsATimeoutWhenItsBodyArrivesTooSlowly) {
  Settings settings;
  settings.read_timeout = std::chrono::milliseconds(300);
  const TestServer server(settings);
  RawConnection raw(server.server.port());
  raw.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "50000\r\n\r\n");
  const std::jthread trickle([&raw](const std::stop_token& stop) {  // 5 kB/s
    for (int sent = 0; sent < 50'000 && !stop.stop_requested(); sent += 100) {
      raw.send(std::string(100, ' '));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  const std::string answer = raw.receive();
  EXPECT_EQ(answer.find("HTTP/1.1 408 Request Timeout\r\n"), 0u) << answer;
}

/// Sends `begin`, and then the same bytes again and again; expects the end of the connection.
void expect_end_of_drips(const std::string& begin, const std::string& drip) {
  Settings settings;
  settings.read_timeout = std::chrono::milliseconds(200);
  const TestServer server(settings);
  RawConnection raw(server.server.port());
  raw.send(begin);
  const std::jthread drips([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      raw.send(drip);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  EXPECT_TRUE(raw.closed_by_server()) << begin << " and drips of " << drip;
}

TEST(SlowClient, EndsAtItsDeadlineWhateverItDrips) {
  const std::string get = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n";
  const std::string chunked =
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Transfer-Encoding: chunked\r\n\r\n";
  expect_end_of_drips("", "\r\n");                         // before a head
  expect_end_of_drips(get + "\r\n", "\r\n");               // between requests
  expect_end_of_drips("\r\n", "G");                        // in a request line
  expect_end_of_drips(get, "A: b\r\n");                    // in a head
  expect_end_of_drips(get + "A: ", "b");                   // in a field
  expect_end_of_drips(chunked + "1;a", "b");               // in an extension
  expect_end_of_drips(chunked + "1;a=\"", "b");            // in one in quotes
  expect_end_of_drips(chunked, "1;extension=1\r\na\r\n");  // chunks of one byte
  expect_end_of_drips(chunked + "0\r\n", "A: b\r\n");      // in trailers
  expect_end_of_drips(chunked + "0\r\nA:", "b");           // in a trailer
}

TEST(SlowClient, ThatNeverStopsWithEmptyLinesIsRefused) {
  const TestServer server;
  RawConnection raw(server.server.port());
  std::string lines;
  while (lines.size() <= kMaxHeadBytes) lines += "\r\n";
  raw.send(lines);
  EXPECT_EQ(raw.receive().find("HTTP/1.1 400 Bad Request\r\n"), 0u);
  EXPECT_TRUE(raw.closed_by_server());
}

/// The sizes of chunks and their extensions are no progress of a body.
TEST(SlowClient, GetsATimeoutWhenItsChunksHaveLittleData) {
  Settings settings;
  settings.read_timeout = std::chrono::milliseconds(300);
  const TestServer server(settings);
  RawConnection raw(server.server.port());
  raw.send(
      "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Transfer-Encoding: chunked\r\n\r\n");
  const std::jthread chunks([&raw](const std::stop_token& stop) {  // 10 kB/s of data, 210 kB/s in all
    std::string some;
    for (int k = 0; k < 200; ++k) some += "0000000000000001\r\n \r\n";
    while (!stop.stop_requested()) {
      raw.send(some);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  EXPECT_EQ(raw.receive().find("HTTP/1.1 408 Request Timeout\r\n"), 0u);
}

TEST(SlowClient, IsDisconnectedWhenIdle) {
  Settings settings;
  settings.idle_timeout = std::chrono::milliseconds(20);
  const TestServer server(settings);
  RawConnection raw(server.server.port());
  raw.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(raw.receive().find("200 OK"), std::string::npos);
  EXPECT_TRUE(raw.closed_by_server());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
