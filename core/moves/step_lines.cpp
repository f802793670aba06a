#include "core/moves/step_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

namespace fleetplan::core {
namespace {

/// The lines of vertices that have no branch, from one end to the other. Robots on a line keep their order.
class Lines {
 public:
  /// If `stop` is met, the result is incomplete and must not be used.
  Lines(const StepProblem& problem, const StopCondition& stop) {
    StopStride stride(stop, StepProblem::kVerticesBetweenPolls);
    add_neighbours(problem, stride);
    places_.resize(neighbours_.size());
    for (std::size_t end = 0; end < neighbours_.size() && !stride.met_at_step(); ++end) {
      if (places_[end].line < 0 && neighbours_[end].count < 2) follow(static_cast<int>(end));
    }
  }

  /// Whether two robots would have to pass each other on a line.
  bool forbid(const StepProblem& problem) const {
    std::vector<std::tuple<int, int, int>> robots;  // line, and places of start and goal
    for (const StepProblem::Mover& mover : problem.movers) {
      const Place& start = places_[static_cast<std::size_t>(mover.start)];
      const Place& goal = places_[static_cast<std::size_t>(mover.goal)];
      if (start.line >= 0 && start.line == goal.line) robots.emplace_back(start.line, start.at, goal.at);
    }
    std::sort(robots.begin(), robots.end());
    return std::adjacent_find(robots.begin(), robots.end(), [](const auto& a, const auto& b) {
             return std::get<0>(a) == std::get<0>(b) && std::get<2>(a) > std::get<2>(b);
           }) != robots.end();
  }

 private:
  /// The first two neighbours of a vertex for any robot, and how many there are.
  struct Neighbours {
    std::array<int, 2> first{StepProblem::kNone, StepProblem::kNone};
    int count = 0;
  };
  struct Place {
    int line = -1;  // none
    int at = 0;
  };

  void add_neighbours(const StepProblem& problem, StopStride& stride) {
    neighbours_.resize(problem.graphs.front().size());
    for (std::size_t vertex = 0; vertex < neighbours_.size() && !stride.met_at_step(); ++vertex) {
      Neighbours& all = neighbours_[vertex];
      for (std::size_t direction = 0; direction < 4; ++direction) {
        for (const StepProblem::Neighbours& graph : problem.graphs) {
          const int next = graph[vertex][direction];
          if (next == StepProblem::kNone) continue;
          if (all.count < 2) all.first[static_cast<std::size_t>(all.count)] = next;
          ++all.count;
          break;  // the other robots' step leads to the same vertex
        }
      }
    }
  }

  /// Gives the vertices from an end on their places, unless there is a branch. Each vertex is on one such
  /// way.
  void follow(int end) {
    std::vector<int> line{end};
    for (int before = StepProblem::kNone;;) {
      const Neighbours& next = neighbours_[static_cast<std::size_t>(line.back())];
      if (next.count > 2) return;
      const int ahead = next.first[0] == before ? next.first[1] : next.first[0];
      if (ahead == StepProblem::kNone) break;
      before = line.back();
      line.push_back(ahead);
    }
    for (std::size_t k = 0; k < line.size(); ++k) {
      places_[static_cast<std::size_t>(line[k])] = {end, static_cast<int>(k)};
    }
  }

  std::vector<Neighbours> neighbours_;  // by vertex
  std::vector<Place> places_;           // by vertex
};

}  // namespace

bool have_to_pass_on_a_line(const StepProblem& problem, const StopCondition& stop) {
  const Lines lines(problem, stop);
  return !stop.met() && lines.forbid(problem);
}

}  // namespace fleetplan::core
