#include "core/moves/lacam.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/moves/configuration_search.h"
#include "core/moves/step_lines.h"

namespace fleetplan::core {
namespace {

/// The most configurations of a search, places of robots in all of them together, and constraints: 40, 64 and
/// 24 MB. A thousand robots in corridors take a tenth of the places.
constexpr ConfigurationLimits kLimits{
    .max_nodes = 100'000, .max_places = 4'000'000, .max_constraints = 1'000'000};
/// How often the search is tried, each time with other random numbers.
constexpr int kMaxTries = 4;
/// The most vertices of a corridor that are looked at for robots that have to pass each other.
constexpr int kLongestCorridor = 256;

/// By vertex and direction, the cost of a step.
using StepCosts = std::vector<std::array<std::uint8_t, 4>>;
/// The cost of a step for which nothing else counts, and the most that robots add who go the opposite way. In
/// a warehouse with corridors of one cell, 600 and 1000 robots then take 0.63 of the total time. Half and one
/// and a half times as much are as good. Costs for all other robots that pass are worse.
constexpr std::uint8_t kStep = 8;
constexpr double kMaxAgainstTraffic = 8.0;

/// The direction of the step back.
constexpr std::size_t opposite(std::size_t direction) { return direction ^ 1U; }

/// The costs from each vertex to the goal of each robot, if it is alone.
class StepDistances {
 public:
  static constexpr std::uint16_t kNoWay = std::numeric_limits<std::uint16_t>::max();

  /// False if `stop` is met first, or if a robot has no way from its start that is short enough to count.
  bool find(const StepProblem& problem, const StepCosts& costs, const StopCondition& stop) {
    distances_.reserve(problem.movers.size());
    for (const StepProblem::Mover& mover : problem.movers) {
      if (stop.met()) return false;
      distances_.push_back(to(mover.goal, problem.graphs[mover.graph], costs, stop));
      if (distances_.back()[static_cast<std::size_t>(mover.start)] == kNoWay) return false;
    }
    return true;
  }

  std::uint16_t of(std::size_t robot, int vertex) const {
    return distances_[robot][static_cast<std::size_t>(vertex)];
  }

 private:
  /// Dijkstra's search backwards, with a queue for each cost that is due (Dial, 1969).
  std::vector<std::uint16_t> to(int goal, const StepProblem::Neighbours& neighbours, const StepCosts& costs,
                                const StopCondition& stop) {
    StopStride stride(stop, StepProblem::kVerticesBetweenPolls);
    std::vector<std::uint16_t> distance(neighbours.size(), kNoWay);
    distance[static_cast<std::size_t>(goal)] = 0;
    due_[0].push_back(goal);
    std::size_t open = 1;
    for (std::size_t cost = 0; open > 0 && cost < kNoWay; ++cost) {
      std::vector<int>& queue = due_[cost % due_.size()];
      for (std::size_t k = 0; k < queue.size() && !stride.met_at_step(); ++k) {
        const auto here = static_cast<std::size_t>(queue[k]);
        --open;
        if (distance[here] != cost) continue;
        for (std::size_t direction = 0; direction < 4; ++direction) {
          if (neighbours[here][direction] == StepProblem::kNone) continue;
          const auto from = static_cast<std::size_t>(neighbours[here][direction]);
          const std::size_t through = cost + costs[from][opposite(direction)];
          if (through >= distance[from]) continue;
          distance[from] = static_cast<std::uint16_t>(through);
          due_[through % due_.size()].push_back(neighbours[here][direction]);
          ++open;
        }
      }
      queue.clear();
      if (stride.met()) break;
    }
    for (std::vector<int>& queue : due_) queue.clear();
    return distance;
  }

  std::vector<std::vector<std::uint16_t>> distances_;  // by robot, then by vertex
  std::array<std::vector<int>, 256> due_;              // by cost; more than a step costs
};

/// Costs by which robots go with the traffic. A step costs more if more of the robots that would pass there
/// alone go the opposite way. So most corridors get a direction (after Chen et al., AAAI 2024). Unfinished if
/// `stop` is met.
StepCosts against_traffic(const StepProblem& problem, const StepDistances& alone, const StepCosts& even,
                          const StopCondition& stop) {
  std::vector<std::array<std::uint32_t, 4>> passing(even.size(), {0, 0, 0, 0});
  for (std::size_t robot = 0; robot < problem.movers.size() && !stop.met(); ++robot) {
    const StepProblem::Mover& mover = problem.movers[robot];
    for (int here = mover.start; here != mover.goal;) {
      const auto& next = problem.graphs[mover.graph][static_cast<std::size_t>(here)];
      std::size_t best = 0;
      std::uint16_t least = StepDistances::kNoWay;
      for (std::size_t direction = 0; direction < 4; ++direction) {
        if (next[direction] == StepProblem::kNone || alone.of(robot, next[direction]) >= least) continue;
        best = direction;
        least = alone.of(robot, next[direction]);
      }
      ++passing[static_cast<std::size_t>(here)][best];
      here = next[best];
    }
  }
  StepCosts costs = even;
  for (const StepProblem::Neighbours& graph : problem.graphs) {
    StopStride stride = StopStride::from_first(stop, StepProblem::kVerticesBetweenPolls);
    for (std::size_t vertex = 0; vertex < graph.size() && !stride.met_at_step(); ++vertex) {
      for (std::size_t direction = 0; direction < 4; ++direction) {
        const int next = graph[vertex][direction];
        if (next == StepProblem::kNone) continue;
        const double with = passing[vertex][direction];
        const double against = passing[static_cast<std::size_t>(next)][opposite(direction)];
        const double added = kMaxAgainstTraffic * against / (with + against + 1.0);
        costs[vertex][direction] = static_cast<std::uint8_t>(kStep + added);
      }
    }
  }
  return costs;
}

/// Makes the next configuration: Priority Inheritance with Backtracking. A robot that goes to a vertex makes
/// the robot there go away first, as if that robot had its priority.
class NextConfiguration {
 public:
  NextConfiguration(const StepProblem& problem, Random& random, const StopCondition& stop)
      : problem_(problem),
        stop_(stop),
        random_(random),
        here_(problem.graphs.front().size(), kNobody),
        next_(problem.graphs.front().size(), kNobody),
        is_asked_(problem.movers.size(), false) {}

  /// By these distances robots choose where to go. None if the constraint allows none, if PIBT finds none
  /// with it, or if the stop condition is met.
  std::optional<Configuration> make(const Configuration& from, const std::vector<std::size_t>& order,
                                    const std::vector<StepConstraint>& constraints, std::size_t constraint,
                                    const StepDistances& distances) {
    from_ = &from;
    distances_ = &distances;
    to_.assign(from.size(), StepProblem::kNone);
    for (std::size_t i = 0; i < from.size(); ++i) here_[index(from[i])] = static_cast<std::int32_t>(i);
    const bool made = bind(constraints, constraint) && move_all(order) && !has_cycle();
    for (std::size_t i = 0; i < from.size(); ++i) {
      here_[index(from[i])] = kNobody;
      if (to_[i] != StepProblem::kNone) next_[index(to_[i])] = kNobody;
    }
    if (!made) return std::nullopt;
    return std::move(to_);
  }

 private:
  static constexpr std::int32_t kNobody = -1;
  static std::size_t index(int vertex) { return static_cast<std::size_t>(vertex); }

  bool bind(const std::vector<StepConstraint>& constraints, std::size_t last) {
    for (std::size_t k = last; constraints[k].place != StepConstraint::kNone; k = constraints[k].before) {
      const StepConstraint& bound = constraints[k];
      if (next_[index(bound.place)] != kNobody || exchanges(bound.robot, bound.place)) return false;
      set(bound.robot, bound.place);
    }
    return true;
  }

  bool move_all(const std::vector<std::size_t>& order) {
    for (const std::size_t robot : order) {
      if (stop_.met() || (to_[robot] == StepProblem::kNone && !move(robot))) return false;
    }
    return true;
  }

  bool exchanges(std::size_t robot, int vertex) const {
    const std::int32_t other = here_[index(vertex)];
    return other != kNobody && to_[static_cast<std::size_t>(other)] == (*from_)[robot];
  }

  void set(std::size_t robot, int vertex) {
    to_[robot] = vertex;
    next_[index(vertex)] = static_cast<std::int32_t>(robot);
  }

  /// The vertices that a robot may go to, the best first.
  struct Choices {
    std::array<int, 5> vertices{};
    std::size_t count = 0;
  };
  Choices choices_of(std::size_t robot) {
    Choices choices;
    std::array<std::pair<std::uint16_t, std::size_t>, 5>
        keys;  // distance, and a random number for equal ones
    const int from = (*from_)[robot];
    const auto insert = [&](int vertex) {
      const std::pair key(distances_->of(robot, vertex), random_.below(1U << 16));
      std::size_t k = choices.count++;
      for (; k > 0 && key < keys[k - 1]; --k) {
        keys[k] = keys[k - 1];
        choices.vertices[k] = choices.vertices[k - 1];
      }
      keys[k] = key;
      choices.vertices[k] = vertex;
    };
    // Bounded: at most four.
    for (const int vertex : neighbours(robot, from)) {
      if (vertex != StepProblem::kNone) insert(vertex);
    }
    insert(from);
    return choices;
  }

  /// Returns false if the robot has to stay where another robot wants to go. Depth: at most one for each
  /// robot.
  bool move(std::size_t robot) {
    const int from = (*from_)[robot];
    Choices choices = choices_of(robot);
    const std::int32_t pulled = robot_to_pull(robot, choices.vertices[0]);
    if (pulled != kNobody) {
      std::reverse(choices.vertices.begin(),
                   choices.vertices.begin() + static_cast<std::ptrdiff_t>(choices.count));
    }
    is_asked_[robot] = true;
    for (std::size_t k = 0; k < choices.count; ++k) {
      const int vertex = choices.vertices[k];
      const std::int32_t other = here_[index(vertex)];
      const bool is_other = other != kNobody && static_cast<std::size_t>(other) != robot;
      if (next_[index(vertex)] != kNobody) continue;
      // The one there exchanges places with this one, or asked others who asked this one: that is a cycle.
      if (is_other && (exchanges(robot, vertex) || is_asked_[static_cast<std::size_t>(other)])) continue;
      set(robot, vertex);
      const bool leaves = is_other && to_[static_cast<std::size_t>(other)] == StepProblem::kNone;
      if (leaves && !move(static_cast<std::size_t>(other))) continue;
      is_asked_[robot] = false;
      if (k == 0 && pulled != kNobody) pull(static_cast<std::size_t>(pulled), from);
      return true;
    }
    set(robot, from);
    is_asked_[robot] = false;
    return false;
  }

  /// Lets a robot follow to a vertex that another robot leaves, if it fits there.
  void pull(std::size_t robot, int vertex) {
    const auto& next = neighbours(robot, (*from_)[robot]);
    if (to_[robot] != StepProblem::kNone || next_[index(vertex)] != kNobody) return;
    if (std::find(next.begin(), next.end(), vertex) != next.end()) set(robot, vertex);
  }

  const std::array<int, 4>& neighbours(std::size_t robot, int vertex) const {
    return problem_.graphs[problem_.movers[robot].graph][index(vertex)];
  }

  /// In a corridor, two robots that want to pass each other go to its end, one pulling the other behind it,
  /// and exchange their order there (Okumura, IJCAI 2023). Returns which robot this one has to pull, if any.
  /// `best`: where it wants to go.
  std::int32_t robot_to_pull(std::size_t robot, int best) const {
    const int here = (*from_)[robot];
    if (best == here) return kNobody;
    const std::int32_t ahead = here_[index(best)];
    if (ahead != kNobody && to_[static_cast<std::size_t>(ahead)] == StepProblem::kNone &&
        has_to_pass(robot, static_cast<std::size_t>(ahead), here, best) && may_pass(robot, best, here)) {
      return ahead;
    }
    // One behind may have to pass this robot, once it has gone where it wants to.
    for (const int vertex : neighbours(robot, here)) {
      const std::int32_t behind = vertex == StepProblem::kNone ? kNobody : here_[index(vertex)];
      if (behind == kNobody || vertex == best) continue;
      if (has_to_pass(static_cast<std::size_t>(behind), robot, here, best) && may_pass(robot, best, here)) {
        return behind;
      }
    }
    return kNobody;
  }

  /// The ways on from a vertex, except the way back. Dead ends that robots have reached for good do not
  /// count.
  struct WaysOn {
    int count = 0;
    int last = StepProblem::kNone;
  };
  WaysOn ways_on(std::size_t robot, int vertex, int back) const {
    WaysOn ways;
    for (const int next : neighbours(robot, vertex)) {
      if (next == StepProblem::kNone || next == back || is_taken_dead_end(robot, next)) continue;
      ++ways.count;
      ways.last = next;
    }
    return ways;
  }
  bool is_taken_dead_end(std::size_t robot, int vertex) const {
    const std::int32_t other = here_[index(vertex)];
    if (other == kNobody || problem_.movers[static_cast<std::size_t>(other)].goal != vertex) return false;
    const auto& next = neighbours(robot, vertex);
    return std::count(next.begin(), next.end(), StepProblem::kNone) == 3;
  }

  /// Whether `pusher`, which drives `puller` before it along a corridor, wants to go farther than that ends,
  /// and `puller` wants to come back.
  bool has_to_pass(std::size_t pusher, std::size_t puller, int at, int ahead) const {
    // Bounded: kLongestCorridor.
    for (int k = 0; distances_->of(pusher, ahead) < distances_->of(pusher, at); ++k) {
      const WaysOn ways = ways_on(pusher, ahead, at);
      if (ways.count >= 2 || k == kLongestCorridor) return false;
      if (ways.count == 0) break;
      at = std::exchange(ahead, ways.last);
    }
    return distances_->of(puller, at) < distances_->of(puller, ahead) &&
           (distances_->of(pusher, at) == 0 || distances_->of(pusher, ahead) < distances_->of(pusher, at));
  }

  /// Whether a corridor from `from` through `ahead` leads to a crossing, where two robots can change places.
  bool may_pass(std::size_t robot, int from, int ahead) const {
    int back = from;
    // Bounded: kLongestCorridor.
    for (int k = 0; ahead != from && k < kLongestCorridor; ++k) {
      const WaysOn ways = ways_on(robot, ahead, back);
      if (ways.count >= 2) return true;
      if (ways.count == 0) return false;
      back = std::exchange(ahead, ways.last);
    }
    return false;
  }

  /// Whether robots go round in a cycle.
  bool has_cycle() const {
    std::vector<std::uint32_t> seen(to_.size(), 0);
    // Bounded: each robot is followed once.
    for (std::size_t i = 0; i < to_.size(); ++i) {
      std::size_t k = i;
      const auto mark = static_cast<std::uint32_t>(i + 1);
      while (seen[k] == 0) {
        seen[k] = mark;
        const std::int32_t ahead = here_[index(to_[k])];
        if (ahead == kNobody || static_cast<std::size_t>(ahead) == k) break;
        k = static_cast<std::size_t>(ahead);
        if (seen[k] == mark) return true;
      }
    }
    return false;
  }

  const StepProblem& problem_;
  const StopCondition& stop_;
  Random& random_;
  const Configuration* from_ = nullptr;
  const StepDistances* distances_ = nullptr;
  Configuration to_;
  std::vector<std::int32_t> here_;  // by vertex: the robot that is there now, and the robot that will be
                                    // there
  std::vector<std::int32_t> next_;
  std::vector<bool> is_asked_;  // by robot: whether it waits for another robot to go away
};

/// A fleet on a graph, see ConfigurationSearch.
class FleetOnGraph {
 public:
  /// `alone`: the distances by kStep. `with_traffic`: the distances by against_traffic().
  FleetOnGraph(const StepProblem& problem, const StepDistances& alone, const StepDistances& with_traffic,
               Random& random, const StopCondition& stop)
      : problem_(problem), alone_(alone), with_traffic_(with_traffic), next_(problem, random, stop) {
    for (std::size_t i = 0; i < problem.movers.size(); ++i) {
      goals_.push_back(problem.movers[i].goal);
      longest_ = std::max<std::size_t>(longest_, far(i) / kStep);
    }
  }

  Configuration starts() const {
    Configuration starts;
    for (const StepProblem::Mover& mover : problem_.movers) starts.push_back(mover.start);
    return starts;
  }
  bool is_end(const Configuration& at) const { return at == goals_; }
  bool is_home(std::size_t robot, int vertex) const { return vertex == goals_[robot]; }
  bool comes_before(std::size_t a, std::size_t b) const { return far(a) != far(b) ? far(a) > far(b) : a < b; }

  template <class Visitor>
  void for_each_step(std::size_t robot, int vertex, const Visitor& visit) const {
    for (const int next : problem_.graphs[problem_.movers[robot].graph][static_cast<std::size_t>(vertex)]) {
      if (next != StepProblem::kNone) visit(next);
    }
  }

  std::optional<Configuration> next(const Configuration& from, const std::vector<std::size_t>& order,
                                    const std::vector<StepConstraint>& constraints, std::size_t constraint,
                                    std::size_t depth) {
    // In the end, robots that still wait for each other have to pass against the traffic.
    return next_.make(from, order, constraints, constraint, depth < longest_ ? with_traffic_ : alone_);
  }

 private:
  std::uint16_t far(std::size_t robot) const { return alone_.of(robot, problem_.movers[robot].start); }

  const StepProblem& problem_;
  const StepDistances& alone_;
  const StepDistances& with_traffic_;
  NextConfiguration next_;
  Configuration goals_;
  std::size_t longest_ = 0;  // steps of the longest way alone
};

}  // namespace

std::optional<std::vector<Configuration>> plan_steps(const StepProblem& problem, Random& random,
                                                     const StopCondition& stop) {
  if (problem.movers.empty()) return std::vector<Configuration>{{}};
  const std::size_t vertices = problem.graphs.front().size();
  if (problem.movers.size() * vertices > StepProblem::kMaxDistances) return std::nullopt;
  if (have_to_pass_on_a_line(problem, stop)) return std::nullopt;
  const StepCosts even(vertices, {kStep, kStep, kStep, kStep});
  StepDistances alone;
  StepDistances with_traffic;
  if (!alone.find(problem, even, stop)) return std::nullopt;
  // Ways against all traffic may be too long to count.
  const StepCosts costs = against_traffic(problem, alone, even, stop);
  const StepDistances& first = with_traffic.find(problem, costs, stop) ? with_traffic : alone;
  for (int k = 0; k < kMaxTries && !stop.met(); ++k) {
    FleetOnGraph fleet(problem, alone, first, random, stop);
    ConfigurationSearch search(fleet, kLimits, random, stop);
    auto plan = search.run();
    if (plan || search.has_no_way()) return plan;
  }
  return std::nullopt;
}

}  // namespace fleetplan::core
