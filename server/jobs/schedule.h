#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/ops/metrics.h"

namespace fleetplan::server {

/// Decides which jobs are accepted and whose turn it is to compute. This is only the policy, without threads
/// and without a clock: callers pass the time.
///
/// - **Turns.** As many jobs compute at a time as there are workers. One more turn, the lane, is for short
///   jobs, so that they do not wait behind long jobs.
/// - **First plans before improvements.** A job that has its first plan and improves it gives its turn to a
///   job that waits for its first plan. It gets a turn again when no such job waits. At most as many
///   improvements are paused as there are workers. Further improvements end with what they have.
/// - **Long turns are shared.** A job that goes on for long, such as a simulation, gives its turn to a job
///   that waits. It gets a turn again in the order of turns, as if it had just asked, and loses no work. A
///   client's jobs that wait for their first turn come before its interrupted jobs. Suppose that as many jobs
///   are paused or interrupted as there are workers. Then the turn goes only to one of these, or to a job
///   that does not share its turns. With one more, it goes only to one of these. So jobs that share their
///   turns do not keep other jobs out, however many they are.
/// - **Large plans make room for small ones.** A job that takes long to its first plan gives its turn to a
///   much smaller job: a plan for far fewer robots, or a check that is expected to be short. It is the next
///   to get a turn again. Plans of similar size do not share: each would take as long as all of them.
/// - **Order.** Turns go round the clients. Next is the client with the fewest turns, then the client whose
///   last turn is the longest ago. Among a client's jobs, and among clients without a turn so far, the job
///   with the earliest deadline is next.
/// - **Places.** There are `queue` places for jobs that wait, and `burst` more while the expected wait is
///   short. A client's share is the number of places divided by the number of clients. A client with less
///   than its share is accepted beyond the places, up to `queue` jobs more.
/// - **Refusals.** A job is refused when it asks for a turn, if it is not expected to get the turn with
///   enough of its time left. A job that waits gives up when less time is left than similar jobs need.
class Schedule {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kShortWait{250};
  /// The time after which a job that goes on shares its turn.
  static constexpr std::chrono::milliseconds kLongTurn{250};

  struct Size {
    std::size_t workers = 1;
    std::size_t queue = 0;
    std::size_t burst = 0;
  };

  enum class Kind { plan, check, simulation, conversion, travel };
  static constexpr std::size_t kKinds = 5;

  /// The needs of a job that asks for its turn.
  struct Need {
    Kind kind = Kind::plan;
    Time deadline = Time::max();  // the end of the computation
    double work = 1.0;            // proportional to the expected time, for the kind
    bool is_short = false;        // may use the lane
  };

  /// A job from its acceptance to its end. Its owner keeps it and only reads it.
  struct Job {
    enum class State { accepted, waiting, computing, improving, paused };

    explicit Job(std::string client_name) : client(std::move(client_name)) {}
    bool has_turn() const { return state == State::computing || state == State::improving; }

    const std::string client;
    Need need = {};
    State state = State::accepted;
    bool in_lane = false;             // the turn it has is the lane's
    bool is_interrupted = false;      // it waits for another turn
    Time::duration computed{};        // in turns before, of a plan
    Time due = Time::max();           // the earliest of a client's jobs comes first
    Time since = {};                  // begin of its turn
    Time latest_start = Time::max();  // the latest begin of a turn that is of use
  };

  explicit Schedule(Size size) : size_(size) {}

  /// Accepts a job, or returns why not.
  std::optional<Refusal> accept(Job& job, Time now);

  /// Asks for the turn of an accepted job. On return, the job has its turn, or waits, or is refused for the
  /// reason returned.
  std::optional<Refusal> request_turn(Job& job, const Need& need, Time now);

  /// The outcome for an improvement.
  struct Improvement {
    enum class Next { goes_on, pauses, ends } next = Next::goes_on;
    Job* has_turn = nullptr;  // the job that has got the turn
  };
  /// Decides about a job that has its turn and a plan, and is about to improve the plan.
  Improvement improve(Job& job, Time now);

  /// Decides about a job that is about to go on with work that cannot end early. Returns the job that has got
  /// its turn, for which this job now waits. Returns null if it goes on.
  Job* share(Job& job, Time now);

  /// Ends the wait of a job, which remains accepted.
  void stop_waiting(Job& job) {
    job.state = Job::State::accepted;
    job.is_interrupted = false;
  }

  /// Removes a job that was accepted and has ended. Returns the job that has got its turn, or null.
  Job* leave(Job& job, Time now);

  /// The number of jobs that wait for their first turn.
  std::size_t waiting() const;
  /// The number of jobs that had a turn and wait for their next turn.
  std::size_t paused() const;
  std::size_t running() const { return turns_ + (lane_taken_ ? 1 : 0); }

  /// Returns the seconds until a job that arrived now would get its turn.
  double expected_wait_s(Time now) const { return expected_wait_s(nullptr, now); }

 private:
  struct Client {
    std::size_t places = 0;
    std::size_t turns = 0;
    Time last_turn = Time::min();
  };
  /// Running means of the turns of jobs: until their first plan, their end, or their interruption.
  struct Pace {
    double seconds = 0.0;
    double deviation = 0.0;  // mean deviation of the seconds from what was expected
    double work = 0.0;
  };

  bool precedes(const Job& a, const Job& b) const;
  Job* next(bool for_lane, Time now) const;
  bool may_take_over(const Job& job, const Job& from) const;
  Job* next_to_share(const Job& from, Time now) const;
  void grant(Job& job, bool lane, Time now);
  void take_back(Job& job);
  Job* hand_over(bool lane, Time now);
  void learn(const Job& job, Time now);
  double expected_s(const Job& job) const;
  double remaining_s(const Job& job, Time now) const;
  double enough_s(const Job& job) const;
  double expected_wait_s(const Job* job, Time now) const;
  double own_wait_s(const Job& job) const;
  double wait_to_share_s(const Job& job, Time now) const;

  Size size_;
  std::vector<Job*> jobs_;                 // jobs in the order of their acceptance
  std::map<std::string, Client> clients_;  // clients that have a job
  std::size_t turns_ = 0;                  // turns taken, without the lane's
  bool lane_taken_ = false;
  std::array<Pace, kKinds> paces_;
};

}  // namespace fleetplan::server
