#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/edge_timing.h"
#include "core/sipp/label_path.h"
#include "core/sipp/search_limits.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// The search for one robot: its inputs and its state. Intervals are indices into SearchState::intervals.
class Search {
 public:
  enum class Pass : std::uint8_t { quick, complete };

  /// `exhausted`: the open list is empty. `incomplete`: likewise, but the quick pass discarded an arrival
  /// that the complete pass may keep. `stopped`: by the stop condition or the limit of expansions.
  enum class Outcome : std::uint8_t { found, exhausted, incomplete, stopped };

  Search(const ReservationTable& table, std::size_t robot, SearchSpace& space, const SearchLimits& limits,
         const StopCondition& stop, SearchState state)
      : table_(table),
        robot_(robot),
        space_(space),
        motion_(space.vertices().motion()),
        zones_(space.vertices().zones()),
        timing_(motion_, table, robot, zones_),
        vertices_(space.vertices()),
        changes_radius_(space.changes_radius()),
        last_stage_(static_cast<int>(space.goal_count()) - (space.rests_with_other_radius() ? 0 : 1)),
        limits_(limits),
        stop_(stop),
        pause_(std::min(limits.max_expansions, first_test(limits))),
        state_(std::move(state)) {}

  Outcome run(Pass pass);
  Trajectory trajectory() const { return trajectory_of(state_, space_); }
  std::int64_t expansions() const { return expansions_; }
  SearchState take_state() { return std::move(state_); }

 private:
  /// f orders the open list; h is the estimated cost to the goal; `cost` estimates the cost of the whole
  /// path, without the heuristic weight. Seconds.
  struct Evaluation {
    double f;
    double h;
    double cost;
  };

  static std::int64_t first_test(const SearchLimits& limits) {
    return limits.no_path_test == nullptr ? limits.max_expansions : SearchLimits::kFirstTest;
  }
  bool begin(Pass pass);
  bool can_serve_all();
  void label_start();
  bool goal_entry_suffices() const;
  bool has_horizon() const { return limits_.horizon != kForever; }
  bool may_rest_at(const Label& label) const;
  bool rest_suffices() const;
  bool finish_at_rest();
  LabelId settle(const OpenEntry& entry);
  LabelId add_label(const Label& label);
  void expand(LabelId id);
  bool serve(LabelId id);
  bool serve_with_other_intervals(LabelId id, const ServiceStop& stop);
  void offer_goal(LabelId from);
  void offer_goal(LabelId from, bool reverse);
  void offer_from(EdgeId id, int interval);
  bool offer(EdgeId id, EdgeKind kind, int interval, bool next_interval_follows);
  void push_timed(OpenEntry entry, double f_lower_bound);

  EdgeId add_edge(LabelId via, PlaceId target, bool with_shortcut, bool reverse);
  Move move_between(LabelId from, PlaceId target, bool reverse) const;
  Move move_within(const SafeInterval& interval, const Vertices& of_stage, const Label& label, PlaceId target,
                   bool reverse) const;
  void limit_speeds(Move& move, const Label& from, PlaceId target) const;
  void test_sight(Edge& edge) const;
  std::optional<double> earliest_departure(const OpenEntry& entry);
  bool is_dominated(int interval, double arrival, double heading, double f);
  Evaluation evaluate(PlaceId place, int interval, double arrival, double heading) const;
  double to_go(PlaceId place, double heading) const;

  PlaceId place_of(int vertex, int stage);
  void append_intervals(Place& place);
  void append_windows(const Place& place);
  const Vertices& vertices(int stage) const {
    return changes_radius_ ? *state_.stages[stage].vertices : vertices_;
  }
  double latest_departure(LabelId from) const;
  Move move_with_radius(LabelId from, PlaceId target, bool reverse) const;
  PlaceId goal_of(int stage) { return place_of(state_.stages[stage].goal.vertex, stage); }
  LabelId source_of(const Edge& edge, EdgeKind kind) const {
    return kind == EdgeKind::shortcut ? state_.labels[edge.via].parent : edge.via;
  }
  const Place& place_at(LabelId label) const { return state_.places[state_.labels[label].place]; }
  bool is_final(PlaceId place, int interval) const {
    return place == state_.goal && state_.intervals[interval].end == kForever;
  }

  const ReservationTable& table_;
  const std::size_t robot_;
  SearchSpace& space_;
  const Motion& motion_;
  const DriveZones* zones_;  // null for none
  const EdgeTiming timing_;
  const Vertices& vertices_;  // of the first stage
  const bool changes_radius_;
  const int last_stage_;
  const SearchLimits& limits_;
  const StopCondition& stop_;

  const bool is_costly_ = table_.is_costly();
  Pass pass_ = Pass::quick;
  bool use_slack_ = false;
  bool stopped_ = false;         // while a pass was prepared
  std::int64_t expansions_ = 0;  // of all passes
  std::int64_t pause_;           // expansions after which the limits are looked at
  SearchState state_;
};

}  // namespace fleetplan::core
