#include "core/moves/place_steps.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/moves/joint_steps.h"
#include "core/moves/pushing_search.h"
#include "core/moves/single_move_search.h"
#include "core/moves/step_places.h"
#include "core/moves/step_times.h"
#include "core/moves/timed_step_search.h"

namespace fleetplan::core {
namespace {

/// How far places are from each other, in distances of two robots in contact; 0: all vertices.
constexpr std::array kPlaceSpacings{1.0, 0.5, 0.25, 0.0};
/// The configurations of each search after which others go on. At the end they are 16 MB for six robots.
constexpr std::array<std::size_t, 3> kMaxConfigurations{3'000, 30'000, 300'000};
/// For more robots than a few, of all rounds.
constexpr std::size_t kMaxConfigurationsOfMany = 30'000;
/// The robots in all nodes of a search with times: 15 MB.
constexpr std::size_t kMaxRestsWithTimes = 300'000;
/// The most robots that are moved one at a time at first: for more of them, there are too many
/// configurations.
constexpr std::size_t kFewOnPlaces = 6;

}  // namespace

/// The searches over places of one spacing.
struct PlaceSteps::Level {
  explicit Level(std::vector<StepPlaces> all) : places(std::move(all)), steps(places), single(steps) {}

  const std::vector<StepPlaces> places;
  const JointSteps steps;
  SingleMoveSearch single;
  std::optional<TimedStepSearch> timed;  // once steps are found that have no times
  bool has_pushed = false;
  bool is_done = false;
};

PlaceSteps::PlaceSteps(FleetReservations& reservations, std::vector<std::size_t> robots, Random& random)
    : reservations_(reservations), robots_(std::move(robots)), random_(random) {}

PlaceSteps::~PlaceSteps() = default;

std::optional<std::vector<Trajectory>> PlaceSteps::run(const StopCondition& stop) {
  if (robots_.size() > kMaxRobots) return std::nullopt;
  // Bounded: a few rounds over a few levels.
  for (const std::size_t max_configurations : kMaxConfigurations) {
    for (const bool with_times : {false, true}) {
      for (std::size_t number = 0; number < kPlaceSpacings.size(); ++number) {
        if (stop.met()) return std::nullopt;
        Level* const level = this->level(number, stop);
        if (level == nullptr || level->is_done || level->timed.has_value() != with_times) continue;
        auto trajectories = with_times ? search_with_times(*level, max_configurations, stop)
                                       : search(*level, number, max_configurations, stop);
        if (trajectories) return trajectories;
      }
    }
  }
  return std::nullopt;
}

/// Null if there are no such places.
PlaceSteps::Level* PlaceSteps::level(std::size_t number, const StopCondition& stop) {
  if (number == levels_.size()) {
    auto places = places_of_steps(reservations_, robots_, kPlaceSpacings[number], stop);
    if (!places && stop.met()) return nullptr;  // it may be made later
    levels_.push_back(places ? std::make_unique<Level>(std::move(*places)) : nullptr);
  }
  return number < levels_.size() ? levels_[number].get() : nullptr;
}

std::optional<std::vector<Trajectory>> PlaceSteps::search(Level& level, std::size_t number,
                                                          std::size_t max_configurations,
                                                          const StopCondition& stop) {
  StepSequence sequence;
  if (robots_.size() > kFewOnPlaces && !std::exchange(level.has_pushed, true)) {
    auto plan = plan_by_pushing(level.steps, random_, stop);
    if (stop.met()) return std::nullopt;
    if (plan) sequence.configurations = std::move(*plan);
  }
  if (sequence.configurations.empty()) {
    const std::size_t max =
        are_few() ? max_configurations : std::min(max_configurations, kMaxConfigurationsOfMany);
    const SingleMoveSearch::Outcome outcome = level.single.run(max, stop);
    if (outcome == SingleMoveSearch::Outcome::none) {
      level.is_done = true;
      has_no_way_ = has_no_way_ || kPlaceSpacings[number] == 0.0;
    }
    if (outcome != SingleMoveSearch::Outcome::found) return std::nullopt;
    sequence.configurations = level.single.plan();
  }
  auto trajectories = times_of_steps(reservations_, robots_, level.steps, sequence, stop);
  if (trajectories || stop.met()) return trajectories;
  level.timed.emplace(reservations_, robots_, level.steps);
  trajectories = search_with_times(level, kMaxConfigurations.front(), stop);
  if (trajectories || stop.met()) return trajectories;
  sequence.earliest = rest_of_others(reservations_, robots_);
  if (sequence.earliest == 0.0) return std::nullopt;
  return times_of_steps(reservations_, robots_, level.steps, sequence, stop);
}

/// Searches for steps that have times.
std::optional<std::vector<Trajectory>> PlaceSteps::search_with_times(Level& level,
                                                                     std::size_t max_configurations,
                                                                     const StopCondition& stop) {
  const auto outcome =
      level.timed->run(std::min(max_configurations, kMaxRestsWithTimes / robots_.size()), stop);
  level.is_done = outcome != TimedStepSearch::Outcome::cut_off;
  if (outcome != TimedStepSearch::Outcome::found) return std::nullopt;
  return times_of_steps(reservations_, robots_, level.steps, level.timed->plan(), stop);
}

bool PlaceSteps::are_few() const { return robots_.size() <= kFewOnPlaces; }

}  // namespace fleetplan::core
