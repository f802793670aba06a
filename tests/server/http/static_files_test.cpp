#include "server/http/static_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/support/test_server.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::server {
namespace TEST_FILE {

namespace fs = std::filesystem;

class Page : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("outside.txt", "secret");
    folder_.write("web/index.html", "<!doctype html>");
    folder_.write("web/style.css", "body {}");
    folder_.write("web/modules/draw.js", "export {};");
    for (const char* name : kHashed) folder_.write("web/" + std::string(name), "hashed");
    for (const char* name : kNotHashed) folder_.write("web/" + std::string(name), "not hashed");
    folder_.write("web/.hidden", "secret");
    fs::create_symlink(folder_.path() / "outside.txt", folder_.path() / "web" / "link.txt");
  }

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }

  Settings settings() const {
    Settings settings;
    settings.web_root = (folder_.path() / "web").string();
    return settings;
  }

  static constexpr std::array kHashed{"main-7BDWMQTA.css", "main-6HKTJ4G5.js",
                                      "clearance_worker-AG42FM4J.js.map"};
  static constexpr std::array kNotHashed{"clearance-worker.js", "main-7bdwmqta.css", "main-7BDWMQT.css",
                                         "main7BDWMQTA.css",    "7BDWMQTA.css",      "main-7BDWMQT8.css",
                                         "-7BDWMQTA.css"};

  support::TemporaryFolder folder_;
};

TEST_F(Page, IsServedWithItsTypesAndStrictFields) {
  const TestServer server(settings());
  auto client = server.client();
  const std::vector<std::array<std::string, 3>> files{
      {"/", "<!doctype html>", "text/html; charset=utf-8"},
      {"/index.html", "<!doctype html>", "text/html; charset=utf-8"},
      {"/style.css?v=1", "body {}", "text/css; charset=utf-8"},
      {"/modules/draw.js", "export {};", "text/javascript; charset=utf-8"}};
  for (const auto& [path, body, type] : files) {
    const auto result = client.Get(path);
    ASSERT_TRUE(result) << path;
    EXPECT_EQ(result->status, 200) << path;
    EXPECT_EQ(result->body, body);
    EXPECT_EQ(result->get_header_value("Content-Type"), type);
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(result->get_header_value("Cache-Control"), "no-cache");
    EXPECT_EQ(result->get_header_value("Content-Security-Policy").find("default-src 'none'"), 0u);
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(result->get_header_value("Referrer-Policy"), "no-referrer");
    EXPECT_EQ(result->get_header_value("Cross-Origin-Opener-Policy"), "same-origin");
    EXPECT_EQ(result->get_header_value("Cross-Origin-Resource-Policy"), "same-origin");
  }
}

TEST_F(Page, IsShownInFramesOfTheListedOriginsOnly) {
  const auto frame_ancestors = [&](std::vector<std::string> origins) {
    auto with_origins = settings();
    with_origins.frame_ancestors = std::move(origins);
    const TestServer server(with_origins);
    const auto result = server.client().Get("/");
    const std::string policy = result ? result->get_header_value("Content-Security-Policy") : "";
    return policy.substr(std::min(policy.size(), policy.find("frame-ancestors")));
  };
  EXPECT_EQ(frame_ancestors({}), "frame-ancestors 'none'");
  EXPECT_EQ(frame_ancestors({"https://a.example", "http://b.example:3000"}),
            "frame-ancestors https://a.example http://b.example:3000");
  EXPECT_EQ(frame_ancestors({"*"}), "frame-ancestors *");
}

TEST_F(Page, IsNotSentAgainWhenTheEtagMatches) {
  const TestServer server(settings());
  auto client = server.client();
  client.set_keep_alive(false);  // this one reads a 304, which has no length, to the connection's end
  const auto first = client.Get("/style.css");
  ASSERT_TRUE(first);
  const httplib::Headers has_it{{"If-None-Match", first->get_header_value("ETag")}};
  const auto second = client.Get("/style.css", has_it);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->status, 304);
  EXPECT_TRUE(second->body.empty());
  write("web/style.css", "main {}");
  const auto third = client.Get("/style.css", has_it);
  ASSERT_TRUE(third);
  EXPECT_EQ(third->body, "main {}");
}

TEST_F(Page, IsCachedForAYearOnlyWhereNamesHaveContentHashes) {
  const TestServer server(settings());
  auto client = server.client();
  const auto cache_control = [&](const std::string& name) {
    const auto result = client.Get("/" + name);
    return result && result->status == 200 ? result->get_header_value("Cache-Control") : "not sent";
  };
  for (const char* name : kHashed) {
    EXPECT_EQ(cache_control(name), "public, max-age=31536000, immutable") << name;
  }
  for (const char* name : kNotHashed) EXPECT_EQ(cache_control(name), "no-cache") << name;
}

TEST_F(Page, HasNoHiddenLinkedOrOutsideFiles) {
  const TestServer server(settings());
  for (const char* path :
       {"/../outside.txt", "/%2e%2e/outside.txt", "/modules/../../outside.txt", "/..%2foutside.txt",
        "/link.txt", "/.hidden", "/modules", "/modules/", "//index.html", "/./index.html",
        "/%20index.html%20", "/%20index.html", "/..\\outside.txt"}) {
    RawConnection raw(server.server.port());
    raw.send("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string answer = raw.receive();
    EXPECT_EQ(answer.find("HTTP/1.1 404 "), 0u) << path;
    EXPECT_EQ(answer.find("secret"), std::string::npos) << path;
  }
}

TEST_F(Page, RejectsOtherMethods) {
  const TestServer server(settings());
  const auto result = server.client().Post("/style.css", "", "text/css");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 405);
  EXPECT_EQ(result->get_header_value("Allow"), "GET, HEAD");
}

TEST(StaticFiles, WithoutAFolderAreNone) {
  const StaticFiles none("");
  EXPECT_FALSE(none.has_root());
  EXPECT_FALSE(none.contains("/"));
  EXPECT_FALSE(none.read("/index.html"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
