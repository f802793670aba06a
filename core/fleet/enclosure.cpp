#include "core/fleet/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {
namespace {

/// Subtracted from every required distance (metres), so that rounding and contact never close a way.
constexpr double kSlack = 10.0 * kContactTolerance;
/// Cells that are examined in the time of a step.
constexpr std::int64_t kCellsPerStep = 8;
/// The effort for the robots that close a way, in floods.
constexpr std::int64_t kMaxFloods = 24;

/// To sort what disks cover of a border takes longer than to look at them.
constexpr std::size_t kWorkOfCovering = 16;
/// Steps, and disks and cells that they look at, between two questions of the stop condition: about a
/// millisecond.
constexpr std::size_t kWorkBetweenPolls = 1 << 15;

/// A step to a neighbour of a cell.
struct Step {
  int columns, rows;
  int begin_column, begin_row;  // begin of the border, counted from the cell
};
constexpr std::array<Step, 4> kSteps{{{1, 0, 1, 0}, {-1, 0, 0, 0}, {0, 1, 0, 1}, {0, -1, 0, 0}}};

/// The accuracy of the width of a way, metres.
constexpr double kGapAccuracy = 0.001;

}  // namespace

/// The end of the way from which a cell was reached.
enum class Enclosure::Side : std::uint8_t { none, start, goal };

/// The cells that were reached from the start and from the goal.
struct Enclosure::Flood {
  explicit Flood(const OccupancyGrid& grid) : reached(static_cast<std::size_t>(grid.cell_count())) {}

  Answer answer = Answer::unknown;
  PagedArray<Side> reached;
  static constexpr std::array<Side, 2> kSides{Side::start, Side::goal};
  std::array<std::vector<Cell>, 2> cells;     // in order of distance, by side
  std::array<std::size_t, 2> expanded{};      // number of cells that are expanded
  std::array<std::vector<Disk*>, 2> closing;  // disks at borders that are not crossable
  std::size_t closed_side = 0;
};

Enclosure::Enclosure(const Instance& instance, std::size_t robot, const std::vector<std::size_t>& staying,
                     const StopCondition& stop)
    : instance_(instance),
      grid_(instance.problem().grid()),
      robot_(robot),
      clearance_(required_clearance()),
      stride_(stop, kWorkBetweenPolls) {
  const Itinerary& itinerary = instance.itinerary(robot);
  const Position& start = itinerary.pose.position;
  for (const std::size_t other : staying) {
    // A robot closes no way before it has arrived where it stays.
    if (other == robot || instance.itinerary(other).t_begin > itinerary.t_begin) continue;
    const Position& center = instance.itinerary(other).pose.position;
    // A robot that starts too near to another robot may leave, but may come no nearer.
    const double reach =
        std::min(instance.views(robot).slimmest_body().pair_radius + instance.body(other).pair_radius,
                 (start - center).norm());
    disks_.push_back({other, center, reach - kSlack, false});
    longest_reach_ = std::max(longest_reach_, reach);
  }
  std::sort(disks_.begin(), disks_.end(),
            [](const Disk& a, const Disk& b) { return a.center.x() < b.center.x(); });
}

/// Returns the distance that the robot's centre keeps from obstacles on its way, metres. It is the robot's
/// smallest radius, or less if the robot is nearer to an obstacle at its start or goal.
double Enclosure::required_clearance() const {
  double clearance = instance_.views(robot_).slimmest_body().wall_radius;
  const Itinerary& itinerary = instance_.itinerary(robot_);
  for (const Position& position : {itinerary.pose.position, itinerary.last_goal().position}) {
    if (instance_.sight_past_walls().disk_fits(position, clearance)) continue;
    clearance = std::min(clearance, obstacle_distance(grid_, position, clearance));
  }
  return clearance - kSlack;
}

Enclosure::Result Enclosure::find(std::int64_t max_steps) {
  Flood last = flood(max_steps);
  if (last.answer != Answer::closed) return {last.answer, {}};
  std::vector<Disk*> removed;
  // Bounded: each robot is removed once, and each flood ends after max_steps or when the stop condition is
  // met.
  while (last.answer == Answer::closed) {
    const std::vector<Disk*>& closing = last.closing[last.closed_side];
    if (closing.empty()) return {Answer::closed, {}};
    for (Disk* disk : closing) {
      if (!disk->removed) removed.push_back(disk);
      disk->removed = true;
    }
    last = flood(max_steps);
  }
  return {Answer::closed, necessary(std::move(removed), max_steps)};
}

std::optional<double> Enclosure::widest_way(double limit, std::int64_t max_steps) {
  const double needed = clearance_;
  if (flood(max_steps).answer != Answer::open) return std::nullopt;
  double open = needed;
  double closed = std::max(needed, 0.5 * limit);
  while (closed - open > kGapAccuracy && !stride_.met()) {
    clearance_ = 0.5 * (open + closed);
    (flood(max_steps).answer == Answer::open ? open : closed) = clearance_;
  }
  clearance_ = needed;
  return 2.0 * open;
}

std::optional<NarrowPlace> Enclosure::narrowest_place(std::int64_t max_steps, std::int64_t& left) {
  const double needed = clearance_;
  double open = 0.5 * kGapAccuracy;
  double closed = needed;
  std::optional<Flood> closing;
  const auto answer_at = [&](double clearance) {
    clearance_ = clearance;
    Flood found = flood(std::min(max_steps, left));
    left -= steps_;
    const Answer answer = found.answer;
    if (answer == Answer::closed) closing = std::move(found);
    return answer;
  };
  if (open >= closed || answer_at(open) != Answer::open || answer_at(closed) != Answer::closed) {
    clearance_ = needed;
    return std::nullopt;
  }
  // Bounded: by the accuracy, each flood by its steps.
  while (closed - open > 0.5 * kGapAccuracy) {
    const double middle = 0.5 * (open + closed);
    const Answer answer = answer_at(middle);
    if (answer == Answer::unknown) break;
    (answer == Answer::open ? open : closed) = middle;
  }
  const bool is_exact = closed - open <= 0.5 * kGapAccuracy;
  const auto gap = is_exact ? gap_of(*closing, open) : std::nullopt;
  clearance_ = needed;
  if (!gap) return std::nullopt;
  return NarrowPlace{*gap, 2.0 * open, 2.0 * (needed + kSlack)};
}

/// Returns the middle of the first border of the area that is closed which is crossable with the narrower
/// clearance.
std::optional<Position> Enclosure::gap_of(Flood& closed, double narrower) {
  clearance_ = narrower;
  const Side own = Flood::kSides[closed.closed_side];
  // Bounded: the cells that the flood reached.
  for (const Cell& cell : closed.cells[closed.closed_side]) {
    if (is_over()) break;
    for (const Step& step : kSteps) {
      const Cell next{cell.column + step.columns, cell.row + step.rows};
      if (!grid_.inside(next) || closed.reached[grid_.index(next)] == own) continue;
      const Border border{grid_.resolution() * Position(cell.column + step.begin_column,  //
                                                        cell.row + step.begin_row),
                          step.columns != 0};
      if (!crossable(border, closed, closed.closed_side)) continue;
      const Position along = border.vertical ? Position(0.0, 1.0) : Position(1.0, 0.0);
      return border.begin + 0.5 * grid_.resolution() * along;
    }
  }
  return std::nullopt;
}

/// Puts the removed disks back, one by one, if the way remains open with them. Returns the robots of the
/// others.
std::vector<std::size_t> Enclosure::necessary(const std::vector<Disk*>& removed, std::int64_t max_steps) {
  std::vector<std::size_t> robots;
  std::int64_t floods = 0;
  for (Disk* disk : removed) {
    disk->removed = false;
    const bool is_closed =
        stride_.met() || ++floods > kMaxFloods || flood(max_steps).answer == Answer::closed;
    if (!is_closed && !stride_.met()) continue;
    disk->removed = true;
    robots.push_back(disk->robot);
  }
  std::sort(robots.begin(), robots.end());
  return robots;
}

Enclosure::Flood Enclosure::flood(std::int64_t max_steps) {
  steps_ = 0;
  Flood flood(grid_);
  const Itinerary& itinerary = instance_.itinerary(robot_);
  const std::array<Cell, 2> begins{grid_.cell_at(itinerary.pose.position),
                                   grid_.cell_at(itinerary.last_goal().position)};
  for (std::size_t side = 0; side < Flood::kSides.size(); ++side) {
    flood.reached[grid_.index(begins[side])] = Flood::kSides[side];
    flood.cells[side].push_back(begins[side]);
  }
  if (begins[0] == begins[1]) flood.answer = Answer::open;
  // Bounded: max_steps, and the stop condition.
  while (flood.answer == Answer::unknown && steps_ <= max_steps && !is_over()) {
    for (std::size_t side = 0; side < Flood::kSides.size() && flood.answer == Answer::unknown; ++side) {
      expand(flood, side);
      if (flood.answer == Answer::open || flood.expanded[side] < flood.cells[side].size()) continue;
      flood.answer = Answer::closed;
      flood.closed_side = side;
    }
  }
  return flood;
}

/// Whether the stop condition was met; asks it once in a while.
bool Enclosure::is_over() { return stride_.met_after(std::exchange(work_, 0)); }

/// Reaches the neighbours of one cell.
void Enclosure::expand(Flood& flood, std::size_t side) {
  const Cell cell = flood.cells[side][flood.expanded[side]++];
  ++work_;
  const double half = 0.5 * grid_.resolution();
  const bool is_open =
      disks_.empty() && instance_.sight_past_walls().surely_free(grid_.center(cell), clearance_) >= half;
  for (const Step& step : kSteps) {
    const Cell next{cell.column + step.columns, cell.row + step.rows};
    if (!grid_.inside(next)) continue;
    Side& reached = flood.reached[grid_.index(next)];
    if (reached == Flood::kSides[side]) continue;
    const Position begin = grid_.resolution() * Position(cell.column + step.begin_column,  //
                                                         cell.row + step.begin_row);
    if (is_open) {
      ++steps_;
    } else if (!crossable({begin, step.columns != 0}, flood, side)) {
      continue;
    }
    if (reached != Side::none) {
      flood.answer = Answer::open;
      return;
    }
    reached = Flood::kSides[side];
    flood.cells[side].push_back(next);
  }
}

/// Whether the robot's centre may be at some point of the border, ends included. If not, and obstacles alone
/// would leave a point, notes the disks that cover it.
bool Enclosure::crossable(const Border& border, Flood& flood, std::size_t side) {
  ++steps_;
  const double length = grid_.resolution();
  const Position middle = border.begin + 0.5 * length *
                                             Position(border.vertical ? 0.0 : 1.0,  //
                                                      border.vertical ? 1.0 : 0.0);
  const std::vector<Disk*> disks = disks_near(border);
  if (disks.empty() && instance_.sight_past_walls().disk_fits(middle, clearance_)) return true;
  if (instance_.sight_past_walls().surely_blocked(middle, clearance_) >= 0.5 * length) {
    cells_near(border);
    return false;
  }
  covered_.clear();
  cover_by_obstacles(border);
  if (fully_covered(length)) return false;
  for (const Disk* disk : disks) cover_by(border, disk->center, disk->center, disk->reach);
  if (!fully_covered(length)) return true;
  flood.closing[side].insert(flood.closing[side].end(), disks.begin(), disks.end());
  return false;
}

/// Returns the disks that may cover a part of the border.
std::vector<Enclosure::Disk*> Enclosure::disks_near(const Border& border) {
  const double length = grid_.resolution();
  const Position end = border.begin + length * Position(border.vertical ? 0.0 : 1.0,  //
                                                        border.vertical ? 1.0 : 0.0);
  const auto first = std::lower_bound(disks_.begin(), disks_.end(), border.begin.x() - longest_reach_,
                                      [](const Disk& d, double x) { return d.center.x() < x; });
  std::vector<Disk*> near;
  auto disk = first;
  for (; disk != disks_.end() && disk->center.x() <= end.x() + longest_reach_; ++disk) {
    const double away = std::max({border.begin.y() - disk->center.y(), disk->center.y() - end.y(), 0.0});
    if (!disk->removed && away < disk->reach) near.push_back(&*disk);
  }
  work_ += static_cast<std::size_t>(disk - first) + kWorkOfCovering * near.size();
  return near;
}

/// Returns the lowest and the highest of the cells that may cover a part of the border. Counts as their
/// examination.
std::pair<Cell, Cell> Enclosure::cells_near(const Border& border) {
  const double far = clearance_ + grid_.resolution();
  const Cell low = grid_.cell_at(border.begin - Position(clearance_, clearance_));
  const Cell high = grid_.cell_at(border.begin + Position(far, far));
  const std::int64_t cells =
      static_cast<std::int64_t>(high.column - low.column + 1) * (high.row - low.row + 1);
  steps_ += cells / kCellsPerStep;
  work_ += static_cast<std::size_t>(cells);
  return {low, high};
}

void Enclosure::cover_by_obstacles(const Border& border) {
  const auto [low, high] = cells_near(border);
  // Bounded: the cells near one border; they count as steps.
  for (int row = low.row; row <= high.row; ++row) {
    for (int column = low.column; column <= high.column; ++column) {
      if (!grid_.blocked({column, row})) continue;  // cells outside the map are
      const Position corner = grid_.resolution() * Position(column, row);
      cover_by(border, corner, corner + Position(grid_.resolution(), grid_.resolution()), clearance_);
    }
  }
}

/// Covers the points of the border that are nearer than `distance` to the box from `low` to `high`.
void Enclosure::cover_by(const Border& border, const Position& low, const Position& high, double distance) {
  const int along = border.vertical ? 1 : 0;
  const int across = 1 - along;
  const double away =
      std::max({low[across] - border.begin[across], border.begin[across] - high[across], 0.0});
  if (away >= distance) return;
  const double half = std::sqrt(distance * distance - away * away);
  covered_.push_back({low[along] - half - border.begin[along], high[along] + half - border.begin[along]});
}

bool Enclosure::fully_covered(double length) {
  std::sort(covered_.begin(), covered_.end(),
            [](const Covered& a, const Covered& b) { return a.begin < b.begin; });
  double free_from = 0.0;
  for (const Covered& covered : covered_) {
    if (covered.begin >= free_from) return false;
    free_from = std::max(free_from, covered.end);
  }
  return free_from > length;
}

}  // namespace fleetplan::core
