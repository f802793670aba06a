// The policy of the queue, with the time in the tests' hands.

#include "server/jobs/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <string>

namespace fleetplan::server {
namespace TEST_FILE {

using namespace std::chrono_literals;
using State = Schedule::Job::State;
using Next = Schedule::Improvement::Next;
using Kind = Schedule::Kind;

/// A schedule and its clock.
class Schedules : public testing::Test {
 protected:
  using Job = Schedule::Job;

  /// An accepted job.
  Job& accepted(const std::string& client = "client") {
    jobs.emplace_back(client);
    EXPECT_EQ(schedule.accept(jobs.back(), now), std::nullopt);
    return jobs.back();
  }

  std::optional<Refusal> refusal_of(const std::string& client) {
    jobs.emplace_back(client);
    return schedule.accept(jobs.back(), now);
  }

  /// A job that has asked for its turn.
  Job& asking(Schedule::Time::duration budget = 1h, const std::string& client = "client",
              bool is_short = false) {
    Job& job = accepted(client);
    EXPECT_EQ(schedule.request_turn(job, {Kind::plan, now + budget, 1.0, is_short}, now), std::nullopt);
    return job;
  }

  /// A job that shares its turn when the turn has lasted long. It has asked for a turn.
  Job& sharing(Kind kind, const std::string& client = "client") {
    Job& job = accepted(client);
    EXPECT_EQ(schedule.request_turn(job, {kind, now + 1h, 1.0, false}, now), std::nullopt);
    return job;
  }

  /// A job for so many robots that has asked for its turn.
  Job& planning(double robots, Schedule::Time::duration budget = 1h, Kind kind = Kind::plan) {
    Job& job = accepted();
    EXPECT_EQ(schedule.request_turn(job, {kind, now + budget, robots, false}, now), std::nullopt);
    return job;
  }

  /// Jobs that take this long each end one after the other, so that such times are expected.
  void learn(Schedule::Time::duration each, int count = 100) {
    for (int k = 0; k < count; ++k) {
      Job& job = asking();
      ASSERT_TRUE(job.has_turn());
      now += each;
      schedule.leave(job, now);
    }
  }

  void use(Schedule::Size size) { schedule = Schedule(size); }

  Schedule schedule{{1, 100, 0}};
  std::deque<Job> jobs;
  Schedule::Time now = Schedule::Time() + 1000h;
};

TEST_F(Schedules, GiveTheTurnToTheEarliestDeadline) {
  Job& first = asking();
  const Job& late = asking(10s);
  const Job& early = asking(2s);
  EXPECT_EQ(late.state, State::waiting);
  EXPECT_EQ(schedule.leave(first, now), &early);
  EXPECT_EQ(early.state, State::computing);
  EXPECT_EQ(late.state, State::waiting);
}

TEST_F(Schedules, AcceptAsManyAsHavePlaces) {
  use({2, 1, 0});
  for (int k = 0; k < 3; ++k) asking();
  EXPECT_EQ(refusal_of("client"), Refusal::queue_full);
}

TEST_F(Schedules, AcceptABurstWhileTheWaitIsShort) {
  use({1, 1, 2});
  Job& first = asking();
  for (int k = 0; k < 3; ++k) accepted();
  EXPECT_EQ(refusal_of("client"), Refusal::queue_full);
  schedule.leave(first, now);
  accepted();
}

TEST_F(Schedules, AcceptNoBurstWhileTheWaitIsLong) {
  use({1, 1, 100});
  asking();
  asking();
  now += Schedule::kShortWait + 1ms;
  EXPECT_EQ(refusal_of("client"), Refusal::queue_full);
}

TEST_F(Schedules, CountTheJobsAheadInTheWait) {
  use({1, 1, 100});
  learn(100ms);
  asking();
  asking();
  accepted();  // parses
  EXPECT_NEAR(schedule.expected_wait_s(now), 0.3, 1e-6);
  EXPECT_EQ(refusal_of("client"), Refusal::queue_full);
}

TEST_F(Schedules, ExpectNoWaitForImprovements) {
  use({1, 1, 100});
  learn(10s);
  Job& improving = asking();
  now += 20s;
  EXPECT_NEAR(schedule.expected_wait_s(now), 20.0, 1e-6) << "as long again";
  schedule.improve(improving, now);
  EXPECT_EQ(schedule.expected_wait_s(now), 0.0);
}

TEST_F(Schedules, ExpectTheEndOfAJobByItsDeadline) {
  learn(10s);
  asking(3s);
  EXPECT_NEAR(schedule.expected_wait_s(now), 3.0, 1e-6);
}

TEST_F(Schedules, ExpectTimesInProportionToTheWork) {
  learn(10ms);
  asking(1h);
  Job& large = accepted();
  EXPECT_EQ(schedule.request_turn(large, {Kind::plan, now + 1h, 50.0, false}, now), std::nullopt);
  EXPECT_NEAR(schedule.expected_wait_s(now), 0.51, 1e-6);
}

TEST_F(Schedules, RefuseAJobThatWouldGetItsTurnTooLate) {
  learn(100ms);
  for (int k = 0; k < 5; ++k) asking();
  Job& hopeless = accepted();
  EXPECT_EQ(schedule.request_turn(hopeless, {Kind::plan, now + 340ms, 1.0, false}, now), Refusal::too_late)
      << "the running job needs 100 ms, and so do jobs like this one";
  Job& urgent = accepted();
  EXPECT_EQ(schedule.request_turn(urgent, {Kind::plan, now + 360ms, 1.0, false}, now), std::nullopt)
      << "the others are less urgent";
  Job& patient = accepted();
  EXPECT_EQ(schedule.request_turn(patient, {Kind::plan, now + 2h, 1.0, false}, now), std::nullopt);
}

TEST_F(Schedules, ReserveMoreTimeWhenTimesVary) {
  for (int k = 0; k < 50; ++k) {
    learn(10ms, 1);
    learn(190ms, 1);
  }
  asking();
  Job& job = accepted();
  EXPECT_EQ(schedule.request_turn(job, {Kind::plan, now + 500ms, 1.0, false}, now), Refusal::too_late);
  EXPECT_EQ(schedule.request_turn(job, {Kind::plan, now + 800ms, 1.0, false}, now), std::nullopt);
}

TEST_F(Schedules, ExpectAClientsJobsOneRoundAfterTheOther) {
  learn(100ms);
  for (int k = 0; k < 4; ++k) asking(900ms, "greedy");
  accepted("polite");
  Job& last = accepted("greedy");
  EXPECT_EQ(schedule.request_turn(last, {Kind::plan, now + 1000ms, 1.0, false}, now), Refusal::too_late)
      << "600 ms for three jobs of its own and as many of the other, half as much in addition";
  EXPECT_EQ(schedule.request_turn(last, {Kind::plan, now + 1200ms, 1.0, false}, now), std::nullopt);
}

TEST_F(Schedules, NeverRefuseAJobWhileAWorkerIsIdle) {
  learn(10s);
  EXPECT_EQ(asking(1ms).state, State::computing);
}

TEST_F(Schedules, GiveNoTurnThatComesTooLate) {
  learn(100ms);
  Job& running = asking();
  const Job& waiting = asking(1s);
  now += 950ms;
  EXPECT_LT(waiting.latest_start, now);
  EXPECT_EQ(schedule.leave(running, now), nullptr);
}

TEST_F(Schedules, GiveFirstPlansTheTurnsOfImprovements) {
  Job& improving = asking();
  EXPECT_EQ(schedule.improve(improving, now).next, Next::goes_on);
  Job& other = asking();
  const auto paused = schedule.improve(improving, now);
  EXPECT_EQ(paused.next, Next::pauses);
  EXPECT_EQ(paused.has_turn, &other);
  EXPECT_EQ(improving.state, State::paused);
  EXPECT_EQ(schedule.paused(), 1u);
  EXPECT_EQ(schedule.leave(other, now), &improving) << "goes on when nobody waits";
  EXPECT_EQ(improving.state, State::improving);
}

TEST_F(Schedules, ResumeAnImprovementOnlyWhenNobodyWaits) {
  Job& improving = asking(1s);
  Job& other = asking(2s);
  schedule.improve(improving, now);
  Job& third = asking(3s);
  EXPECT_EQ(schedule.leave(other, now), &third);
  EXPECT_EQ(schedule.leave(third, now), &improving);
}

TEST_F(Schedules, EndImprovementsBeyondOnePausedPerWorker) {
  Job& first = asking();
  Job& second = asking();
  schedule.improve(first, now);
  ASSERT_EQ(second.state, State::computing);
  asking();
  const auto ended = schedule.improve(second, now);
  EXPECT_EQ(ended.next, Next::ends);
  EXPECT_EQ(ended.has_turn, nullptr);
  EXPECT_TRUE(second.has_turn()) << "until it has written its answer";
}

TEST_F(Schedules, ShareLongTurnsWithThoseThatWait) {
  Job& simulation = sharing(Kind::simulation);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(simulation, now), nullptr) << "nobody waits";
  Job& plan = asking(2s);
  EXPECT_EQ(schedule.share(simulation, now), &plan);
  EXPECT_EQ(simulation.state, State::waiting);
  EXPECT_EQ(schedule.paused(), 1U);
  EXPECT_EQ(schedule.waiting(), 0U);
  Job& later = asking(2s);
  EXPECT_EQ(schedule.leave(plan, now), &simulation) << "it asked before";
  EXPECT_EQ(schedule.paused(), 0U);
  EXPECT_EQ(schedule.share(simulation, now + Schedule::kLongTurn / 2), nullptr) << "its turn is short so far";
  EXPECT_EQ(schedule.leave(simulation, now), &later);
}

TEST_F(Schedules, ShareTurnsAmongThoseThatHaveBegunWhileAsManyArePausedAsThereAreWorkers) {
  Job& first = sharing(Kind::simulation);
  Job& second = sharing(Kind::travel);
  Job& third = sharing(Kind::simulation);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(first, now), &second);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(second, now), &first) << "not the third, whose memory would be one more's";
  EXPECT_EQ(schedule.paused(), 1U);
  EXPECT_EQ(schedule.leave(first, now), &second);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(second, now), &third);
}

TEST_F(Schedules, GiveSharedTurnsToJobsThatWaitForTheirFirst) {
  Job& first = sharing(Kind::travel);
  Job& second = sharing(Kind::travel);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(first, now), &second);
  Job& plan = asking(5s);
  Job& other = asking(4s);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(second, now), &other);
  EXPECT_EQ(schedule.paused(), 2U);
  EXPECT_EQ(schedule.leave(other, now), &first) << "one is paused more than there are workers";
  EXPECT_EQ(schedule.paused(), 1U);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(first, now), &plan);
  EXPECT_EQ(schedule.leave(plan, now), &second);
}

TEST_F(Schedules, GiveSmallPlansTheTurnsOfLargeOnes) {
  Job& large = planning(1000.0);
  Job& other = planning(1000.0);
  Job& small = planning(250.0, 5s);
  now += Schedule::kLongTurn / 2;
  EXPECT_EQ(schedule.share(large, now), nullptr) << "its turn is short so far";
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(large, now), &small);
  EXPECT_EQ(schedule.paused(), 1U);
  EXPECT_EQ(schedule.leave(small, now), &large) << "though others wait for their first turn";
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(large, now), nullptr) << "a plan of its size waits";
  EXPECT_EQ(schedule.improve(large, now).has_turn, &other);
  EXPECT_EQ(schedule.leave(other, now), &large);
  planning(100.0, 5s);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(large, now), nullptr) << "it has a plan, and is asked between two steps";
}

TEST_F(Schedules, ShareTheTurnOfASmallPlanThatTakesLongWithTheLargeOneThatMadeRoom) {
  Job& large = planning(1000.0);
  Job& small = planning(100.0, 5s);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(large, now), &small);
  Job& smaller = planning(20.0, 5s);
  now += Schedule::kLongTurn;
  EXPECT_EQ(schedule.share(small, now), &smaller) << "it asks for its first turn";
  EXPECT_EQ(schedule.paused(), 2U);
  Job& smallest = planning(5.0, 5s);
  now += Schedule::kLongTurn;
  EXPECT_NE(schedule.share(smaller, now), &smallest) << "one is paused more than there are workers";
}

TEST_F(Schedules, LearnAllTheTimeOfPlansThatMadeRoom) {
  Job& large = planning(1000.0);
  now += 1s;
  Job& small = planning(100.0, 10s);
  schedule.share(large, now);
  schedule.leave(small, now);
  now += 2s;
  schedule.leave(large, now);
  asking();
  Job& like_it = accepted();
  EXPECT_EQ(schedule.request_turn(like_it, {Kind::plan, now + 4s, 1000.0, false}, now), Refusal::too_late);
}

/// However long others have had their turns, they give them away.
TEST_F(Schedules, RefuseNobodyForLongTurnsThatAreShared) {
  for (const Kind kind : {Kind::simulation, Kind::travel, Kind::plan}) {
    use({2, 100, 0});
    for (int k = 0; k < 2; ++k) planning(1000.0, 1h, kind);
    now += 10s;
    Job& plan = accepted();
    EXPECT_EQ(schedule.request_turn(plan, {Kind::plan, now + 1s, 100.0, false}, now), std::nullopt);
    Job& like_them = accepted();
    EXPECT_EQ(schedule.request_turn(like_them, {Kind::plan, now + 1s, 1000.0, false}, now),
              kind == Kind::plan ? std::optional(Refusal::too_late) : std::nullopt);
  }
}

/// There may be any number of simulations and travel times, of one client or of several. Every plan gets its
/// turn soon. Never are more jobs paused than there are workers, and one more.
TEST_F(Schedules, AreNotKeptByJobsThatShareTheirTurns) {
  constexpr std::size_t kWorkers = 2;
  for (const bool own_clients : {false, true}) {
    use({kWorkers, 100, 0});
    std::deque<Job*> running;
    for (int k = 0; k < 8; ++k) {
      Job& job = sharing(k % 2 == 0 ? Kind::travel : Kind::simulation, own_clients ? std::to_string(k) : "a");
      if (job.has_turn()) running.push_back(&job);
    }
    for (int round = 0; round < 40; ++round) {
      Job& plan = asking(5s, own_clients ? "planner" : "a");
      const auto asked = now;
      while (!plan.has_turn()) {
        now += Schedule::kLongTurn;
        ASSERT_LE(now - asked, 4 * Schedule::kLongTurn);
        for (Job*& one : running) {
          Job* successor = schedule.share(*one, now);
          if (successor != nullptr) one = successor;
        }
        ASSERT_LE(schedule.paused(), kWorkers + 1);
      }
      now += 30ms;
      Job* successor = schedule.leave(plan, now);
      std::replace(running.begin(), running.end(), &plan, successor);
      ASSERT_EQ(std::count(running.begin(), running.end(), nullptr), 0);
    }
  }
}

TEST_F(Schedules, DoNotGiveTheTurnToAJobThatStoppedWaiting) {
  Job& running = asking();
  Job& waiting = asking();
  schedule.stop_waiting(waiting);
  EXPECT_EQ(schedule.leave(running, now), nullptr);
  EXPECT_EQ(schedule.running(), 0u);
}

TEST_F(Schedules, KeepALaneForShortJobs) {
  asking();
  EXPECT_EQ(asking(1s, "client", false).state, State::waiting);
  Job& brief = asking(1h, "client", true);
  EXPECT_EQ(brief.state, State::computing);
  EXPECT_TRUE(brief.in_lane);
  const Job& next = asking(2h, "client", true);
  EXPECT_EQ(next.state, State::waiting);
  EXPECT_EQ(schedule.leave(brief, now), &next);
}

TEST_F(Schedules, GiveShortJobsOrdinaryTurnsToo) {
  Job& running = asking();
  asking(1h, "client", true);
  const Job& brief = asking(1s, "client", true);
  EXPECT_EQ(schedule.leave(running, now), &brief);
}

TEST_F(Schedules, KeepPlacesForClientsBelowTheirShare) {
  use({1, 3, 0});
  for (int k = 0; k < 4; ++k) asking(1h, "greedy");
  EXPECT_EQ(refusal_of("greedy"), Refusal::queue_full);
  accepted("polite");
  accepted("polite");
  EXPECT_EQ(refusal_of("polite"), Refusal::share) << "two of four places each";
  EXPECT_EQ(refusal_of("greedy"), Refusal::share);
  accepted("other");
  EXPECT_EQ(refusal_of("one more"), Refusal::queue_full);
}

TEST_F(Schedules, KeepThosePlacesWhenABurstHasTheOthers) {
  use({1, 3, 6});
  for (int k = 0; k < 10; ++k) asking(1h, "greedy");
  EXPECT_EQ(refusal_of("greedy"), Refusal::queue_full);
  now += 1min;
  accepted("polite");
}

TEST_F(Schedules, LetTurnsGoRoundTheClients) {
  Job* running = &asking(1h, "greedy");
  for (int k = 0; k < 4; ++k) asking(1s, "greedy");
  const Job& polite = asking(1min, "polite");
  now += 1ms;
  EXPECT_EQ(schedule.leave(*running, now), &polite) << "though its deadline is later";
}

TEST_F(Schedules, GiveTheNextTurnToTheClientThatUsesFewest) {
  use({2, 100, 0});
  Job& greedy = asking(1h, "greedy");
  Job& polite = asking(1h, "polite");
  asking(1s, "greedy");
  const Job& next = asking(1min, "polite");
  EXPECT_EQ(schedule.leave(polite, now), &next);
  schedule.leave(greedy, now);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
