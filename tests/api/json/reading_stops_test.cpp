#include <gtest/gtest.h>

#include <memory>
#include <stop_token>
#include <string>

#include "api/json/json_reader.h"
#include "api/request/parse_request.h"
#include "core/runtime/stop_condition.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using core::Work;
using std::chrono::milliseconds;
using Clock = Work::Clock;

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
  const auto looks = static_cast<std::int64_t>(body.size() / Work::kStride / 2);
  const CountingClock clock{std::chrono::nanoseconds(std::chrono::seconds(1)) /
                            std::max<std::int64_t>(1, looks)};
  Work work({.cpu_clock = clock});
  const auto parsed = parse_request(body, large(), work);
  return parsed ? RequestError{ErrorCode::internal_error, "It was read.", {}, 0} : parsed.failure();
}

std::string repeated(const std::string& before, const std::string& item, std::size_t count,
                     const std::string& after) {
  std::string text = before;
  for (std::size_t k = 0; k < count; ++k) text += item;
  return text + after;
}

TEST(ReadingStops, LooksAtTheClockOnceInAStride) {
  const CountingClock clock;
  Work stop({.cpu_clock = clock});
  const int before = *clock.looks;
  for (std::size_t byte = 0; byte < 10 * Work::kStride; ++byte) EXPECT_FALSE(stop.met_after(1));
  EXPECT_EQ(*clock.looks, before + 10);
}

TEST(ReadingStops, IsMetAfterASecondOfCpuTimeAsLongAsTheBudgetIsUnknown) {
  std::chrono::nanoseconds now{7};
  Work stop({.cpu_clock = [&now] { return now; }});
  Work with_budget({.cpu_clock = [&now] { return now; }});
  now += milliseconds(999);
  EXPECT_FALSE(stop.look());
  with_budget.set_budget(std::chrono::hours(1));
  now += milliseconds(1);
  EXPECT_TRUE(stop.look());
  EXPECT_FALSE(with_budget.look());
}

TEST(ReadingStops, IsMetAfterThreeSecondsOfCpuTimeUntilTheRequestHasBeenRead) {
  std::chrono::nanoseconds now{7};
  Work reading({.cpu_clock = [&now] { return now; }});
  Work computing({.cpu_clock = [&now] { return now; }});
  Work without_budget({.cpu_clock = [&now] { return now; }});
  for (Work* work : {&reading, &computing}) work->set_budget(std::chrono::hours(1));
  for (Work* work : {&computing, &without_budget}) work->end_reading();
  now += milliseconds(2999);
  EXPECT_FALSE(reading.look());
  EXPECT_TRUE(without_budget.look()) << "nothing else bounds it";
  now += milliseconds(1);
  EXPECT_TRUE(reading.look());
  EXPECT_FALSE(computing.look());
}

TEST(ReadingStops, IsMetAtTheEndOfTheBudgetAndItsGrace) {
  Work stop({.received_at = Clock::now() - std::chrono::hours(1)});
  stop.set_budget(milliseconds(10));
  EXPECT_FALSE(stop.look()) << "a request that waited too long is still read";
  EXPECT_LE(stop.reading().deadline(), Clock::now() + Work::kGrace);
}

TEST(ReadingStops, IsMetWhenTheClientHasLeftAndStaysMet) {
  std::stop_source source;
  Work stop({.stop = source.get_token()});
  EXPECT_FALSE(stop.look());
  source.request_stop();
  EXPECT_TRUE(stop.look());
  EXPECT_TRUE(stop.met_after(1));
  EXPECT_TRUE(stop.cancelled());
}

TEST(ReadingStops, IsNeverMetByDefault) {
  Work stop = Work::unbounded();
  stop.set_budget(milliseconds(0));
  EXPECT_FALSE(stop.met_after(1'000'000'000));
}

TEST(ReadingStops, EndsTheReadingOfEveryLargeText) {
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

TEST(ReadingStops, EndsTheReadingWhenTheClientHasLeft) {
  std::stop_source source;
  source.request_stop();
  const std::string body = repeated("[", "{},", 100'000, "{}]");
  Work stop({.stop = source.get_token()});
  EXPECT_EQ(parse_request(body, {}, stop).failure().code, ErrorCode::draining);
  EXPECT_EQ(parse_validate_request(body, {}, stop).failure().code, ErrorCode::draining);
}

TEST(ReadingStops, CountsUnknownMembersAsWork) {
  const CountingClock reading;
  const CountingClock parsing;
  const std::string body = repeated("{\"options\": {\"mode\": 1", ",\"unknown\":0", 100'000, "}}");
  Work read({.cpu_clock = reading});
  Work parsed({.cpu_clock = parsing});
  EXPECT_TRUE(read_json(body, 32, read));
  EXPECT_FALSE(parse_request(body, {}, parsed));
  EXPECT_GT(*parsing.looks, *reading.looks);
}

TEST(ReadingStops, EndsLoopsOverItems) {
  std::stop_source source;
  const std::string body = repeated("[", "0,", 100'000, "0]");
  Work work({.stop = source.get_token()});
  auto document = read_json(body, 32, work);
  source.request_stop();
  std::size_t items = 0;
  for (const JsonReader item : JsonReader(*document).array().items()) items += item.is_number() ? 1 : 0;
  EXPECT_LT(items, 2'000U);
  EXPECT_TRUE(work.met());
}

TEST(ReadingStops, LeavesAShortRequestAlone) {
  const CountingClock clock{std::chrono::seconds(100)};
  Work work({.cpu_clock = clock});
  EXPECT_TRUE(parse_request(swap_request().dump(), {}, work));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
