#include "api/json/parse_stop.h"

#include <gtest/gtest.h>

#include <memory>
#include <stop_token>
#include <string>

#include "api/json/json_reader.h"
#include "api/json/read_json.h"
#include "api/request/parse_request.h"
#include "api/request/parse_validate_request.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace {

using std::chrono::milliseconds;
using Clock = ParseStop::Clock;

/// A clock that is `step` later each time that it is looked at.
struct CountingClock {
  std::chrono::nanoseconds step{0};
  std::shared_ptr<int> looks = std::make_shared<int>(0);
  std::chrono::nanoseconds operator()() const { return step * (*looks)++; }
};

Limits large() {
  Limits limits;
  limits.max_robots = 100'000;
  return limits;
}

/// The error of a body whose reading takes a second of CPU time after half of its text.
RequestError error_halfway(const std::string& body) {
  const auto looks = static_cast<std::int64_t>(body.size() / ParseStop::kStride / 2);
  const CountingClock clock{std::chrono::nanoseconds(std::chrono::seconds(1)) /
                            std::max<std::int64_t>(1, looks)};
  const auto parsed = parse_request(body, large(), ParseStop({}, Clock::now(), clock));
  return parsed ? RequestError{ErrorCode::internal_error, "It was read.", {}, 0} : parsed.failure();
}

std::string repeated(const std::string& before, const std::string& item, std::size_t count,
                     const std::string& after) {
  std::string text = before;
  for (std::size_t k = 0; k < count; ++k) text += item;
  return text + after;
}

TEST(ParseStop, LooksAtTheClockOnceInAStride) {
  const CountingClock clock;
  ParseStop stop({}, Clock::now(), clock);
  const int before = *clock.looks;
  for (std::size_t byte = 0; byte < 10 * ParseStop::kStride; ++byte) EXPECT_FALSE(stop.met_after(1));
  EXPECT_EQ(*clock.looks, before + 10);
}

TEST(ParseStop, IsMetAfterASecondOfCpuTimeAsLongAsTheBudgetIsUnknown) {
  std::chrono::nanoseconds now{7};
  ParseStop stop({}, Clock::now(), [&now] { return now; });
  now += milliseconds(999);
  EXPECT_FALSE(stop.look());
  ParseStop with_budget = stop;
  with_budget.set_budget(std::chrono::hours(1));
  now += milliseconds(1);
  EXPECT_TRUE(stop.look());
  EXPECT_FALSE(with_budget.look());
}

TEST(ParseStop, IsMetAtTheEndOfTheBudgetAndItsGrace) {
  ParseStop stop({}, Clock::now() - std::chrono::hours(1));
  stop.set_budget(milliseconds(10));
  EXPECT_FALSE(stop.look()) << "a request that waited too long is still read";
  EXPECT_LE(stop.condition().deadline(), Clock::now() + ParseStop::kGrace);
}

TEST(ParseStop, IsMetWhenTheClientHasLeftAndStaysMet) {
  std::stop_source source;
  ParseStop stop(source.get_token(), Clock::now());
  EXPECT_FALSE(stop.look());
  source.request_stop();
  EXPECT_TRUE(stop.look());
  EXPECT_TRUE(stop.met_after(1));
  EXPECT_TRUE(stop.cancelled());
}

TEST(ParseStop, IsNeverMetByDefault) {
  ParseStop stop;
  stop.set_budget(milliseconds(0));
  EXPECT_FALSE(stop.met_after(1'000'000'000));
}

TEST(ParseStop, EndsTheReadingOfEveryLargeText) {
  const std::size_t count = 400'000;
  for (const auto& [name, body] : std::vector<std::pair<std::string, std::string>>{
           {"string", repeated("\"", "a", 2'000'000, "\"")},
           {"spaces", repeated("", " ", 2'000'000, "{}")},
           {"empty objects", repeated("[", "{},", count, "{}]")},
           {"empty strings", repeated("[", "\"\",", count, "\"\"]")},
           {"equal keys", repeated("{", "\"\":0,", count, "\"\":0}")},
           {"too large numbers", repeated("[", "1e999,", count, "0]")},
           {"not even JSON later", repeated("[", "[],", count, "oops")}}) {
    const RequestError error = error_halfway(body);
    EXPECT_EQ(error.code, ErrorCode::parse_unfinished) << name << ": " << error.detail;
    EXPECT_NE(error.detail.find("a second of CPU time"), std::string::npos) << error.detail;
  }
}

TEST(ParseStop, EndsTheReadingWhenTheClientHasLeft) {
  std::stop_source source;
  source.request_stop();
  const std::string body = repeated("[", "{},", 100'000, "{}]");
  const ParseStop stop(source.get_token(), Clock::now());
  EXPECT_EQ(parse_request(body, {}, stop).failure().code, ErrorCode::draining);
  EXPECT_EQ(parse_validate_request(body, {}, stop).failure().code, ErrorCode::draining);
}

TEST(ParseStop, CountsUnknownMembersAsWork) {
  const CountingClock reading;
  const CountingClock parsing;
  const std::string body = repeated("{\"options\": {\"mode\": 1", ",\"unknown\":0", 100'000, "}}");
  EXPECT_TRUE(read_json(body, 32, ParseStop({}, Clock::now(), reading)));
  EXPECT_FALSE(parse_request(body, {}, ParseStop({}, Clock::now(), parsing)));
  EXPECT_GT(*parsing.looks, *reading.looks);
}

TEST(ParseStop, EndsLoopsOverItems) {
  std::stop_source source;
  const std::string body = repeated("[", "0,", 100'000, "0]");
  auto document = read_json(body, 32, ParseStop(source.get_token(), Clock::now()));
  source.request_stop();
  std::size_t items = 0;
  for (const JsonReader item : JsonReader(*document).array().items()) items += item.is_number() ? 1 : 0;
  EXPECT_LT(items, 2'000U);
  EXPECT_TRUE(document->stop.met());
}

TEST(ParseStop, LeavesAShortRequestAlone) {
  const CountingClock clock{std::chrono::seconds(100)};
  EXPECT_TRUE(parse_request(swap_request().dump(), {}, ParseStop({}, Clock::now(), clock)));
}

}  // namespace
}  // namespace fleetplan::api
