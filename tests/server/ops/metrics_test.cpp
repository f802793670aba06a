// GET /metrics over a socket, as Prometheus reads it.

#include "server/ops/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <map>
#include <set>
#include <sstream>

#include "server/ops/process.h"
#include "tests/server/support/declared_routes.h"
#include "tests/server/support/soon.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr const char* kJsonType = "application/json";

/// The samples of a text by their series: "name{label=\"value\"}" -> value.
using Samples = std::map<std::string, double>;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Samples samples_of(const std::string& text) {
  Samples samples;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with('#')) continue;
    const auto space = line.rfind(' ');
    const bool is_new = samples.emplace(line.substr(0, space), std::stod(line.substr(space + 1))).second;
    EXPECT_TRUE(is_new) << "twice: " << line;
  }
  return samples;
}

/// The faults of a text in the format of Prometheus, version 0.0.4, as far as the service uses it.
std::vector<std::string> format_faults(const std::string& text) {
  std::vector<std::string> faults;
  std::set<std::string> seen;
  std::string name;
  std::string type;
  for (const std::string& line : lines_of(text)) {
    std::istringstream words(line);
    std::string mark;
    std::string keyword;
    if (line.starts_with("# HELP ")) {
      words >> mark >> keyword >> name;
      type.clear();
      if (!seen.insert(name).second) faults.push_back("described twice: " + name);
      if (line.size() <= ("# HELP " + name + ' ').size()) faults.push_back("no help: " + name);
    } else if (line.starts_with("# TYPE ")) {
      std::string typed;
      words >> mark >> keyword >> typed >> type;
      if (typed != name) faults.push_back("type without help: " + typed);
      if ((type == "counter") != name.ends_with("_total"))
        faults.push_back("counters end in _total: " + name);
    } else {
      const std::string series = line.substr(0, line.find_first_of("{ "));
      const bool part = series == name + "_bucket" || series == name + "_sum" || series == name + "_count";
      if (type.empty() || (type == "histogram" ? !part : series != name)) faults.push_back("stray: " + line);
      if (line.find('{') != std::string::npos && line.find("\"} ") == std::string::npos) {
        faults.push_back("labels: " + line);
      }
    }
  }
  return faults;
}

Service service_with(api::PlanOutcome outcome) {
  Service service = planning_service();
  service.plan = [outcome](std::string_view, const api::RequestContext&) {
    return api::Reply{200, api::kJson, "{}", {}, outcome};
  };
  return service;
}

std::string metrics_of(const TestServer& server) {
  const auto result = server.client().Get("/metrics");
  EXPECT_TRUE(result);
  if (!result) return {};
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(result->get_header_value("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  return result->body;
}

/// Waits until a series has this value: an exchange may be counted after its answer.
void await_value(const TestServer& server, const std::string& series, double value) {
  EXPECT_TRUE(holds_soon([&] { return samples_of(metrics_of(server))[series] == value; })) << series;
}

TEST(Metrics, ExistFromTheStart) {
  const TestServer server;
  const Samples samples = samples_of(metrics_of(server));
  for (const char* series : {R"(fleetplan_requests_total{route="/v1/plan",status="200"})",
                             R"(fleetplan_requests_total{route="/v1/plan",status="422"})",
                             R"(fleetplan_requests_total{route="/v1/plan",status="503"})",
                             R"(fleetplan_requests_total{route="/v1/validate",status="200"})",
                             R"(fleetplan_requests_total{route="/v1/examples/{name}",status="200"})",
                             R"(fleetplan_requests_total{route="/",status="200"})",
                             R"(fleetplan_requests_total{route="unknown",status="404"})",
                             R"(fleetplan_rejected_total{reason="overloaded"})",
                             R"(fleetplan_rejected_total{reason="draining"})",
                             R"(fleetplan_rejected_total{reason="invalid_request"})",
                             R"(fleetplan_rejected_total{reason="unauthorized"})",
                             "fleetplan_queue_depth",
                             "fleetplan_workers_busy",
                             R"(fleetplan_queue_wait_seconds_bucket{le="0.001"})",
                             R"(fleetplan_queue_wait_seconds_bucket{le="+Inf"})",
                             "fleetplan_queue_wait_seconds_count",
                             R"(fleetplan_plans_total{outcome="solved"})",
                             R"(fleetplan_plans_total{outcome="partial"})",
                             R"(fleetplan_plans_total{outcome="none"})",
                             "fleetplan_plans_cancelled_total",
                             "fleetplan_plans_refused_total",
                             "fleetplan_plan_seconds_sum",
                             "fleetplan_plan_seconds_count",
                             R"(fleetplan_robots_total{outcome="planned"})",
                             R"(fleetplan_robots_total{outcome="unplanned"})",
                             R"(fleetplan_unplanned_robots_total{reason="budget_exhausted"})",
                             R"(fleetplan_unplanned_robots_total{reason="committed_in_the_way"})",
                             R"(fleetplan_unplanned_robots_total{reason="invalid"})",
                             "fleetplan_map_cache_hits_total",
                             "fleetplan_map_cache_misses_total",
                             "fleetplan_map_cache_maps",
                             "fleetplan_map_cache_bytes",
                             "fleetplan_expansions_total"}) {
    ASSERT_TRUE(samples.contains(series)) << series;
    EXPECT_EQ(samples.at(series), 0.0) << series;
  }
  EXPECT_EQ(samples.at("fleetplan_workers"), 1.0);
  EXPECT_GE(samples.at(R"(fleetplan_connections{port="main"})"), 1.0) << "that of this request";
  for (const char* series : {"process_cpu_seconds_total", "process_resident_memory_bytes",
                             "process_virtual_memory_bytes", "process_open_fds", "process_max_fds"}) {
    ASSERT_TRUE(samples.contains(series)) << series;
    EXPECT_GT(samples.at(series), 0.0) << series;
  }
  EXPECT_NEAR(samples.at("process_start_time_seconds"), static_cast<double>(std::time(nullptr)), 600.0);
}

TEST(Metrics, ContainUsualStatusesFromTheStartAndOthersOnceTheyOccur) {
  Settings settings;
  settings.cors_origins = {"https://fleet.example"};
  settings.web_root = FLEETPLAN_SOURCE_DIR "/web";
  const TestServer server(settings);
  const auto series_of = [&](const std::string& begin) {
    std::set<std::string> series;
    for (const auto& [name, value] : samples_of(metrics_of(server))) {
      if (name.starts_with(begin)) series.insert(name);
    }
    return series;
  };
  const auto at_start = series_of("fleetplan_");
  auto client = server.client();
  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  const auto again = client.Get("/", httplib::Headers{{"If-None-Match", page->get_header_value("ETag")}});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  const DeclaredRoutes declared;
  for (const Route& route : declared.table.routes()) {
    const std::string& path = route.path;
    const httplib::Headers preflight_fields{{"Origin", "https://fleet.example"},
                                            {"Access-Control-Request-Method", "GET"}};
    const auto preflight = client.Options(path, preflight_fields);
    ASSERT_TRUE(preflight);
    EXPECT_EQ(preflight->status, 204) << path;
    ASSERT_TRUE(client.Delete(path));
    ASSERT_TRUE(client.Get(path));
  }
  for (const char* path : {"/v1/plan", "/v1/validate"}) ASSERT_TRUE(client.Post(path, "{", kJsonType));
  await_value(server, R"(fleetplan_requests_total{route="/v1/validate",status="200"})", 1.0);
  EXPECT_EQ(series_of("fleetplan_"), at_start);

  const std::string unusual = R"(fleetplan_requests_total{route="/v1/limits",status="400"})";
  EXPECT_FALSE(at_start.contains(unusual));
  RawConnection(server.server.port())
      .send("GET /v1/limits HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nx\r\n");
  await_value(server, unusual, 1.0);
}

TEST(Metrics, NameTheBuild) {
  const TestServer server;
  std::vector<std::string> infos;
  for (const auto& [series, value] : samples_of(metrics_of(server))) {
    if (series.starts_with("fleetplan_build_info")) infos.push_back(series);
  }
  EXPECT_THAT(infos, ElementsAre(StartsWith(std::string("fleetplan_build_info{version=\"") + kVersion +
                                            "\",compiler=\"")));
}

TEST(Metrics, FollowTheFormatOfPrometheus) {
  const TestServer server;
  ASSERT_TRUE(server.client().Get("/nowhere"));
  EXPECT_THAT(format_faults(metrics_of(server)), IsEmpty());  // tests/openapi runs promtool
}

TEST(MetricsFormat, FaultsAreDetectedByTheTest) {
  const std::string good = "# HELP a_total A.\n# TYPE a_total counter\na_total{x=\"y\"} 1\n";
  EXPECT_THAT(format_faults(good), IsEmpty());
  EXPECT_THAT(format_faults("a_total 1\n"), Not(IsEmpty()));
  EXPECT_THAT(format_faults(good + good), Not(IsEmpty()));
  EXPECT_THAT(format_faults(good + "b 1\n"), Not(IsEmpty()));
  EXPECT_THAT(format_faults("# HELP a A.\n# TYPE a counter\na 1\n"), Not(IsEmpty()));
  EXPECT_THAT(format_faults("# HELP a \n# TYPE a gauge\na 1\n"), Not(IsEmpty()));
  EXPECT_THAT(format_faults("# HELP a A.\n# TYPE a gauge\na{x=\"y} 1\n"), Not(IsEmpty()));
}

TEST(Metrics, CountPlansAndTheirRobots) {
  using Status = api::PlanOutcome::Status;
  const TestServer server({}, service_with({Status::partial, 7, 2, 1234, 10.0, 0.03}));
  auto client = server.client();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(client.Post("/v1/plan", "{}", kJsonType));
  await_value(server, R"(fleetplan_requests_total{route="/v1/plan",status="200"})", 3.0);
  Samples samples = samples_of(metrics_of(server));
  EXPECT_EQ(samples[R"(fleetplan_plans_total{outcome="partial"})"], 3.0);
  EXPECT_EQ(samples[R"(fleetplan_plans_total{outcome="solved"})"], 0.0);
  EXPECT_EQ(samples[R"(fleetplan_robots_total{outcome="planned"})"], 21.0);
  EXPECT_EQ(samples[R"(fleetplan_robots_total{outcome="unplanned"})"], 6.0);
  EXPECT_EQ(samples["fleetplan_expansions_total"], 3702.0);
  EXPECT_EQ(samples[R"(fleetplan_plan_seconds_bucket{le="0.025"})"], 0.0);
  EXPECT_EQ(samples[R"(fleetplan_plan_seconds_bucket{le="0.05"})"], 3.0);
  EXPECT_EQ(samples[R"(fleetplan_plan_seconds_bucket{le="+Inf"})"], 3.0);
  EXPECT_EQ(samples["fleetplan_plan_seconds_count"], 3.0);
  EXPECT_NEAR(samples["fleetplan_plan_seconds_sum"], 0.09, 1e-12);
}

TEST(Metrics, CountStreamedPlans) {
  const TestServer server({}, planning_service());
  const auto result = server.client().Post(
      "/v1/plan", httplib::Headers{{"Accept", "text/event-stream"}},
      R"({"map": {"rows": ["....", "...."]}, "robots": [{"id": "a", "radius": 0.3, "linear_speed": 1,
          "angular_speed": 1, "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 3.5, "y": 1.5}}]})",
      kJsonType);
  ASSERT_TRUE(result);
  EXPECT_NE(result->body.find("event: plan"), std::string::npos) << result->body;
  await_value(server, R"(fleetplan_plans_total{outcome="solved"})", 1.0);
  EXPECT_EQ(samples_of(metrics_of(server))[R"(fleetplan_robots_total{outcome="planned"})"], 1.0);
}

TEST(Metrics, OmitTheTimeOfPlansThatWereNeverStarted) {
  const TestServer server({}, service_with({api::PlanOutcome::Status::none, 0, 2, 0, 0.0, std::nullopt}));
  ASSERT_TRUE(server.client().Post("/v1/plan", "{}", kJsonType));
  await_value(server, R"(fleetplan_plans_total{outcome="none"})", 1.0);
  await_value(server, R"(fleetplan_robots_total{outcome="unplanned"})", 2.0);
  EXPECT_EQ(samples_of(metrics_of(server))["fleetplan_plan_seconds_count"], 0.0);
}

TEST(Metrics, CountPlansThatTheCheckerRejected) {
  const TestServer server({}, service_with({api::PlanOutcome::Status::refused, 0, 0, 5, 0.0, 0.01}));
  ASSERT_TRUE(server.client().Post("/v1/plan", "{}", kJsonType));
  await_value(server, "fleetplan_plans_refused_total", 1.0);
  EXPECT_EQ(samples_of(metrics_of(server))[R"(fleetplan_plans_total{outcome="none"})"], 0.0);
}

TEST(Metrics, CountRejectionsByTheirReason) {
  const TestServer server;
  auto client = server.client();
  ASSERT_TRUE(client.Get("/nowhere"));
  ASSERT_TRUE(client.Get("/v1/plan"));
  ASSERT_TRUE(client.Get("/v1/examples/huge"));
  ASSERT_TRUE(client.Post("/v1/plan", "throw", kJsonType));
  await_value(server, R"(fleetplan_requests_total{route="/v1/plan",status="500"})", 1.0);
  Samples samples = samples_of(metrics_of(server));
  EXPECT_EQ(samples[R"(fleetplan_rejected_total{reason="not_found"})"], 2.0);
  EXPECT_EQ(samples[R"(fleetplan_rejected_total{reason="method_not_allowed"})"], 1.0);
  EXPECT_EQ(samples[R"(fleetplan_rejected_total{reason="internal_error"})"], 1.0);
  EXPECT_EQ(samples[R"(fleetplan_requests_total{route="unknown",status="404"})"], 1.0);
  EXPECT_EQ(samples[R"(fleetplan_requests_total{route="/v1/plan",status="405"})"], 1.0);
  EXPECT_EQ(samples[R"(fleetplan_requests_total{route="/v1/examples/{name}",status="404"})"], 1.0);
}

TEST(Metrics, DoNotCountAnUnreadyProbeAsRejection) {
  TestServer server;
  server.server.announce_end();
  const auto ready = server.client().Get("/readyz");
  ASSERT_TRUE(ready);
  ASSERT_EQ(ready->status, 503);
  await_value(server, R"(fleetplan_requests_total{route="/readyz",status="503"})", 1.0);
  EXPECT_EQ(samples_of(metrics_of(server))[R"(fleetplan_rejected_total{reason="draining"})"], 0.0);
}

TEST(Metrics, CountCancelledPlans) {
  TestServer server;
  {
    RawConnection client(server.server.port());
    client.send(
        "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
        "4\r\n\r\ngate");
    server.stub.gate.await_waiting(1);
    EXPECT_EQ(samples_of(metrics_of(server))["fleetplan_workers_busy"], 1.0);
  }
  await_value(server, "fleetplan_plans_cancelled_total", 1.0);
  EXPECT_EQ(samples_of(metrics_of(server))[R"(fleetplan_requests_total{route="/v1/plan",status="499"})"],
            1.0);
  await_value(server, "fleetplan_workers_busy", 0.0);
}

TEST(Metrics, ReportTheQueueDepth) {
  Settings settings;
  settings.workers = 1;
  settings.queue = 4;
  TestServer server(settings);
  const auto send_job = [](RawConnection& client) {
    client.send(
        "POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
        "4\r\n\r\ngate");
  };
  RawConnection running(server.server.port());
  RawConnection first(server.server.port());
  RawConnection second(server.server.port());
  send_job(running);
  server.stub.gate.await_waiting(1);
  send_job(first);
  send_job(second);
  await_value(server, "fleetplan_queue_depth", 2.0);
  EXPECT_GE(samples_of(metrics_of(server))[R"(fleetplan_connections{port="main"})"], 4.0);
  server.stub.gate.open();
  await_value(server, "fleetplan_queue_depth", 0.0);
  await_value(server, "fleetplan_queue_wait_seconds_count", 3.0);
}

TEST(MetricsText, EscapesLabels) {
  MetricsText text;
  text.metric("a", "gauge", "Help.").sample(0.5, {{"x", "a\"b\\c\nd"}, {"y", ""}});
  EXPECT_EQ(text.take(), "# HELP a Help.\n# TYPE a gauge\na{x=\"a\\\"b\\\\c\\nd\",y=\"\"} 0.5\n");
}

TEST(Histogram, IncludesUpperBoundsInTheirBucket) {
  Histogram histogram;
  histogram.observe(Histogram::kBounds[0]);
  histogram.observe(std::nextafter(Histogram::kBounds[0], 1.0));
  histogram.observe(1e9);
  EXPECT_EQ(histogram.count(0), 1u);
  EXPECT_EQ(histogram.count(1), 1u);
  EXPECT_EQ(histogram.count(Histogram::kBounds.size()), 1u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
