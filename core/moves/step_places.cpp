#include "core/moves/step_places.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <unordered_map>
#include <utility>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/moves/making_room.h"
#include "core/moves/sparse_vertices.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {
namespace {

/// The most places of all robots together, and the steps from each of them on average: 40 MB.
constexpr std::size_t kMaxPlaces = 600'000;
/// Places between two checks of the stop condition.
constexpr std::size_t kPlacesBetweenPolls = 256;
constexpr std::size_t kWallsBetweenPolls = 8;
/// The most places at walls of one robot.
constexpr std::size_t kMaxAtWalls = 400;
/// Places at walls are farther than this from a vertex, in spacings of the lattice.
constexpr double kLeastRoom = 0.1;
constexpr float kNoWay = std::numeric_limits<float>::infinity();

/// A robot that stays.
struct Resting {
  Position position{0.0, 0.0};
  double radius = 0.0;  // metres, to other robots
};

/// Places where a robot touches walls, beside vertices of its lattice. In narrow corridors, two robots can
/// pass each other only along the walls. The same holds for passing a robot in a dead end.
class PlacesAtWalls {
 public:
  /// `vertices` are those with this view.
  PlacesAtWalls(const Vertices& vertices, const View& view, const StopCondition& stop)
      : vertices_(vertices),
        view_(view),
        stop_(stop, kWallsBetweenPolls),
        narrow_(4.0 * view.body.pair_radius) {}

  /// Beside the vertices that can be reached from this one.
  std::vector<Position> find(int start) {
    std::vector<bool> seen(static_cast<std::size_t>(vertices_.count()), false);
    std::vector<int> reached{start};
    seen[static_cast<std::size_t>(start)] = true;
    for (std::size_t k = 0; k < reached.size() && found_.size() < kMaxAtWalls && !stop_.met_at_step(); ++k) {
      if (reached[k] < vertices_.lattice().vertex_count()) add_beside(vertices_.position(reached[k]));
      vertices_.for_each_neighbour(reached[k], [&](int next) {
        if (seen[static_cast<std::size_t>(next)] || !vertices_.allow(reached[k], next)) return;
        seen[static_cast<std::size_t>(next)] = true;
        reached.push_back(next);
      });
    }
    return std::move(found_);
  }

 private:
  void add_beside(const Position& position) {
    static const std::array<Position, 4> kDirections{Position(1.0, 0.0), Position(0.0, 1.0),
                                                     Position(-1.0, 0.0), Position(0.0, -1.0)};
    const double spacing = vertices_.lattice().spacing();
    std::array<double, 4> room{};
    for (std::size_t k = 0; k < kDirections.size(); ++k)
      room[k] = room_towards(view_, position, kDirections[k], narrow_);
    if (room[0] + room[2] >= narrow_ && room[1] + room[3] >= narrow_) return;
    for (std::size_t k = 0; k < kDirections.size(); ++k) {
      if (room[k] < spacing && room[k] > kLeastRoom * spacing)
        found_.emplace_back(position + room[k] * kDirections[k]);
    }
  }

  const Vertices& vertices_;
  const View& view_;
  StopStride stop_;
  const double narrow_;  // metres
  std::vector<Position> found_;
};

/// Finds the places of one robot, in the order in which a search from its start reaches them.
class PlaceSearch {
 public:
  PlaceSearch(const Instance& instance, std::size_t robot, const std::vector<Resting>& resting,
              const std::vector<Position>& wanted, const StopCondition& stop)
      : instance_(instance),
        itinerary_(instance.itinerary(robot)),
        views_(instance.views(robot)),
        resting_(resting),
        condition_(stop),
        stop_(stop, kPlacesBetweenPolls),
        last_stage_(static_cast<std::uint32_t>(itinerary_.goals.size()) - (itinerary_.yields() ? 1U : 0U)) {
    for (std::size_t stage = 0; stage <= last_stage_; ++stage) {
      const std::size_t view = views_.number(stage);
      if (view < vertices_.size()) continue;
      vertices_.push_back(vertices_with(wanted, robot, stage, stop));
    }
  }

  /// Leaves out most vertices, see SparseVertices.
  void make_sparse(const std::vector<Position>& wanted, double spacing) {
    // Bounded: the goals of one robot, for each of its few loads.
    for (std::size_t stage = 0; stage <= last_stage_; ++stage) {
      if (condition_.met()) return;
      if (views_.number(stage) < sparse_.size()) continue;
      const Vertices& vertices = *vertices_[views_.number(stage)];
      std::vector<int> required;
      if (vertices.start() >= 0) required.push_back(vertices.start());
      for (std::size_t k = 0; k < itinerary_.goals.size(); ++k) {
        if (vertices.goals()[k].vertex >= 0) required.push_back(vertices.goals()[k].vertex);
      }
      sparse_.push_back(std::make_unique<SparseVertices>(vertices, required, wanted, spacing, condition_));
    }
  }

  std::optional<StepPlaces> run(std::size_t max_places) {
    if (condition_.met()) return std::nullopt;
    for (const auto& vertices : vertices_) {
      if (!vertices->finished()) return std::nullopt;
    }
    found_.last_stage = last_stage_;
    const int start = vertices(0).start();
    add(stage_after(0, start, itinerary_.pose.position), start);
    // Bounded: each place is expanded once.
    for (std::size_t k = 0; k < found_.places.size(); ++k) {
      if (stop_.met_at_step() || found_.places.size() > max_places) return std::nullopt;
      expand(static_cast<int>(k));
    }
    if (!itinerary_.yields() && !find_last_goal()) return std::nullopt;
    find_ways();
    return std::move(found_);
  }

 private:
  /// The vertices of the robot, and the positions of this list where it fits.
  std::unique_ptr<Vertices> vertices_with(const std::vector<Position>& wanted, std::size_t robot,
                                          std::size_t stage, const StopCondition& stop) const {
    auto own = std::make_unique<Vertices>(instance_, robot, stage, stop);
    if (views_.change() || wanted.empty() || !own->finished()) return own;
    Itinerary with_others = itinerary_;
    const auto add = [&](const Position& position) {
      if (views_[stage].free_space->disk_fits(position, views_[stage].body.wall_radius)) {
        with_others.goals.push_back(Goal{position, std::nullopt});
      }
    };
    for (const Position& position : wanted) add(position);
    for (const Position& position : PlacesAtWalls(*own, views_[stage], stop).find(own->start()))
      add(position);
    return std::make_unique<Vertices>(instance_, robot, with_others, stage, stop);
  }

  const Vertices& vertices(std::uint32_t stage) const { return *vertices_[views_.number(stage)]; }

  /// The stage of a robot that comes to a vertex in a stage. A goal at the vertex is served, except the last
  /// goal, where the robot may come again.
  std::uint32_t stage_after(std::uint32_t stage, int vertex, const Position& position) const {
    const std::uint32_t own = last_stage_ - (itinerary_.yields() ? 0U : 1U);
    while (stage < own && vertices(stage).goals()[stage].vertex == vertex &&
           is_same_position(itinerary_.goals[stage].position, position)) {
      ++stage;
    }
    return stage;
  }

  int add(std::uint32_t stage, int vertex) {
    const std::uint64_t key = (std::uint64_t{stage} << 32) | static_cast<std::uint32_t>(vertex);
    const auto [known, is_new] = ids_.try_emplace(key, static_cast<int>(found_.places.size()));
    if (!is_new) return known->second;
    StepPlaces::Place place;
    place.position = vertices(stage).position(vertex);
    place.stage = stage;
    place.radius = views_[stage].body.pair_radius;
    if (ends_at(place, vertex)) place.radius = std::max(place.radius, views_[last_stage_].body.pair_radius);
    place.to_go = kNoWay;
    found_.places.push_back(place);
    vertex_of_.push_back(vertex);
    return known->second;
  }

  void expand(int id) {
    const auto k = static_cast<std::size_t>(id);
    const StepPlaces::Place place = found_.places[k];
    found_.places[k].first = static_cast<std::uint32_t>(found_.steps.size());
    if (ends_at(place, vertex_of_[k])) return;
    const Vertices& here = vertices(place.stage);
    const int from = vertex_of_[k];
    const auto visit = [&](int to) {
      if (to == from || !here.allow(from, to)) return;
      const Segment way{place.position, here.position(to)};
      if (meets_resting(way, place.radius, id == 0)) return;
      const std::uint32_t stage = stage_after(place.stage, to, way.to);
      const int next = vertex_in(stage, place.stage, to, way.to);
      if (next < 0) return;
      const int target = add(stage, next);
      found_.steps.push_back({target, static_cast<float>(way.length())});
    };
    if (sparse_.empty()) {
      here.for_each_neighbour(from, visit);
    } else {
      for (const int to : sparse_[views_.number(place.stage)]->steps_from(from)) visit(to);
    }
  }

  /// Whether a robot that rests there has another load from then on, and so stays: it is served for good.
  bool ends_at(const StepPlaces::Place& place, int vertex) const {
    if (itinerary_.yields() || place.stage + 1 != last_stage_) return false;
    return views_.number(place.stage) != views_.number(last_stage_) &&
           vertices(place.stage).goals()[place.stage].vertex == vertex;
  }

  /// The number of a vertex among the vertices of another stage, where a goal is served.
  int vertex_in(std::uint32_t stage, std::uint32_t before, int vertex, const Position& position) const {
    if (views_.number(stage) == views_.number(before)) return vertex;
    const auto& goals = vertices(stage).goals();
    for (std::uint32_t goal = before; goal < stage; ++goal) {
      if (is_same_position(itinerary_.goals[goal].position, position)) return goals[goal].vertex;
    }
    return -1;
  }

  bool meets_resting(const Segment& way, double radius, bool from_start) const {
    return std::any_of(resting_.begin(), resting_.end(), [&](const Resting& other) {
      double reach = radius + other.radius - kSearchSlack;
      if (from_start) reach = std::min(reach, (other.position - way.from).norm() - kSamePosition);
      return distance_to_segment(other.position, way) < reach;
    });
  }

  bool find_last_goal() {
    const std::uint32_t stage = last_stage_ - 1;
    const int vertex = vertices(stage).goals()[stage].vertex;
    const auto known = ids_.find((std::uint64_t{stage} << 32) | static_cast<std::uint32_t>(vertex));
    if (known == ids_.end()) return false;
    found_.last_goal = known->second;
    return true;
  }

  /// Sets how far each place is from the end: Dijkstra's search backwards.
  void find_ways() {
    std::vector<StepPlaces::Place>& places = found_.places;
    std::vector<std::uint32_t> first(places.size() + 1, 0);
    for (const StepPlaces::Step& step : found_.steps) ++first[static_cast<std::size_t>(step.to) + 1];
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    std::vector<StepPlaces::Step> back(found_.steps.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (const StepPlaces::Step& step : found_.steps_from(static_cast<int>(k))) {
        back[next[static_cast<std::size_t>(step.to)]++] = {static_cast<int>(k), step.length};
      }
    }
    using Open = std::pair<float, int>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!found_.is_end(static_cast<int>(k))) continue;
      places[k].to_go = 0.0F;
      open.emplace(0.0F, static_cast<int>(k));
    }
    while (!open.empty() && !stop_.met_at_step()) {
      const auto [far, at] = open.top();
      open.pop();
      const auto here = static_cast<std::size_t>(at);
      if (far > places[here].to_go) continue;
      for (std::size_t k = first[here]; k < first[here + 1]; ++k) {
        float& to_go = places[static_cast<std::size_t>(back[k].to)].to_go;
        if (!(far + back[k].length < to_go)) continue;
        to_go = far + back[k].length;
        open.emplace(to_go, back[k].to);
      }
    }
  }

  const Instance& instance_;
  const Itinerary& itinerary_;
  const Views& views_;
  const std::vector<Resting>& resting_;
  const StopCondition& condition_;
  StopStride stop_;
  const std::uint32_t last_stage_;
  std::vector<std::unique_ptr<Vertices>> vertices_;      // by number of the view
  std::vector<std::unique_ptr<SparseVertices>> sparse_;  // by number of the view; empty: all vertices
  std::unordered_map<std::uint64_t, int> ids_;
  std::vector<int> vertex_of_;  // by place
  StepPlaces found_;
};

}  // namespace

std::optional<std::vector<StepPlaces>> places_of_steps(const FleetReservations& reservations,
                                                       const std::vector<std::size_t>& robots, double sparse,
                                                       const StopCondition& stop) {
  const Instance& instance = reservations.instance();
  std::vector<bool> moves(instance.size(), false);
  for (const std::size_t robot : robots) moves[robot] = true;
  std::vector<Resting> resting;
  for (std::size_t i = 0; i < instance.size(); ++i) {
    if (moves[i] || !reservations.stays(i)) continue;
    resting.push_back({instance.itinerary(i).pose.position, instance.views(i).largest_disk().pair_radius});
  }
  std::vector<Position> wanted;
  double widest = 0.0;
  for (const std::size_t robot : robots) {
    wanted.push_back(instance.itinerary(robot).pose.position);
    for (const Goal& goal : instance.itinerary(robot).goals) wanted.push_back(goal.position);
    widest = std::max(widest, instance.views(robot).largest_disk().pair_radius);
  }
  std::vector<StepPlaces> all;
  std::size_t left = kMaxPlaces;
  for (const std::size_t robot : robots) {
    PlaceSearch search(instance, robot, resting, sparse > 0.0 ? wanted : std::vector<Position>{}, stop);
    if (sparse > 0.0) search.make_sparse(wanted, 2.0 * widest * sparse);
    auto places = search.run(left);
    if (!places || stop.met() || !(places->places.front().to_go < kForever)) return std::nullopt;
    left -= std::min(left, places->places.size());
    all.push_back(std::move(*places));
  }
  return all;
}

}  // namespace fleetplan::core
