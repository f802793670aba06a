#include "core/moves/place_steps.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/moves/joint_steps.h"
#include "core/moves/pushing_search.h"
#include "core/moves/single_move_search.h"
#include "core/moves/step_places.h"
#include "core/moves/step_times.h"

namespace fleetplan::core {
namespace {

/// How far places are from each other, in distances of two robots in contact; 0: all vertices.
constexpr std::array kPlaceSpacings{1.0, 0.5, 0.25, 0.0};
/// The configurations of each search after which others go on. At the end they are 16 MB for six robots.
constexpr std::array<std::size_t, 3> kMaxConfigurations{3'000, 30'000, 300'000};
/// For more robots than a few, of all rounds.
constexpr std::size_t kMaxConfigurationsOfMany = 30'000;
/// The most robots that are moved one at a time at first: for more of them, there are too many
/// configurations.
constexpr std::size_t kFewOnPlaces = 6;
/// The most robots at all: each is compared with each other one.
constexpr std::size_t kMaxOnPlaces = 256;

}  // namespace

/// The searches over places of one spacing.
struct PlaceSteps::Level {
  explicit Level(std::vector<StepPlaces> all) : places(std::move(all)), steps(places), single(steps) {}

  const std::vector<StepPlaces> places;
  const JointSteps steps;
  SingleMoveSearch single;
  bool has_pushed = false;
  bool is_done = false;
};

PlaceSteps::PlaceSteps(FleetReservations& reservations, std::vector<std::size_t> robots, Random& random)
    : reservations_(reservations), robots_(std::move(robots)), random_(random) {}

PlaceSteps::~PlaceSteps() = default;

std::optional<std::vector<Trajectory>> PlaceSteps::run(const StopCondition& stop) {
  if (robots_.size() > kMaxOnPlaces) return std::nullopt;
  // Bounded: a few rounds over a few levels.
  for (const std::size_t max_configurations : kMaxConfigurations) {
    for (std::size_t number = 0; number < kPlaceSpacings.size(); ++number) {
      if (stop.met()) return std::nullopt;
      Level* const level = this->level(number, stop);
      if (level == nullptr || level->is_done) continue;
      const auto plan = search(*level, number, max_configurations, stop);
      if (!plan) continue;
      auto trajectories = times_of_steps(reservations_, robots_, level->steps, *plan, stop);
      if (trajectories) return trajectories;
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

std::optional<std::vector<Configuration>> PlaceSteps::search(Level& level, std::size_t number,
                                                             std::size_t max_configurations,
                                                             const StopCondition& stop) {
  if (robots_.size() > kFewOnPlaces && !std::exchange(level.has_pushed, true)) {
    auto plan = plan_by_pushing(level.steps, random_, stop);
    if (plan || stop.met()) return plan;
  }
  const bool are_few = robots_.size() <= kFewOnPlaces;
  const SingleMoveSearch::Outcome outcome = level.single.run(
      are_few ? max_configurations : std::min(max_configurations, kMaxConfigurationsOfMany), stop);
  level.is_done = outcome != SingleMoveSearch::Outcome::cut_off;
  if (outcome == SingleMoveSearch::Outcome::found) return level.single.plan();
  has_no_way_ = has_no_way_ || (level.is_done && kPlaceSpacings[number] == 0.0);
  return std::nullopt;
}

}  // namespace fleetplan::core
