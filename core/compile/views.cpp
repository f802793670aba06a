#include "core/compile/views.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace fleetplan::core {
namespace {

/// Makes the views of robots, which share what is the same for them.
class ViewMaker {
 public:
  ViewMaker(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : problem_(problem),
        options_(options),
        stop_(stop),
        any_drive_zone_(std::any_of(problem.zones().begin(), problem.zones().end(),
                                    [](const Zone& zone) { return zone.type != Zone::Type::blocked; })) {}

  Views views_of(std::size_t index, const Itinerary& itinerary, const Lattice& lattice) {
    const Robot& robot = problem_.robots()[index];
    const double largest = itinerary.largest_radius();
    const LargestDisk disk{largest, largest + options_.inflation + robot.vicinity};
    std::optional<DriveZones> zones;  // with the first load
    if (any_drive_zone_) zones.emplace(problem_.zones(), index, robot);
    if (!changes_load(robot)) return {with_load(index, first_load(robot), zones, lattice), disk};
    const std::vector<Load> loads = loads_of(robot);
    std::map<Load, std::uint32_t> known;
    std::vector<View> views;
    std::vector<std::uint32_t> of_stages;
    for (std::size_t k = itinerary.first_goal; k < loads.size(); ++k) {
      const auto [number, is_new] = known.try_emplace(loads[k], static_cast<std::uint32_t>(views.size()));
      if (is_new) views.push_back(with_load(index, loads[k], zones, lattice));
      of_stages.push_back(number->second);
    }
    if (views.size() == 1) return {std::move(views.front()), disk};
    return {std::move(views), std::move(of_stages), disk};
  }

 private:
  View with_load(std::size_t index, const Load& load, const std::optional<DriveZones>& zones,
                 const Lattice& lattice) {
    const Body body = body_of(problem_.robots()[index], options_, load);
    View view{body, free_space(lattice, *problem_.map_of(index), body.wall_radius), nullptr};
    if (!zones) return view;
    auto loaded = std::make_shared<const DriveZones>(zones->with(load));
    if (!loaded->empty()) view.zones = std::move(loaded);
    return view;
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

std::vector<Body> Views::bodies(std::size_t stages) const {
  std::vector<Body> bodies;
  bodies.reserve(stages);
  for (std::size_t stage = 0; stage < stages; ++stage) bodies.push_back((*this)[stage].body);
  return bodies;
}

const Body& Views::slimmest_body() const {
  return std::min_element(
             views_.begin(), views_.end(),
             [](const View& a, const View& b) { return a.body.wall_radius < b.body.wall_radius; })
      ->body;
}

double Views::longest_plan() const {
  double slowest = views_.front().body.linear_speed;
  for (const View& view : views_) slowest = std::min(slowest, view.body.linear_speed);
  return std::min(kLongestPlan, kLongestTravel / slowest);
}

std::vector<Views> views_of_robots(const Problem& problem, const PlanOptions& options,
                                   const std::vector<Itinerary>& itineraries,
                                   const std::vector<std::shared_ptr<const Lattice>>& lattices,
                                   const StopCondition& stop) {
  ViewMaker maker(problem, options, stop);
  std::vector<Views> views;
  for (std::size_t i = 0; i < itineraries.size(); ++i) {
    views.push_back(maker.views_of(i, itineraries[i], *lattices[i]));
  }
  return views;
}

}  // namespace fleetplan::core
