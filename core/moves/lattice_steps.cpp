#include "core/moves/lattice_steps.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <utility>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/moves/lacam.h"

namespace fleetplan::core {
namespace {

/// The root of 1.25. If two neighbouring vertices are farther than so many spacings from a point, every part
/// of the step between them is at least one spacing from it.
constexpr double kClear = 1.1181;
/// The most vertices of all graphs together: 64 MB.
constexpr std::size_t kMaxVertices = 4'000'000;

bool is_simple(const Instance& instance, std::size_t robot) {
  const Itinerary& itinerary = instance.itinerary(robot);
  return itinerary.goals.size() == 1 && !itinerary.goals.front().anywhere &&
         !instance.views(robot).change() && instance.views(robot)[0].zones == nullptr;
}

/// Makes the graph of a fleet's steps, if it has one.
class StepGraph {
 public:
  StepGraph(const FleetReservations& reservations, const std::vector<std::size_t>& robots)
      : reservations_(reservations), instance_(reservations.instance()), robots_(robots) {}

  std::optional<StepProblem> make(const StopCondition& stop) {
    const PlanOptions& options = instance_.options();
    if (robots_.empty() || !instance_.problem().obstacles().empty()) return std::nullopt;
    if (options.horizon || options.interval_margin > 0.0) return std::nullopt;
    for (std::size_t i = 0; i < instance_.size(); ++i) {
      if (instance_.itinerary(i).is_committed) return std::nullopt;
    }
    const Lattice& lattice = instance_.lattice(robots_.front());
    const auto vertices = static_cast<std::size_t>(lattice.vertex_count());
    if (robots_.size() * vertices > StepProblem::kMaxDistances) return std::nullopt;
    std::vector<bool> is_start(vertices, false);
    std::vector<bool> is_goal(vertices, false);
    StepProblem problem;
    for (const std::size_t robot : robots_) {
      if (!is_simple(instance_, robot) || &instance_.lattice(robot) != &lattice) return std::nullopt;
      widest_ = std::max(widest_, instance_.body(robot).pair_radius);
      const Itinerary& itinerary = instance_.itinerary(robot);
      const int start = lattice.vertex_at(itinerary.pose.position);
      const int goal = lattice.vertex_at(itinerary.goals.front().position);
      if (start < 0 || goal < 0) return std::nullopt;
      if (is_start[static_cast<std::size_t>(start)] || is_goal[static_cast<std::size_t>(goal)]) {
        return std::nullopt;
      }
      is_start[static_cast<std::size_t>(start)] = true;
      is_goal[static_cast<std::size_t>(goal)] = true;
      problem.movers.push_back({0, start, goal});
    }
    find_standing(lattice);
    if (2.0 * widest_ > lattice.spacing() + kSearchSlack) return std::nullopt;
    std::map<const FreeSpace*, std::size_t> known;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      FreeSpace& space = *instance_.views(robots_[k])[0].free_space;
      const auto [entry, is_new] = known.emplace(&space, problem.graphs.size());
      problem.movers[k].graph = entry->second;
      if (!is_new) continue;
      if (known.size() * vertices > kMaxVertices) return std::nullopt;
      problem.graphs.push_back(neighbours(space, lattice, stop));
      if (stop.met()) return std::nullopt;
    }
    return problem;
  }

 private:
  /// Notes which vertices robots that stay take.
  void find_standing(const Lattice& lattice) {
    taken_.assign(static_cast<std::size_t>(lattice.vertex_count()), false);
    std::vector<bool> moves(instance_.size(), false);
    for (const std::size_t robot : robots_) moves[robot] = true;
    // Bounded: the robots, each with the few vertices around it.
    for (std::size_t i = 0; i < instance_.size(); ++i) {
      if (moves[i] || !reservations_.stays(i)) continue;
      const Position& position = instance_.itinerary(i).pose.position;
      widest_ = std::max(widest_, instance_.views(i).largest_disk().pair_radius);
      const int vertex = lattice.vertex_at(position);
      if (vertex >= 0) {
        taken_[static_cast<std::size_t>(vertex)] = true;
        continue;
      }
      for (const int near : lattice.vertices_near(position, kClear * lattice.spacing())) {
        taken_[static_cast<std::size_t>(near)] = true;
      }
    }
  }

  StepProblem::Neighbours neighbours(FreeSpace& space, const Lattice& lattice,
                                     const StopCondition& stop) const {
    StepProblem::Neighbours all(
        taken_.size(), {StepProblem::kNone, StepProblem::kNone, StepProblem::kNone, StepProblem::kNone});
    StopStride stride = StopStride::from_first(stop, StepProblem::kVerticesBetweenPolls);
    for (int vertex = 0; vertex < lattice.vertex_count() && !stride.met_at_step(); ++vertex) {
      if (taken_[static_cast<std::size_t>(vertex)]) continue;
      std::uint32_t mask = space.steps_from(vertex);
      // Bounded: the steps of a lattice, at most 32.
      for (std::size_t k = 0; mask != 0; ++k, mask >>= 1) {
        const Lattice::Step step = lattice.steps()[k];
        if ((mask & 1U) == 0 || std::abs(step.columns) + std::abs(step.rows) != 1) continue;
        const int next = vertex + step.rows * lattice.columns() + step.columns;
        if (taken_[static_cast<std::size_t>(next)]) continue;
        const std::size_t direction = (step.rows != 0 ? 2U : 0U) + (step.rows + step.columns < 0 ? 1U : 0U);
        all[static_cast<std::size_t>(vertex)][direction] = next;
      }
    }
    return all;
  }

  const FleetReservations& reservations_;
  const Instance& instance_;
  const std::vector<std::size_t>& robots_;
  std::vector<bool> taken_;  // by vertex
  double widest_ = 0.0;      // metres; the largest radius of all robots
};

/// How a robot has come to a vertex, stayed there, and left it.
struct VertexStay {
  std::vector<TimedSegment> phases;  // contiguous; none if nobody has left it yet
  double radius = 0.0;               // metres, to other robots
};

/// Gives the steps times, one configuration after the other.
class TimedSteps {
 public:
  TimedSteps(const Instance& instance, const std::vector<std::size_t>& robots, const Lattice& lattice)
      : instance_(instance), lattice_(lattice), vertices_(static_cast<std::size_t>(lattice.vertex_count())) {
    for (const std::size_t robot : robots) {
      const Pose& pose = instance.itinerary(robot).pose;
      movers_.push_back({robot, {pose.position, {}}, pose.theta});
    }
  }

  void step(const Configuration& from, const Configuration& to) {
    for (std::size_t k = 0; k < from.size(); ++k) at(from[k]).robot = static_cast<int>(k);
    for (Mover& mover : movers_) mover.is_done = false;
    for (std::size_t k = 0; k < from.size(); ++k) move_with_those_ahead(k, from, to);
    for (const int vertex : from) at(vertex).robot = kNobody;
  }

  std::vector<Trajectory> finish() {
    std::vector<Trajectory> trajectories;
    for (Mover& mover : movers_) {
      const Goal& goal = instance_.itinerary(mover.robot).goals.front();
      double t = mover.arrival;
      if (goal.theta) t += instance_.body(mover.robot).rotation_time(mover.heading, *goal.theta);
      mover.trajectory.cost = goal.service_end(t);
      trajectories.push_back(std::move(mover.trajectory));
    }
    return trajectories;
  }

 private:
  static constexpr int kNobody = -1;
  struct Mover {
    std::size_t robot = 0;
    Trajectory trajectory;
    double heading = 0.0;
    double arrival = 0.0;                     // seconds
    std::vector<TimedSegment> arriving = {};  // the parts of the last step
    bool is_done = false;                     // has been given its time in this step
  };
  struct Vertex {
    int robot = kNobody;      // which one, by its place in `movers_`, begins the present step there
    VertexStay last;          // of the last robot that left
    double others_until = 0;  // seconds: when the robots before that one have arrived elsewhere
  };

  Vertex& at(int vertex) { return vertices_[static_cast<std::size_t>(vertex)]; }

  /// Those who leave vertices in this step go before those who come there.
  void move_with_those_ahead(std::size_t robot, const Configuration& from, const Configuration& to) {
    std::vector<std::size_t> chain;
    for (int next = static_cast<int>(robot); next != kNobody;) {
      const auto k = static_cast<std::size_t>(next);
      if (movers_[k].is_done || from[k] == to[k]) break;
      movers_[k].is_done = true;
      chain.push_back(k);
      next = at(to[k]).robot;
    }
    for (auto k = chain.rbegin(); k != chain.rend(); ++k) move(*k, from[*k], to[*k]);
  }

  /// The parts of a step from rest to rest that begins at time 0.
  static std::vector<TimedSegment> parts(const Body& body, const Segment& path, double duration) {
    const TimedSegment step{path, 0.0, duration};
    if (!body.linear_inertia.is_limited) return {step};
    return phases(step, fastest_profile(path.length(), body.linear_speed, body.linear_inertia));
  }

  /// The time from which on a robot may set out on a step to a vertex, after the last robot that was there.
  double free_from(const Vertex& vertex, const std::vector<TimedSegment>& step, double radius) const {
    double t = vertex.others_until;  // robots before the last one, which may be wider than it
    if (vertex.last.phases.empty()) return t;
    const double reach = radius + vertex.last.radius;
    const Position& here = step.back().path.to;
    // Bounded: at most three phases of each.
    for (const TimedSegment& other : vertex.last.phases) {
      if (!(other.duration() > 0.0)) continue;
      const MovingDisk disk(other);
      const UnsafeInterval there = unsafe_interval(here, disk, reach);
      if (!there.empty()) t = std::max(t, there.end - step.back().t_end);
      for (const TimedSegment& part : step) {
        const UnsafeInterval forbidden =
            forbidden_departures(part.path.from, part.velocity(), part.duration(), disk, reach, part.ramp);
        if (!forbidden.empty()) t = std::max(t, forbidden.end - part.t_start);
      }
    }
    return t;
  }

  void move(std::size_t k, int from, int to) {
    Mover& mover = movers_[k];
    const Body& body = instance_.body(mover.robot);
    const Segment path{lattice_.position(from), lattice_.position(to)};
    const Displacement way = lattice_.between(from, to);
    const double duration = body.translation_time(way.length);
    std::vector<TimedSegment> step = parts(body, path, duration);
    const double free = free_from(at(to), step, body.pair_radius);
    std::vector<TimedMove>& moves = mover.trajectory.moves;
    const bool goes_on = !moves.empty() && !body.linear_inertia.is_limited && free <= mover.arrival &&
                         angle_between(mover.heading, way.heading) <= kSameHeading;
    const double turned =
        mover.arrival + body.rotation_time(mover.heading, way.heading) + body.wait_before_move;
    const double departure = goes_on ? mover.arrival : std::max(turned, free);
    const double arrival = departure + duration;
    if (goes_on) {
      moves.back().path.to = path.to;
      moves.back().t_end = arrival;
    } else {
      TimedMove& move = moves.emplace_back(TimedMove{{path, departure, arrival}});
      if (body.linear_inertia.is_limited) {
        move.profile = fastest_profile(way.length, body.linear_speed, body.linear_inertia);
      }
    }
    Vertex& left = at(from);
    if (!left.last.phases.empty()) {
      left.others_until = std::max(left.others_until, left.last.phases.back().t_end);
    }
    left.last = {std::move(mover.arriving), body.pair_radius};
    left.last.phases.push_back({{path.from, path.from}, mover.arrival, departure});
    for (TimedSegment& part : step) {
      part.t_start += departure;
      part.t_end += departure;
      left.last.phases.push_back(part);
    }
    mover.arriving = std::move(step);
    mover.heading = way.heading;
    mover.arrival = arrival;
  }

  const Instance& instance_;
  const Lattice& lattice_;
  std::vector<Vertex> vertices_;
  std::vector<Mover> movers_;  // in the order of the configurations
};

}  // namespace

std::optional<std::vector<Trajectory>> plan_on_lattice(const FleetReservations& reservations,
                                                       const std::vector<std::size_t>& robots, Random& random,
                                                       const StopCondition& stop) {
  const auto problem = StepGraph(reservations, robots).make(stop);
  if (!problem) return std::nullopt;
  const auto configurations = plan_steps(*problem, random, stop);
  if (!configurations) return std::nullopt;
  TimedSteps steps(reservations.instance(), robots, reservations.instance().lattice(robots.front()));
  for (std::size_t k = 1; k < configurations->size(); ++k) {
    if (stop.met()) return std::nullopt;
    steps.step((*configurations)[k - 1], (*configurations)[k]);
  }
  std::vector<Trajectory> trajectories = steps.finish();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (trajectories[k].cost >= reservations.instance().views(robots[k]).longest_plan()) return std::nullopt;
  }
  return trajectories;
}

}  // namespace fleetplan::core
