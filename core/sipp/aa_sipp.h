#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/interval.h"
#include "core/instance.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/dominance_table.h"
#include "core/sipp/edge_timing.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// What came out of a search for one robot. Without a trajectory, `complete` tells whether there is none (no
/// way that the lattice offers, and costs below the bound asked for) or the search was cut off.
struct SearchResult {
  std::optional<Trajectory> trajectory;
  bool complete = true;
  std::int64_t expansions = 0;
};

/// What a search may settle for.
struct SearchLimits {
  double bound = kForever;        // seconds; only costs below it count
  double heuristic_weight = 1.2;  // >= 1; weight of what is still to go (weighted A*; Pohl, 1970)
  double suboptimality = 0.01;  // a way to the goal within this fraction of the smallest key is taken at once
  double suboptimality_growth = 1e-4;  // the fraction grows by so much with every expansion
  // Of arrivals in one safe interval that differ by less than it takes to translate by so many lattice
  // spacings, the later one counts as no better, whatever its heading; 0: only if it is dominated.
  double dominance_slack = 0.5;
  double start_delay = 0.0;  // seconds, >= 0; the robot stays at its start at least so long
  /// Search again, completely, when the quick search found nothing that is coarse and keeps one label for
  /// each interval while the goal is not yet free.
  bool thorough = true;
  /// Of both together; a search that would need more counts as cut off.
  std::int64_t max_expansions = std::numeric_limits<std::int64_t>::max();
};

/// One robot among reservations: any-angle safe-interval path planning with headings (paper, section
/// Individual planner; Phillips and Likhachev, ICRA 2011; Yakovlev and Andreychuk, ICAPS 2017).
///
/// A label is a vertex, a safe interval, the heading and the earliest arrival there, unless another dominates
/// it (see DominanceTable).
/// Moves start from the label or, any-angle, from its parent. They are put on the open list with an
/// optimistic arrival and timed against the reservations only when they come first (after Lazy Theta*); the
/// next safe interval of the same vertex follows only then. A timed move that cannot be had at its optimistic
/// arrival waits on the open list, and dominates others from there as if it were a label already.
class AaSipp {
 public:
  AaSipp(const Instance& instance, const ReservationTable& table) : instance_(instance), table_(table) {}

  /// The trajectory of `robot` from its start to its goal (it has one). The robot holds no reservation.
  SearchResult run(std::size_t robot, const Vertices& vertices, CostToGo& cost_to_go,
                   const SearchLimits& limits, const StopCondition& stop);

 private:
  struct Place {  // a vertex that was looked at
    int vertex;
    Position position;
    CostToGo::Estimate estimate;
    int first_interval;
    int interval_count;
  };
  struct Label {
    double arrival;
    double heading;
    double departure;  // from the parent
    int parent;        // label, or -1
    int place;
    int interval;
  };
  enum class Sight : std::uint8_t { unknown, free, blocked };
  /// How a place may be reached by way of a label: from the label itself or, any-angle, from its parent.
  struct Way {
    Move local;
    Move shortcut;
    int via = -1;
    int place = -1;
    Sight sight = Sight::blocked;  // of the shortcut; blocked where there is none
  };
  enum class Kind : std::uint8_t { local, shortcut };
  struct Candidate {
    double arrival;
    double departure;
    int way;
    int interval;
    int entry;  // of arrivals_, or -1 while the move is not timed and its arrival optimistic
    Kind kind;
    bool leads;  // the next interval of the place follows when this one comes first
  };
  struct Rank {
    double key;
    double h;
    double cost;  // estimate for the whole way
  };
  struct Open {
    double key;
    double h;
    int candidate;
    bool operator>(const Open& other) const {
      if (key != other.key) return key > other.key;
      if (h != other.h) return h > other.h;
      return candidate > other.candidate;
    }
  };
  enum class Outcome : std::uint8_t { found, exhausted, pruned, stopped };

  Outcome search(bool thorough);
  void reset();
  int place_of(int vertex);
  void add_start();
  bool best_goal_will_do() const;
  void process(int index);
  void time_move(Candidate candidate, double key);
  void settle(const Candidate& candidate);
  void expand(int label);
  void shoot_at_goal(int label);
  int add_way(int via, int place, bool with_shortcut);
  bool sees(Way& way);
  void follow(int index, int interval);
  bool offer(int index, Kind kind, int interval, bool leads);
  Rank rank(int place, int interval, double arrival, double heading) const;
  void push(const Candidate& candidate, const Rank& rank);
  bool redundant(int interval, double arrival, double heading, double key);
  Standing standing_at(int label) const;
  Position position_of(int label) const;
  bool is_final(int place, int interval) const;
  double to_go(int place, double heading) const;
  Trajectory extract() const;

  const Instance& instance_;
  const ReservationTable& table_;

  // Of the search at hand; kept between searches for their memory.
  std::size_t robot_ = 0;
  const Motion* motion_ = nullptr;
  std::optional<EdgeTiming> timing_;
  const Vertices* vertices_ = nullptr;
  CostToGo* cost_to_go_ = nullptr;
  const StopCondition* stop_ = nullptr;
  SearchLimits limits_;
  double release_ = 0.0;  // the goal's last safe interval begins here
  bool thorough_ = false;
  bool coarse_ = false;
  bool pruned_ = false;
  int goal_place_ = -1;
  int goal_label_ = -1;
  int best_goal_ = -1;  // the cheapest timed candidate that reaches the goal for good
  double best_goal_cost_ = kForever;
  std::int64_t expansions_ = 0;
  std::vector<int> place_of_vertex_;
  std::vector<Place> places_;
  std::vector<SafeInterval> intervals_;
  DominanceTable dominance_;
  std::vector<Label> labels_;
  std::vector<Way> ways_;
  std::vector<Candidate> candidates_;
  std::vector<Open> open_;
};

}  // namespace fleetplan::core
