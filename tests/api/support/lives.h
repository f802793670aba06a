#pragma once

// What tests of fleets have in common that go on from round to round.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "api/endpoints/endpoints.h"
#include "core/plan/planner.h"
#include "tests/api/support/requests.h"
#include "tests/support/moments.h"
#include "tests/support/step_limit.h"

namespace fleetplan::api {

/// A number that who runs a test may choose.
inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// The answer of POST /v1/plan if planning, but neither reading nor the check, is ended after so many steps.
inline Reply planned_in(std::int64_t steps, const Json& request) {
  core::CallerThread executor;
  const Planner planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                              const core::StopCondition& stop, core::Observer* observer) {
    constexpr std::int64_t kPatience = 100'000;  // so much may checks of previous plans outlast the budget
    support::StepLimit limit(steps, kPatience);
    return core::plan(problem, options, stop.ended_by(&limit), executor, observer);
  };
  return plan_with(planner, request.dump(), {});
}

inline core::Pose pose_of(const Json& pose) {
  const auto number = [&](const char* key) { return pose.at(key).get<double>(); };
  return {core::Position(number("x"), number("y")), number("theta")};
}

/// Where actions have their robot at a time.
struct Under {
  std::size_t action;
  double progress;
  core::Pose pose;
};

/// None before and after the actions.
inline std::optional<Under> under_way(const Json& actions, double t) {
  std::size_t number = 0;
  for (const Json& action : actions) {
    const core::Action one{core::Action::Type::translate, action.at("t_start"), action.at("t_end"),
                           pose_of(action.at("from")), pose_of(action.at("to"))};
    if (one.t_start <= t && t < one.t_end) {
      return Under{number, (t - one.t_start) / (one.t_end - one.t_start), support::pose_within(one, t)};
    }
    ++number;
  }
  return std::nullopt;
}

}  // namespace fleetplan::api
