#pragma once

// Jobs on workers, without a server.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "server/jobs/workers.h"

namespace fleetplan::server {

inline const core::StopCondition kForever = core::StopCondition::never();

inline core::StopCondition within(std::chrono::milliseconds time) {
  return core::StopCondition(Workers::Clock::now() + time);
}

using JobPtr = std::unique_ptr<Workers::Job>;

/// Null when the job is refused.
inline JobPtr admit(Workers& workers, const std::string& client = "client") {
  auto job = std::make_unique<Workers::Job>(workers, client);
  return job->refusal() ? nullptr : std::move(job);
}

inline bool take_turn(Workers::Job& job, const core::StopCondition& stop = kForever) {
  Schedule::Need need;
  need.deadline = stop.deadline();
  return job.request_turn(need) && job.await_turn(stop);
}

/// Does a job from admission to end, in the calling thread.
template <class Work>
void do_job(Workers& workers, Work work) {
  const auto job = admit(workers);
  ASSERT_TRUE(job);
  ASSERT_TRUE(take_turn(*job));
  work(*job);
}

/// Does a job from admission to end, in its own thread.
template <class Work>
std::thread start_job(Workers& workers, Work work) {
  return std::thread([&workers, work] { do_job(workers, work); });
}

}  // namespace fleetplan::server
