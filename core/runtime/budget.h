#pragma once

// How the time budget of a request is divided: the shares and limits of all parts of planning.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace fleetplan::core::budget {

// A budget (`time_budget_ms`, Options::time_budget) begins with the last byte of the body. The example is a
// second for 100 robots, without queue:
//
//  1. Reading takes what it takes, a few milliseconds. `Work` (stop_condition.h) says when it has to end.
//     Each later part has the time that the parts before it leave.
//  2. Kept for the end: 25 ms for check and answer (kept_for_answer(), for_dependencies()). The rest, 975 ms,
//     is the time for planning. A share is a share of what is left of this time when a part begins. With the
//     library, the time for planning is the whole budget, and the check comes after it.
//  3. Poses of goals that have several: at most a quarter (kShareOfPoses), and again before each try with
//     other poses.
//  4. Previous plans, if there are any: their check may last until 500 ms after the budget
//     (kMaxForPrevious), as they are kept whatever the budget.
//  5. First plan: what is left, as long as robots have no plan. A tenth (kShareOfOrder) may find the order
//     of expected arrivals. Then robots are planned in that order, with repairs. From time to time
//     (kShareOfLook) it is estimated whether the time suffices for all. If a robot has failed, steps of the
//     whole fleet have two fifths of what is left (kShareOfSteps).
//  6. Safe plan, in which nobody is in the way of others: at once if the time is not expected to suffice, and
//     otherwise after two thirds (kShareBeforeSafePlan), in crowds after half
//     (kShareBeforeSafePlanOfCrowd), until nine tenths (kShareWithSafePlan) at most. Planning goes on until
//     all robots have a plan or the time is over. Robots that gave way to others return to their previous
//     plans in the last twentieth (kShareAroundKept).
//  7. Smoothing of the first plan: at most three tenths (kShareOfBriefSmoothing). Then unavoidable
//     collisions: until 150 ms after the budget (kMaxForUnavoidable), because no plan can be checked without
//     them.
//  8. Bounds: in mode `anytime` at most a fifth (kShareOfBounds), otherwise what is left.
//  9. Improvement, in mode `anytime`: what is left, the last tenth for smoothing (kShareOfSmoothing).
// 10. The end of planning: 30 ms (kTimeForTheEnd), also after the time for planning.
// 11. Check: until 90 ms after the time for planning (CheckPatience), or 25 ms of CPU time. If that is not
//     enough, 200 ms for a plan in which nobody moves.
// 12. Answer: the explanations of the plan are made within the budget; then the text is written.
//
// `timings_ms` of the answer shows the parts: `parse` is 1, `choose` 3, `first_plan` 4 to 7, `bounds` 8,
// `improve` 9 and 10, `verify` 11, `serialize` 12. Meanwhile, the job shares its turn (shared_turn.h).
// Searches also divide their effort, which is counted and needs no clock, independently of these shares.

using Duration = std::chrono::nanoseconds;

// 2. Kept for the end.

/// What is known of a request once it has been read.
struct Request {
  Duration budget{};
  Duration reading{};  // how long reading took: it tells how large the request is, and how busy the machine
  Duration until_read{};  // how long it took from the last byte on, waiting included
  std::size_t robots = 0;
  bool is_large_map = false;  // see kManyCells
  bool has_obstacles = false;
};

/// A map with more cells counts as large: its check may take as long as reading it.
inline constexpr int kManyCells = 4'000'000;

/// Returns the time to check a plan and write the answer: a twentieth of the budget. It is at most what as
/// many robots need if their plans have many moves, as in crowds.
inline Duration for_check_and_answer(Duration budget, std::size_t robots) {
  constexpr std::chrono::milliseconds kLeast{25};
  constexpr std::chrono::microseconds kForARobot{400};
  const Duration max = std::max<Duration>(kLeast, static_cast<std::int64_t>(robots) * kForARobot);
  return std::min(budget / 20, max);
}

/// Returns the part of the budget after planning, to check the plan and write the answer. It is
/// for_check_and_answer(), or a quarter of the time that reading the request took. Unavoidable collisions of
/// robots with moving obstacles, and their check, take up to half as long as reading them.
inline Duration kept_for_answer(const Request& request) {
  const auto by_reading = [&] {
    if (request.is_large_map) return std::min(request.budget / 2, request.reading);
    if (request.has_obstacles) return std::min(request.budget / 2, request.reading / 2);
    return std::min(request.budget / 4, request.reading / 4);
  };
  return std::max(for_check_and_answer(request.budget, request.robots), by_reading());
}

/// Returns the part of the budget for the dependencies of the answer, at most a quarter. It is several times
/// what fleets have needed so far.
inline Duration for_dependencies(const Request& request) {
  constexpr std::chrono::milliseconds kForARobot{4};
  return std::min<Duration>(request.budget / 4, static_cast<std::int64_t>(request.robots) * kForARobot);
}

// 3. Poses.

inline constexpr double kShareOfPoses = 0.25;

// 4. Previous plans.

/// The check decides whether previous plans are kept. It takes about 10 ms for 500 robots. The limit is for
/// plans in which many robots meet in one small area, and for a busy machine. It also holds for plans without
/// any search.
inline constexpr std::chrono::milliseconds kMaxForPrevious{500};
/// The least time for planning other robots around robots that keep their plans, also after the time for
/// planning. Robots without a plan are in the way of others, so a spent budget would cost plans that hold. A
/// few robots are planned around hundreds of others in less than this.
inline constexpr std::chrono::milliseconds kLeastAroundKept{40};

// 5. First plan.

/// The share after which a safe plan is made, and that in crowds, whose last robots may take long.
inline constexpr double kShareBeforeSafePlan = 0.66;
inline constexpr double kShareBeforeSafePlanOfCrowd = 0.5;
/// Whether the time suffices is estimated each time after this share of what is left.
inline constexpr double kShareOfLook = 0.06;
/// The share of what is left then for a safe plan, if all robots may have a plan afterwards.
inline constexpr double kShareOfKeeping = 0.45;
/// The share which finding the order of expected arrivals may take.
inline constexpr double kShareOfOrder = 0.1;
/// The share that steps of the whole fleet may take before something else is tried.
inline constexpr double kShareOfSteps = 0.4;
/// The share of that for steps along the rows and columns of a lattice, if they do not suffice.
inline constexpr double kShareOfLattice = 0.7;

// 6. Safe plan.

/// The share after which the making of it ends.
inline constexpr double kShareWithSafePlan = 0.93;
/// The share around plans that are kept, if the rest is for robots that gave way and may return.
inline constexpr double kShareAroundKept = 0.95;
/// The least time around kept plans that is divided in two parts. Keeping a safe plan and returning to the
/// state before takes about 0.1 s for 500 robots. In less time, repairs of the plan are better left to run.
inline constexpr std::chrono::milliseconds kLeastFirstPart{250};

// 7. Smoothing of the first plan, and unavoidable collisions.

inline constexpr double kShareOfBriefSmoothing = 0.3;
/// Without unavoidable collisions, no plan can be checked.
inline constexpr std::chrono::milliseconds kMaxForUnavoidable{150};

// 8. Bounds.

inline constexpr double kShareOfBounds = 0.2;

// 9. Improvement.

/// The last share of the time, and of the iterations if they are limited. In it, all robots are smoothed.
inline constexpr double kShareOfSmoothing = 0.1;
/// In this last part of the time for planning, no better plan is shown before the final plan.
inline constexpr std::chrono::milliseconds kQuietEnd{250};

// 10. The end of planning.

/// For undoing vain moves after improvement, and for finding out why robots are stuck.
inline constexpr std::chrono::milliseconds kTimeForTheEnd{30};

// 11. Check.

/// How long a check may take.
struct CheckPatience {
  Duration after_planning;      // from the end of planning on, which may be in the past
  Duration if_cancelled;        // from its begin on, if planning was cancelled
  Duration for_nobody;          // from its begin on, if nobody moves in the plan, which is the last one left
  bool despite_cancel = false;  // whether it goes on if a stop is requested meanwhile
};

/// The CPU time that a thousand robots with few moves need. A check is not given up before.
inline constexpr std::chrono::milliseconds kLeastCpuOfCheck{25};

/// Returns the patience of the service. The check is given up soon after the end of planning. It is given up
/// even sooner if the plan was cancelled, because then the service drains.
inline CheckPatience patience_of_service(const Request& request) {
  constexpr std::chrono::milliseconds kAfterPlanning{90};
  constexpr std::chrono::milliseconds kLeastForNobody{200};
  return {.after_planning =
              std::max<Duration>(kAfterPlanning, for_check_and_answer(request.budget, request.robots)),
          .if_cancelled = kAfterPlanning / 2,
          .for_nobody = std::max<Duration>(kLeastForNobody, request.until_read)};
}

/// Returns the patience of the library: nobody else waits.
inline CheckPatience patience_of_library() {
  constexpr std::chrono::milliseconds kAfterBudget{500};
  return {.after_planning = kAfterBudget,
          .if_cancelled = kAfterBudget,
          .for_nobody = kAfterBudget,
          .despite_cancel = true};
}

// Others: simulations, travel times and assignments.

/// Returns the part of the budget for the answer with simulated runs.
inline Duration for_answer_of_runs(Duration budget) {
  return std::min<Duration>(budget / 10, std::chrono::milliseconds(50));
}

/// The share of the time for margins in which their candidates are planned; the rest is for the runs.
inline constexpr double kShareOfCandidates = 0.4;

/// Returns the part of the budget for the answer with travel times or an assignment.
inline Duration for_answer_of_travel(Duration budget) {
  return std::min<Duration>(budget / 10, std::chrono::milliseconds(100));
}

}  // namespace fleetplan::core::budget
