#include "core/instance/robot_stages.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace fleetplan::core {
namespace {

/// Makes the stages of robots, which share what is the same for them.
class StageMaker {
 public:
  StageMaker(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : problem_(problem),
        options_(options),
        stop_(stop),
        any_drive_zone_(std::any_of(problem.zones().begin(), problem.zones().end(),
                                    [](const Zone& zone) { return zone.type != Zone::Type::blocked; })) {}

  RobotStages stages_of(std::size_t index, const Itinerary& itinerary, const Lattice& lattice) {
    const Robot& robot = problem_.robots()[index];
    const double largest = largest_radius(robot);
    return {loads(index, itinerary.first_goal, lattice),
            LargestDisk{largest, largest + options_.inflation + robot.vicinity}};
  }

 private:
  std::vector<LoadedRobot> loads(std::size_t index, std::size_t first_goal, const Lattice& lattice) {
    const Robot& robot = problem_.robots()[index];
    std::optional<DriveZones> zones;  // with the first load
    if (any_drive_zone_) zones.emplace(problem_.zones(), index, robot);
    if (!changes_load(robot)) return {with_load(index, first_load(robot), zones, lattice)};
    const std::vector<Load> loads = loads_of(robot);
    const auto first = loads.begin() + static_cast<std::ptrdiff_t>(first_goal);
    const bool is_one = std::all_of(first, loads.end(), [&](const Load& load) { return load == *first; });
    std::map<Load, LoadedRobot> known;
    std::vector<LoadedRobot> stages;
    for (auto load = first; load != (is_one ? first + 1 : loads.end()); ++load) {
      const auto [stage, is_new] = known.try_emplace(*load);
      if (is_new) stage->second = with_load(index, *load, zones, lattice);
      stages.push_back(stage->second);
    }
    return stages;
  }

  LoadedRobot with_load(std::size_t index, const Load& load, const std::optional<DriveZones>& zones,
                        const Lattice& lattice) {
    const Motion motion = motion_of(problem_.robots()[index], options_, load);
    LoadedRobot stage{load, motion, free_space(lattice, *problem_.map_of(index), motion.wall_radius),
                      nullptr};
    if (!zones) return stage;
    auto loaded = std::make_shared<const DriveZones>(zones->with(load));
    if (!loaded->empty()) stage.zones = std::move(loaded);
    return stage;
  }

  std::shared_ptr<FreeSpace> free_space(const Lattice& lattice, const StaticMap& map, double radius) {
    auto& space = free_spaces_[{lattice.spacing(), radius, &map}];
    if (!space) {
      auto finer = map.finer_vertices(lattice, radius, stop_);
      space = std::make_shared<FreeSpace>(lattice, map.sight(), radius, std::move(finer));
    }
    return space;
  }

  using SpaceKind = std::tuple<double, double, const StaticMap*>;  // spacing of the lattice, radius and map

  const Problem& problem_;
  const PlanOptions& options_;
  const StopCondition& stop_;
  const bool any_drive_zone_;
  std::map<SpaceKind, std::shared_ptr<FreeSpace>> free_spaces_;
};

}  // namespace

const Motion& RobotStages::slimmest_motion() const {
  return std::min_element(loads_.begin(), loads_.end(),
                          [](const LoadedRobot& a, const LoadedRobot& b) {
                            return a.motion.wall_radius < b.motion.wall_radius;
                          })
      ->motion;
}

double RobotStages::longest_plan() const {
  double slowest = loads_.front().motion.linear_speed;
  for (const LoadedRobot& stage : loads_) slowest = std::min(slowest, stage.motion.linear_speed);
  return std::min(kLongestPlan, kLongestTravel / slowest);
}

std::vector<RobotStages> stages_of_robots(const Problem& problem, const PlanOptions& options,
                                          const std::vector<Itinerary>& itineraries,
                                          const std::vector<std::shared_ptr<const Lattice>>& lattices,
                                          const StopCondition& stop) {
  StageMaker maker(problem, options, stop);
  std::vector<RobotStages> stages;
  for (std::size_t i = 0; i < itineraries.size(); ++i) {
    stages.push_back(maker.stages_of(i, itineraries[i], *lattices[i]));
  }
  return stages;
}

}  // namespace fleetplan::core
