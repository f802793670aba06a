#include "server/jobs/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fleetplan::server {

namespace {

using State = Schedule::Job::State;
using Seconds = std::chrono::duration<double>;

/// Weight of the newest job in the running means: about the last ten count.
constexpr double kNewestWeight = 0.1;

/// Expectations are means, so that enough time for a plan, and for a wait, is more than expected.
constexpr double kLeastEnough = 2.0;
constexpr double kDeviations = 4.0;
constexpr double kWaitMargin = 1.5;

/// A plan is much smaller than another plan if it has at most this part of the other's work. Times grow
/// faster than work.
constexpr double kMuchSmaller = 0.25;

/// Whether a job of this kind lets any other have its turn while it goes on for long.
bool shares_turns(Schedule::Kind kind) {
  return kind == Schedule::Kind::simulation || kind == Schedule::Kind::travel;
}

/// Returns the time `seconds` before the deadline. Far deadlines have no exact difference to small times,
/// which is harmless.
Schedule::Time before(Schedule::Time deadline, double seconds) {
  if (deadline == Schedule::Time::max()) return deadline;
  return deadline - std::chrono::duration_cast<Schedule::Time::duration>(Seconds(seconds));
}

}  // namespace

std::optional<Refusal> Schedule::accept(Job& job, Time now) {
  const auto found = clients_.find(job.client);
  const std::size_t held = found == clients_.end() ? 0 : found->second.places;
  const std::size_t clients = clients_.size() + (held == 0 ? 1 : 0);
  std::size_t room = size_.workers + size_.queue;
  const std::size_t share = std::max<std::size_t>(1, room / clients);
  if (jobs_.size() >= room && expected_wait_s(now) <= Seconds(kShortWait).count()) room += size_.burst;
  if (jobs_.size() >= room) {
    if (held >= share) return clients > 1 ? Refusal::share : Refusal::queue_full;
    if (jobs_.size() >= size_.workers + size_.queue + size_.burst + size_.queue) return Refusal::queue_full;
  }
  jobs_.push_back(&job);
  ++clients_[job.client].places;
  return std::nullopt;
}

std::optional<Refusal> Schedule::request_turn(Job& job, const Need& need, Time now) {
  job.need = need;
  job.due = need.deadline;
  if (turns_ < size_.workers) {
    grant(job, false, now);
    return std::nullopt;
  }
  if (need.is_short && !lane_taken_) {
    grant(job, true, now);
    return std::nullopt;
  }
  job.latest_start = before(need.deadline, enough_s(job));
  const double wait_s =
      std::min(std::max(expected_wait_s(&job, now), own_wait_s(job)), wait_to_share_s(job, now));
  if (before(job.latest_start, kWaitMargin * wait_s) <= now) return Refusal::too_late;
  job.state = State::waiting;
  return std::nullopt;
}

Schedule::Improvement Schedule::improve(Job& job, Time now) {
  if (job.state == State::computing) learn(job, now);
  job.state = State::improving;
  const Job* other = next(job.in_lane, now);
  if (other == nullptr || other->state != State::waiting) return {};
  if (paused() >= size_.workers) return {Improvement::Next::ends, nullptr};
  const bool lane = job.in_lane;
  take_back(job);
  Job* successor = hand_over(lane, now);
  job.state = State::paused;
  return {Improvement::Next::pauses, successor};
}

Schedule::Job* Schedule::share(Job& job, Time now) {
  if (job.state != State::computing || now - job.since < kLongTurn) return nullptr;
  if (next_to_share(job, now) == nullptr) return nullptr;
  if (job.need.kind == Kind::plan) {
    job.computed += now - job.since;
  } else {
    learn(job, now);
  }
  take_back(job);
  Job* successor = next_to_share(job, now);
  grant(*successor, job.in_lane, now);
  job.state = State::waiting;
  job.is_interrupted = true;
  job.latest_start = job.need.deadline;
  job.due = std::min(job.need.deadline, now + kLongTurn);
  return successor;
}

Schedule::Job* Schedule::leave(Job& job, Time now) {
  Job* successor = nullptr;
  const bool had_turn = job.has_turn();
  if (job.state == State::computing) learn(job, now);
  if (had_turn) take_back(job);
  std::erase(jobs_, &job);
  if (had_turn) successor = hand_over(job.in_lane, now);
  const auto client = clients_.find(job.client);
  if (--client->second.places == 0) clients_.erase(client);
  return successor;
}

std::size_t Schedule::waiting() const {
  return static_cast<std::size_t>(std::count_if(jobs_.begin(), jobs_.end(), [](const Job* job) {
    return job->state == State::waiting && !job->is_interrupted;
  }));
}

std::size_t Schedule::paused() const {
  return static_cast<std::size_t>(std::count_if(jobs_.begin(), jobs_.end(), [](const Job* job) {
    return job->state == State::paused || job->is_interrupted;
  }));
}

bool Schedule::precedes(const Job& a, const Job& b) const {
  const auto rank = [&](const Job& job) {
    const Client& client = clients_.at(job.client);
    const bool is_first = job.is_interrupted && job.need.kind == Kind::plan;
    return std::tuple(!is_first, job.state == State::paused, client.turns, client.last_turn, job.due);
  };
  return rank(a) < rank(b);
}

/// Whether a job that waits may take the turn of another job, which is interrupted for it.
bool Schedule::may_take_over(const Job& job, const Job& from) const {
  if (from.in_lane && !job.need.is_short) return false;
  if (job.is_interrupted) return true;
  const bool shares = shares_turns(job.need.kind);
  if (from.need.kind == Kind::plan) {
    const bool is_small = job.need.kind == Kind::plan ? job.need.work <= kMuchSmaller * from.need.work
                                                      : expected_s(job) <= Seconds(kLongTurn).count();
    if (shares || !is_small) return false;
  }
  return paused() < size_.workers + (shares ? 0 : 1);
}

/// Returns the job that gets the turn that one shares; null if none may have it.
Schedule::Job* Schedule::next_to_share(const Job& from, Time now) const {
  const auto precedes_in_sharing = [&](const Job& a, const Job& b) {
    const bool differ = a.client == b.client && a.is_interrupted != b.is_interrupted;
    return differ ? b.is_interrupted : precedes(a, b);
  };
  Job* best = nullptr;
  for (Job* job : jobs_) {
    if (job->state != State::waiting || job->latest_start <= now || !may_take_over(*job, from)) continue;
    if (best == nullptr || precedes_in_sharing(*job, *best)) best = job;
  }
  return best;
}

/// Returns the job whose turn is next: the worker's, or the lane's. With more jobs interrupted than there are
/// workers, it is one of these.
Schedule::Job* Schedule::next(bool for_lane, Time now) const {
  const bool is_full = paused() > size_.workers;
  Job* best = nullptr;
  for (Job* job : jobs_) {
    const bool waits = job->state == State::waiting && job->latest_start > now;
    if (!waits && job->state != State::paused) continue;
    if (is_full && !job->is_interrupted && job->state != State::paused) continue;
    if (for_lane && !job->need.is_short) continue;
    if (best == nullptr || precedes(*job, *best)) best = job;
  }
  return best;
}

void Schedule::grant(Job& job, bool lane, Time now) {
  job.state = job.state == State::paused ? State::improving : State::computing;
  job.in_lane = lane;
  job.is_interrupted = false;
  job.since = now;
  if (lane) {
    lane_taken_ = true;
  } else {
    ++turns_;
  }
  Client& client = clients_.at(job.client);
  ++client.turns;
  client.last_turn = now;
}

void Schedule::take_back(Job& job) {
  if (job.in_lane) {
    lane_taken_ = false;
  } else {
    --turns_;
  }
  --clients_.at(job.client).turns;
  job.state = State::accepted;
}

Schedule::Job* Schedule::hand_over(bool lane, Time now) {
  Job* job = next(lane, now);
  if (job != nullptr) grant(*job, lane, now);
  return job;
}

void Schedule::learn(const Job& job, Time now) {
  Pace& pace = paces_[static_cast<std::size_t>(job.need.kind)];
  const double seconds = Seconds(job.computed + (now - job.since)).count();
  if (pace.work == 0.0) {
    pace = {seconds, 0.0, job.need.work};
    return;
  }
  pace.deviation += kNewestWeight * (std::abs(seconds - expected_s(job)) - pace.deviation);
  pace.seconds += kNewestWeight * (seconds - pace.seconds);
  pace.work += kNewestWeight * (job.need.work - pace.work);
}

/// Returns the seconds that a job is expected to take; 0 while no job of its kind has ended.
double Schedule::expected_s(const Job& job) const {
  const Pace& pace = paces_[static_cast<std::size_t>(job.need.kind)];
  return pace.work > 0.0 ? pace.seconds / pace.work * job.need.work : 0.0;
}

/// Returns the seconds that suffice for most jobs like it.
double Schedule::enough_s(const Job& job) const {
  const double expected = expected_s(job);
  const Pace& pace = paces_[static_cast<std::size_t>(job.need.kind)];
  const double spread = pace.seconds > 0.0 ? kDeviations * pace.deviation / pace.seconds : 0.0;
  return expected * std::max(kLeastEnough, 1.0 + spread);
}

/// Returns the seconds that a job is expected to go on. A job that computes longer than expected will take at
/// least as long again as it has already. An improvement gives its turn away at once.
double Schedule::remaining_s(const Job& job, Time now) const {
  if (job.state == State::improving) return 0.0;
  const double age_s = Seconds(job.computed + (now - job.since)).count();
  const double left_s = std::max(expected_s(job) - age_s, age_s);
  if (job.need.deadline == Time::max()) return left_s;
  return std::clamp(Seconds(job.need.deadline - now).count(), 0.0, left_s);
}

/// Returns the seconds that a job waits when turns go round the clients there are and the client's own jobs
/// come one after the other.
double Schedule::own_wait_s(const Job& job) const {
  double own_s = 0.0;
  for (const Job* other : jobs_) {
    const bool is_ahead = other->client == job.client && other->state == State::waiting;
    if (is_ahead && precedes(*other, job)) own_s += expected_s(*other);
  }
  return own_s * static_cast<double>(clients_.size()) / static_cast<double>(size_.workers);
}

/// Returns the seconds until the job gets a turn that another job shares, after the jobs before it. Infinite
/// if there is no such turn.
double Schedule::wait_to_share_s(const Job& job, Time now) const {
  double least_s = std::numeric_limits<double>::infinity();
  for (const Job* from : jobs_) {
    const bool shares = shares_turns(from->need.kind) || from->need.kind == Kind::plan;
    if (from->state != State::computing || !shares || !may_take_over(job, *from)) continue;
    double wait_s = std::max(0.0, Seconds(kLongTurn - (now - from->since)).count());
    for (const Job* other : jobs_) {
      const bool is_ahead = other->state == State::waiting && other != &job && precedes(*other, job);
      if (is_ahead && may_take_over(*other, *from)) {
        wait_s += std::min(expected_s(*other), Seconds(kLongTurn).count());
      }
    }
    least_s = std::min(least_s, wait_s);
  }
  return least_s;
}

/// Returns the seconds that `job` waits; null: a new job. Gives the turns, in their order, to the jobs that
/// precede it, or to all that wait or will wait if it is null.
double Schedule::expected_wait_s(const Job* job, Time now) const {
  std::vector<double> free_s(size_.workers + 1, 0.0);  // when each turn is free; the lane's is the last
  std::vector<const Job*> ahead;
  std::size_t worker = 0;
  std::size_t parsing = 0;
  for (const Job* other : jobs_) {
    if (other->has_turn()) {
      free_s[other->in_lane ? size_.workers : worker++] = remaining_s(*other, now);
    } else if (other->state == State::waiting && (job == nullptr || precedes(*other, *job))) {
      ahead.push_back(other);
    } else if (job == nullptr && other->state == State::accepted) {
      ++parsing;
    }
  }
  std::sort(ahead.begin(), ahead.end(), [&](const Job* a, const Job* b) { return precedes(*a, *b); });
  const auto first_free = [&](bool is_short) {
    return std::min_element(free_s.begin(), free_s.end() - (is_short ? 0 : 1));
  };
  for (const Job* other : ahead) *first_free(other->need.is_short) += expected_s(*other);
  const double plan_s = paces_[static_cast<std::size_t>(Kind::plan)].seconds;
  for (; parsing > 0; --parsing) *first_free(false) += plan_s;
  return *first_free(job != nullptr && job->need.is_short);
}

}  // namespace fleetplan::server
