#include "core/sipp/search_space.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/instance/static_fit.h"
#include "core/map/refinement.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// Own vertices are linked to vertices within this distance, in lattice spacings.
constexpr double kLinkDistance = 2.0;
/// A start that is too near to others is linked to vertices within this distance if the robot is clear of
/// them only there, in lattice spacings.
constexpr double kLongestLink = 12.0;
/// Comparisons of own vertices and links between two checks of the stop condition.
constexpr std::size_t kWorkBetweenPolls = 16 * 1024;

}  // namespace

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage)
    : stage_(stage),
      motion_(instance.stages(robot)[stage].motion),
      zones_(instance.stages(robot)[stage].zones.get()),
      slowest_motion_(motion_),
      lattice_(instance.lattice(robot)),
      grid_(instance.problem().grid()),
      space_(*instance.stages(robot)[stage].free_space),
      finer_(space_.finer()),
      first_own_(lattice_.vertex_count() + finer_.count()),
      any_angle_(instance.options().any_angle),
      start_pose_(instance.itinerary(robot).pose) {
  if (limit_speeds()) slowest_motion_.angular_speed = zones_->least_angular_speed();
}

Vertices::Vertices(const Instance& instance, std::size_t robot, const Goal& goal)
    : Vertices(instance, robot, std::size_t{0}) {
  goals_.push_back({add_goal(instance, robot, goal.position), goal.theta});
  early_own_ = own_.size();  // NOLINT(*-prefer-member-initializer): the constructor delegates
}

void Vertices::begin_at(const Instance& instance, std::size_t robot) {
  // Bounded: the own vertices of a goal, and their links.
  own_.resize(early_own_);
  for (OwnVertex& own : own_) std::erase_if(own.links, [&](int link) { return link >= first_late(); });
  first_inside_ = std::numeric_limits<int>::max();
  end_inside_ = 0;
  outside_ = -1;
  start_pose_ = instance.itinerary(robot).pose;
  const int goal = goals_.front().vertex;
  start_ = is_same_position(start_pose_.position, position(goal)) ? goal : add_start(instance, robot);
  never_entered_ = start_ != goal && !is_clear_at_start(instance, robot) ? start_ : -1;
}

Vertices::Vertices(const Instance& instance, std::size_t robot, std::size_t stage, const StopCondition& stop)
    : Vertices(instance, robot, stage) {
  const Load& load = instance.stages(robot)[stage].load;
  if (instance.stages(robot)[0].load == load) start_ = add_start(instance, robot);
  if (start_ >= 0 && !is_clear_at_start(instance, robot)) never_entered_ = start_;
  // Committed actions that end in contact with the goal end there: a service goes on, without a move.
  double same = instance.robot(robot).committed.empty() ? kSamePosition : kContactTolerance;
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  std::size_t work = 0;  // since the last check
  for (std::size_t k = 0; k < goals.size(); ++k) {
    work += 1 + 2 * own_.size() + (own_.empty() ? 0 : own_.back().links.size());
    if (work >= kWorkBetweenPolls) {
      work = 0;
      if (stop.met()) {
        finished_ = false;
        return;
      }
    }
    const Goal& goal = goals[k];
    if (goal.anywhere) {  // wherever the robot comes to this stage
      goals_.push_back({goals_.empty() ? start_ : goals_.back().vertex, std::nullopt});
      continue;
    }
    const bool is_here = instance.stages(robot)[k].load == load || instance.stages(robot)[k + 1].load == load;
    const bool at_start = start_ >= 0 && (goal.position - start_pose_.position).norm() <= same;
    const int vertex = at_start ? start_ : is_here ? add_goal(instance, robot, goal.position) : -1;
    goals_.push_back({vertex, goal.theta});
    same = kSamePosition;
  }
}

int Vertices::add_start(const Instance& instance, std::size_t robot) {
  const Leaving* leaving = instance.problem().leaving(robot);
  if (leaving != nullptr && !leaving->way_out.empty()) return add_way_out(leaving->way_out);
  const Position& position = start_pose_.position;
  const double radius = radius_at_start(instance, robot);
  const double too_near = instance.problem().one_at_a_time() ? 0.0 : instance.contacts().deficit(robot);
  const double deficit = std::max(motion_.radius - radius, too_near);
  const int vertex = vertex_at(position);
  if (vertex >= 0 && radius == motion_.radius && deficit <= kContactTolerance) return vertex;
  // Two metres for one that is missing: the way need not lead straight away from the others.
  const double reach = std::min(kLinkDistance * lattice_.spacing() + 2.0 * deficit,
                                std::max(kLinkDistance, kLongestLink) * lattice_.spacing());
  return add({position, radius, deficit <= kContactTolerance ? kForever : reach, {}}, reach);
}

int Vertices::add_way_out(const std::vector<Position>& way) {
  const auto add_inside = [&](const Position& position) {
    const int id = count();
    OwnVertex own{position, motion_.radius, kForever, {}};
    if (!own_.empty()) {
      own.links.push_back(id - 1);
      own_.back().links.push_back(id);
    }
    own_.push_back(std::move(own));
  };
  const int start = count();
  add_inside(start_pose_.position);
  for (std::size_t k = 0; k + 1 < way.size(); ++k) add_inside(way[k]);
  const int last_inside = count() - 1;
  outside_ = vertex_at(way.back());
  if (outside_ < 0)
    outside_ = add({way.back(), motion_.radius, kForever, {}}, kLinkDistance * lattice_.spacing());
  const auto link = [&](int from, int to) {
    std::vector<int>& links = own_[own_index(from)].links;
    links.insert(std::lower_bound(links.begin(), links.end(), to), to);
  };
  link(last_inside, outside_);
  if (is_own(outside_)) link(outside_, last_inside);
  first_inside_ = start;
  end_inside_ = last_inside + 1;
  return start;
}

int Vertices::vertex_at(const Position& position) const {
  const int vertex = lattice_.vertex_at(position);
  if (vertex >= 0 || finer_.count() == 0) return vertex;
  const std::vector<int> near = finer_.near(position, kSamePosition);
  return near.empty() ? -1 : near.front();
}

int Vertices::own_vertex_at(const Position& position) const {
  const auto own = std::find_if(own_.begin(), own_.end(), [&](const OwnVertex& vertex) {
    return is_same_position(vertex.position, position);
  });
  return own == own_.end() ? -1 : first_own_ + static_cast<int>(own - own_.begin());
}

int Vertices::add_goal(const Instance& instance, std::size_t robot, const Position& position) {
  const double radius = radius_at_goal(instance, robot, position, stage_);
  const int vertex = vertex_at(position);
  if (vertex >= 0 && radius == motion_.radius) return vertex;
  const int own = own_vertex_at(position);
  if (own >= 0) return own;
  return add({position, radius, kForever, {}}, kLinkDistance * lattice_.spacing());
}

int Vertices::add(const OwnVertex& own, double reach) {
  const int id = add_linked(own, reach);
  if (!own_.back().links.empty() ||
      !may_need_refinement(grid_, lattice_, motion_.radius, space_.among_polygons()))
    return id;
  const FineLattice nodes(grid_, lattice_, motion_.radius);
  for (const Position& place : way_to_lattice(own.position, own.radius, nodes, lattice_, space_)) {
    add_linked({place, motion_.radius, kForever, {}}, reach);
  }
  return id;
}

int Vertices::add_linked(OwnVertex own, double reach) {
  std::vector<int> all = lattice_.vertices_near(own.position, reach);
  for (const int near : finer_.near(own.position, reach)) all.push_back(near);
  for (const int near : all) {
    const Position to = position(near);
    if (is_same_position(to, own.position)) continue;
    const bool clear = own.radius == motion_.radius || space_.disk_fits(to, motion_.radius);
    if (clear && may_move(own, to, motion_.radius)) own.links.push_back(near);
  }
  const int id = count();
  for (std::size_t k = 0; k < own_.size(); ++k) {  // start and goal near each other
    const bool near = (own_[k].position - own.position).norm() <= reach;
    if (!near || !may_move(own, own_[k].position, own_[k].radius)) continue;
    own.links.push_back(first_own_ + static_cast<int>(k));
    own_[k].links.push_back(id);
  }
  own_.push_back(std::move(own));
  return id;
}

/// `radius`: at the other end.
bool Vertices::may_move(const OwnVertex& own, const Position& to, double radius) const {
  const bool within_reach = (to - own.position).norm() <= own.reach;
  return space_.may_sweep(own.position, to, within_reach ? std::min(own.radius, radius) : motion_.radius);
}

bool Vertices::linked(const OwnVertex& own, int vertex) {
  if (own.links.empty() || vertex < own.links.front() || vertex > own.links.back()) return false;
  return std::binary_search(own.links.begin(), own.links.end(), vertex);
}

std::vector<DriveZones::Piece> Vertices::pieces(const Segment& path) const {
  if (limit_speeds()) return zones_->pieces(path.from, path.to);
  DriveZones::Piece piece{path, motion_.linear_speed, 0.0, motion_.translation_time(path.length())};
  if (motion_.linear_inertia.is_limited) {
    piece.profile = fastest_profile(path.length(), motion_.linear_speed, motion_.linear_inertia);
  }
  return {piece};
}

bool Vertices::is_free(int from, int to) const {
  if (is_inside(from) || is_inside(to)) return leads_out(from, to);
  if (is_own(from)) return may_move(own_[own_index(from)], position(to), radius(to));
  if (is_own(to)) return may_move(own_[own_index(to)], position(from), motion_.radius);
  return space_.may_sweep(position(from), position(to), motion_.radius);
}

std::uint32_t Vertices::free_steps(int vertex) const { return space_.steps_from(vertex); }

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop)
    : instance_(instance),
      robot_(robot),
      itinerary_(instance.itinerary(robot)),
      begins_in_goal_pose_(!instance.robot(robot).committed.empty() && !itinerary_.goals.empty() &&
                           is_in_pose(itinerary_.pose, itinerary_.goals.front())),
      costs_to_go_(goal_count()) {
  while (goals_at_start_ < goal_count() &&
         itinerary_.goals[goals_at_start_].position == itinerary_.pose.position) {
    ++goals_at_start_;
  }
  layers_.push_back({std::make_unique<Vertices>(instance, robot, 0, stop), 0});
  if (changes_load() && finished()) add_layers(stop);
  if (finished()) find_equal_goals();
}

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, const Goal& goal)
    : instance_(instance),
      robot_(robot),
      own_itinerary_{.committed = {}, .pose = instance.itinerary(robot).pose, .visited = {}, .goals = {goal}},
      itinerary_(own_itinerary_),
      begins_in_goal_pose_(false),
      first_equal_{0},
      costs_to_go_(1) {
  layers_.push_back({std::make_unique<Vertices>(instance, robot, goal), 0});
  cost_to_go(0);  // before there is a start
}

void SearchSpace::begin_at(std::size_t robot, bool any_heading) {
  robot_ = robot;
  any_heading_at_start_ = any_heading;
  own_itinerary_.pose = instance_.itinerary(robot).pose;
  layers_.front().vertices->begin_at(instance_, robot);
  cost_to_go(0).begin_late();
}

void SearchSpace::add_layers(const StopCondition& stop) {
  std::map<Load, std::size_t> layer_of_load{{instance_.stages(robot_)[0].load, 0}};
  for (std::size_t stage = 0; stage <= goal_count(); ++stage) {
    const auto [known, is_new] = layer_of_load.emplace(instance_.stages(robot_)[stage].load, layers_.size());
    layer_of_stage_.push_back(known->second);
    if (!is_new) continue;
    const int first_vertex = vertex_count();
    layers_.push_back({std::make_unique<Vertices>(instance_, robot_, stage, stop), first_vertex});
    if (!finished()) return;
  }
}

void SearchSpace::find_equal_goals() {
  using Kind = std::tuple<int, std::optional<double>>;  // vertex, as first_vertex() numbers them, and heading
  std::map<Kind, std::size_t> first;
  for (std::size_t k = 0; k < goal_count(); ++k) {
    first_equal_.push_back(
        first.emplace(Kind(first_vertex(k) + goal(k).vertex, goal(k).heading), k).first->second);
  }
}

CostToGo& SearchSpace::cost_to_go(std::size_t goal) {
  auto& known = costs_to_go_[first_equal_[goal]];
  if (!known) known = std::make_unique<CostToGo>(vertices(goal), first_equal_[goal]);
  return *known;
}

std::int64_t SearchSpace::expansions() const {
  std::int64_t expansions = 0;
  for (const auto& cost : costs_to_go_) expansions += cost ? cost->expansions() : 0;
  return expansions;
}

std::size_t SearchSpace::bytes() const {
  std::size_t bytes = 0;
  for (const auto& cost : costs_to_go_) bytes += cost ? cost->bytes() : 0;
  return bytes;
}

namespace {

/// The most memory for the search spaces of all robots.
constexpr std::size_t kMaxBytes = std::size_t{384} << 20;

/// Whether so many bytes are too much to keep. Half of the job's memory is for the rest.
bool is_too_much(std::size_t bytes) {
  const MemoryAccount* account = MemoryScope::current();
  return bytes >= kMaxBytes || (account != nullptr && account->used() > account->limit() / 2);
}

}  // namespace

SearchSpaces::SearchSpaces(const Instance& instance) : instance_(instance), entries_(instance.size()) {}

SearchSpace* SearchSpaces::of(std::size_t robot, const StopCondition& stop) {
  if (!entries_[robot].space) {
    make_room();
    auto made = std::make_unique<SearchSpace>(instance_, robot, stop);
    if (!made->finished()) return nullptr;
    entries_[robot].space = std::move(made);
  }
  entries_[robot].last_use = ++calls_;
  return entries_[robot].space.get();
}

void SearchSpaces::discard_all() {
  for (Entry& entry : entries_) entry.space.reset();
}

/// Discards half of what is kept if it is too much.
void SearchSpaces::make_room() {
  std::size_t bytes = 0;
  std::vector<Entry*> kept;
  for (Entry& entry : entries_) {
    if (!entry.space) continue;
    bytes += entry.space->bytes();
    kept.push_back(&entry);
  }
  if (!is_too_much(bytes)) return;
  std::sort(kept.begin(), kept.end(),
            [](const Entry* a, const Entry* b) { return a->last_use < b->last_use; });
  const std::size_t enough = bytes / 2;
  for (Entry* entry : kept) {
    if (bytes <= enough) return;
    bytes -= entry->space->bytes();
    entry->space.reset();
  }
}

}  // namespace fleetplan::core
