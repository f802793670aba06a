#include "core/moves/sparse_vertices.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace fleetplan::core {
namespace {

constexpr std::size_t kVerticesBetweenPolls = 256;
constexpr float kFar = std::numeric_limits<float>::infinity();
/// Chosen vertices are not joined if others join them by a way that is so many times as long.
constexpr float kAboutAsGood = 1.3F;

/// Chooses vertices: first the vertex that is farthest from all vertices chosen before (Gonzalez, Theoretical
/// Computer Science, 1985).
class Choice {
 public:
  struct Border {
    float length = 0.0F;  // metres, from one chosen vertex to the other
    int from = -1;        // the vertices on both sides
    int to = -1;
  };

  Choice(const Vertices& vertices, const StopCondition& stop)
      : vertices_(vertices),
        stop_(stop, kVerticesBetweenPolls),
        near_(static_cast<std::size_t>(vertices.count())) {}

  void find_reachable(int start) {
    std::vector<bool> seen(near_.size(), false);
    reachable_.push_back(start);
    seen[static_cast<std::size_t>(start)] = true;
    for (std::size_t k = 0; k < reachable_.size() && !stop_.met_at_step(); ++k) {
      for_each_step(reachable_[k], [&](int next) {
        if (seen[static_cast<std::size_t>(next)]) return;
        seen[static_cast<std::size_t>(next)] = true;
        reachable_.push_back(next);
      });
    }
  }

  /// Of the vertices that can be reached; -1 once the stop condition is met.
  int nearest(const Position& position) {
    if (stop_.met_after(reachable_.size())) return -1;
    return *std::min_element(reachable_.begin(), reachable_.end(), [&](int a, int b) {
      return (vertices_.position(a) - position).squaredNorm() <
             (vertices_.position(b) - position).squaredNorm();
    });
  }

  void choose(int vertex) {
    if (at(vertex).distance == 0.0F) return;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    const auto reach = [&](int here, float distance, int before) {
      Near& near = at(here);
      if (!(distance < near.distance)) return;
      near = {distance, vertex, before};
      open.emplace(distance, here);
    };
    reach(vertex, 0.0F, vertex);
    while (!open.empty() && !stop_.met_at_step()) {
      const float distance = open.top().first;
      const int here = open.top().second;
      open.pop();
      if (distance > at(here).distance || at(here).chosen != vertex) continue;
      const Position position = vertices_.position(here);
      for_each_step(here, [&](int next) {
        reach(next, distance + static_cast<float>((vertices_.position(next) - position).norm()), here);
      });
    }
  }

  /// Chooses vertices until none is farther than this from all chosen ones.
  void choose_until(float distance) {
    std::priority_queue<std::pair<float, int>> farthest;
    for (const int vertex : reachable_) farthest.emplace(at(vertex).distance, -vertex);
    while (!farthest.empty() && !stop_.met_at_step()) {
      const auto [far, minus] = farthest.top();
      farthest.pop();
      const float now = at(-minus).distance;
      if (now <= distance) continue;
      if (now < far) {
        farthest.emplace(now, minus);
      } else {
        choose(-minus);
      }
    }
  }

  /// Where neighbourhoods of chosen vertices touch: the shortest ways between them first.
  std::vector<Border> borders() {
    std::map<std::pair<int, int>, Border> all;
    for (const int here : reachable_) {
      if (stop_.met_at_step()) break;
      const Position position = vertices_.position(here);
      for_each_step(here, [&](int next) {
        const Near& mine = at(here);
        const Near& theirs = at(next);
        if (mine.chosen < 0 || theirs.chosen < 0 || mine.chosen == theirs.chosen) return;
        const float step = static_cast<float>((vertices_.position(next) - position).norm());
        const Border border{mine.distance + step + theirs.distance, here, next};
        const std::pair pair = std::minmax(mine.chosen, theirs.chosen);
        const auto [known, is_new] = all.try_emplace({pair.first, pair.second}, border);
        if (!is_new && border.length < known->second.length) known->second = border;
      });
    }
    std::vector<Border> sorted;
    sorted.reserve(all.size());
    for (const auto& [pair, border] : all) sorted.push_back(border);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Border& a, const Border& b) { return a.length < b.length; });
    return sorted;
  }

  /// The vertices on the way from one chosen vertex across a border to the other one.
  std::vector<int> way_across(const Border& border) const {
    std::vector<int> way = way_back(border.from);
    std::reverse(way.begin(), way.end());
    const std::vector<int> rest = way_back(border.to);
    way.insert(way.end(), rest.begin(), rest.end());
    return way;
  }

  bool is_cut_off() { return stop_.met(); }

 private:
  using Open = std::pair<float, int>;
  /// The nearest chosen vertex, and the way there.
  struct Near {
    float distance = kFar;  // metres
    int chosen = -1;
    int before = -1;
  };

  Near& at(int vertex) { return near_[static_cast<std::size_t>(vertex)]; }
  const Near& at(int vertex) const { return near_[static_cast<std::size_t>(vertex)]; }

  template <class Visitor>
  void for_each_step(int vertex, const Visitor& visit) const {
    vertices_.for_each_neighbour(vertex, [&](int next) {
      if (next != vertex && vertices_.allow(vertex, next)) visit(next);
    });
  }

  /// From a vertex to the chosen one.
  std::vector<int> way_back(int vertex) const {
    std::vector<int> way{vertex};
    while (at(way.back()).before != way.back()) way.push_back(at(way.back()).before);
    return way;
  }

  const Vertices& vertices_;
  StopStride stop_;
  std::vector<Near> near_;  // by vertex
  std::vector<int> reachable_;
};

/// Straight moves between chosen vertices and, where these do not see each other, bends.
class Joints {
 public:
  Joints(const Vertices& vertices, std::unordered_map<int, std::vector<int>>& steps)
      : vertices_(vertices), steps_(steps) {}

  /// Whether a way over the steps so far is at most so long, metres.
  bool are_joined(int from, int to, float limit) const {
    using Open = std::pair<float, int>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    std::unordered_map<int, float> best{{from, 0.0F}};
    open.emplace(0.0F, from);
    // Bounded: vertices within the limit, which is a few spacings.
    while (!open.empty()) {
      const auto [distance, here] = open.top();
      open.pop();
      if (here == to) return true;
      if (distance > best[here]) continue;
      const auto steps = steps_.find(here);
      if (steps == steps_.end()) continue;
      for (const int next : steps->second) {
        const float through = distance + length(here, next);
        if (through > limit) continue;
        const auto [known, is_new] = best.try_emplace(next, through);
        if (!is_new && known->second <= through) continue;
        known->second = through;
        open.emplace(through, next);
      }
    }
    return false;
  }

  void join(const std::vector<int>& way) {
    // Bounded: each round leaves a vertex of the way behind.
    for (std::size_t k = 0; k + 1 < way.size();) {
      std::size_t end = way.size() - 1;
      while (end > k + 1 && !vertices_.in_sight(way[k], way[end])) --end;
      add(way[k], way[end]);
      add(way[end], way[k]);
      k = end;
    }
  }

 private:
  float length(int from, int to) const {
    return static_cast<float>((vertices_.position(to) - vertices_.position(from)).norm());
  }

  void add(int from, int to) {
    std::vector<int>& steps = steps_[from];
    const bool known = std::find(steps.begin(), steps.end(), to) != steps.end();
    if (!known && from != to && vertices_.in_sight(from, to)) steps.push_back(to);
  }

  const Vertices& vertices_;
  std::unordered_map<int, std::vector<int>>& steps_;
};

}  // namespace

SparseVertices::SparseVertices(const Vertices& vertices, const std::vector<int>& required,
                               const std::vector<Position>& wanted, double spacing,
                               const StopCondition& stop) {
  Choice choice(vertices, stop);
  choice.find_reachable(required.front());
  for (const int vertex : required) choice.choose(vertex);
  for (const Position& position : wanted) {
    const int vertex = choice.nearest(position);
    if (vertex < 0) return;
    if ((vertices.position(vertex) - position).norm() < 0.5 * spacing) choice.choose(vertex);
  }
  choice.choose_until(static_cast<float>(spacing));
  Joints joints(vertices, steps_);
  for (const auto& border : choice.borders()) {
    if (choice.is_cut_off()) return;
    const std::vector<int> way = choice.way_across(border);
    if (!joints.are_joined(way.front(), way.back(), kAboutAsGood * border.length)) joints.join(way);
  }
}

const std::vector<int>& SparseVertices::steps_from(int vertex) const {
  static const std::vector<int> kNone;
  const auto steps = steps_.find(vertex);
  return steps == steps_.end() ? kNone : steps->second;
}

}  // namespace fleetplan::core
