#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/interval.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/search/cost_to_go.h"
#include "core/search/fleet.h"
#include "core/search/move_timing.h"
#include "core/search/stop_condition.h"
#include "core/search/vertices.h"

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
  double bound = kForever;      // seconds; only costs below it count
  double greed = 1.2;           // >= 1; weight of what is still to go (weighted A*; Pohl, 1970)
  double suboptimality = 0.01;  // a way to the goal within this fraction of the smallest key is taken at once
  double impatience = 1e-4;     // the fraction grows by so much with every expansion
  double hold = 0.0;            // seconds, >= 0; the robot stays at its start at least so long
  /// Search again, completely, when the quick search that keeps one label for each interval while the goal is
  /// not yet free found nothing.
  bool thorough = true;
};

/// One robot among reservations: any-angle safe-interval path planning with headings (paper, section
/// Individual planner; Phillips and Likhachev, ICRA 2011; Yakovlev and Andreychuk, ICAPS 2017).
///
/// A label is a vertex, a safe interval, the heading and the earliest arrival there. Label a dominates b of
/// the same interval if a's arrival plus the rotation from a's heading to b's is no later than b's arrival.
/// Moves start from the label or, any-angle, from its parent. They are put on the open list with an
/// optimistic arrival and timed against the reservations only when they come first (after Lazy Theta*); the
/// next safe interval of the same vertex follows only then.
class AaSipp {
 public:
  AaSipp(const Fleet& fleet, const ReservationTable& table) : fleet_(fleet), table_(table) {}

  /// The trajectory of `robot` from its start to its goal (it has one). The robot holds no reservation.
  SearchResult run(std::size_t robot, const Vertices& vertices, CostToGo& cost_to_go,
                   const SearchLimits& limits, const StopCondition& stop);

 private:
  enum class Kind : std::uint8_t {
    from_parent,  // any-angle, not yet timed
    local,        // from the label itself, not yet timed
    timed         // arrival is exact
  };
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
    int next;  // the next label of the same interval, or -1
  };
  struct Candidate {
    double arrival;
    double departure;
    double heading;
    int from;  // the label that the move starts from
    int via;   // the label that was expanded
    int place;
    int interval;
    Kind kind;
    bool leads;    // the next interval of the place follows when this one comes first
    bool blocked;  // the parent is known not to see the place
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
  enum class Offer : std::uint8_t { made, useless, too_late };
  enum class Outcome : std::uint8_t { found, exhausted, pruned, stopped };

  Outcome search(bool thorough);
  void reset();
  int place_of(int vertex);
  void add_start();
  bool best_goal_will_do() const;
  void process(int index);
  void settle(const Candidate& candidate, double key);
  void expand(int label);
  void shoot_at_goal(int label);
  void follow(int via, int place, int interval, bool blocked);
  Offer offer(Kind kind, int via, int place, int interval, bool leads, bool blocked);
  Rank rank(const Candidate& candidate) const;
  void push(const Candidate& candidate, const Rank& rank);
  Standing standing_at(int label) const;
  Move move_to(int label, int place, int interval) const;
  bool redundant(int interval, double arrival, double heading, double key);
  bool is_final(int place, int interval) const;
  double to_go(int place, double heading) const;
  Trajectory extract() const;

  const Fleet& fleet_;
  const ReservationTable& table_;

  // Of the search at hand; kept between searches for their memory.
  std::size_t robot_ = 0;
  const Motion* motion_ = nullptr;
  std::optional<MoveTiming> timing_;
  const Vertices* vertices_ = nullptr;
  CostToGo* cost_to_go_ = nullptr;
  const StopCondition* stop_ = nullptr;
  SearchLimits limits_;
  double release_ = 0.0;  // the goal's last safe interval begins here
  bool thorough_ = false;
  bool pruned_ = false;
  int goal_place_ = -1;
  int goal_label_ = -1;
  int best_goal_ = -1;  // the cheapest timed candidate that reaches the goal for good
  double best_goal_cost_ = kForever;
  std::int64_t expansions_ = 0;
  std::vector<int> place_of_vertex_;
  std::vector<Place> places_;
  std::vector<SafeInterval> intervals_;
  std::vector<int> labels_of_interval_;
  std::vector<Label> labels_;
  std::vector<Candidate> candidates_;
  std::vector<Open> open_;
};

}  // namespace fleetplan::core
