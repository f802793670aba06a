#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/map/parse_map.h"
#include "core/runtime/stop_condition.h"
#include "server/command/commands.h"

namespace fleetplan::server {

namespace {

/// The most bytes of a map or a scenario: the largest published map has 3 MB, the longest scenario 7 MB.
constexpr std::size_t kMaxFile = std::size_t{32} << 20;

/// What is said if the work of reading is spent.
constexpr const char* kTooLong =
    "reading takes too long; give a smaller map, fewer lines, a smaller --count or a smaller --radius.";

/// Metres by which disks may overlap after rounding, below the tolerance of the service.
constexpr double kSlack = 1e-10;

/// A line of a scenario.
struct Entry {
  std::size_t line = 0;  // in the file, from 1
  std::string map;       // name of the map's file
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  core::Cell start;  // row 0 at the top
  core::Cell goal;
};

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::optional<int> natural_of(std::string_view word) {
  int number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_whole = error == std::errc() && end == word.data() + word.size() && number >= 0;
  return is_whole ? std::optional(number) : std::nullopt;
}

/// Reads a line of a scenario: bucket, map, width, height, x and y of start and goal, optimal length. The
/// name of the map may have blanks.
std::optional<Entry> entry_of(std::string_view text, std::size_t line) {
  constexpr std::size_t kNumbers = 6;
  constexpr std::size_t kFields = kNumbers + 3;
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() < kFields || !natural_of(words[0]) || !read_number(words.back())) return std::nullopt;
  const std::size_t first = words.size() - 1 - kNumbers;
  std::vector<int> numbers;
  numbers.reserve(kNumbers);
  for (std::size_t at = first; at + 1 < words.size(); ++at) {
    const auto number = natural_of(words[at]);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  const std::string_view& last = words[first - 1];
  const std::string_view name(words[1].data(),
                              static_cast<std::size_t>(last.data() + last.size() - words[1].data()));
  return Entry{line,       std::string(name),        numbers[0],
               numbers[1], {numbers[2], numbers[3]}, {numbers[4], numbers[5]}};
}

/// The map of a request, and its cells.
struct ScenarioMap {
  std::string json;  // the member `map`
  core::OccupancyGrid grid;
};

api::Result<ScenarioMap, InputFault> read_map(const std::string& file, const api::Limits& limits,
                                              std::istream& in, core::Work& work) {
  const auto text = read_file(file, in, std::min(kMaxFile, limits.max_body));
  if (!text) return text.failure();
  api::JsonWriter json;
  const std::string member =
      json.begin_object().member("movingai", std::string_view(*text)).end_object().take();
  constexpr int kDepth = 2;
  auto document = api::read_json(member, kDepth, work);
  if (!document) return input_fault(file, 0, document.failure().detail);
  auto map = api::parse_map(api::JsonReader(*document), limits.max_cells);
  if (!map) {
    const std::vector<api::Fault> faults = document->faults.listed();
    return input_fault(file, 0, faults.empty() ? kTooLong : faults[0].detail);
  }
  return ScenarioMap{member, std::move(map->grid)};
}

/// Chooses the first entries whose disks fit between the walls and beside those chosen before.
class EntryChooser {
 public:
  EntryChooser(const ScenarioFleet& fleet, const core::OccupancyGrid& grid, core::Work& work)
      : fleet_(fleet), grid_(grid), work_(work) {}

  bool is_full() const { return chosen_.size() >= fleet_.count; }
  const std::vector<Entry>& chosen() const { return chosen_; }
  /// The lines of those chosen, in the file, from 1.
  std::vector<std::size_t> lines() const {
    std::vector<std::size_t> lines;
    lines.reserve(chosen_.size());
    for (const Entry& entry : chosen_) lines.push_back(entry.line);
    return lines;
  }
  std::size_t in_walls() const { return in_walls_; }
  std::size_t overlapping() const { return overlapping_; }

  /// The centre of a cell, whose row counts from the top. Metres, in the frame of the map.
  core::Position centre(core::Cell cell) const {
    constexpr double kHalf = 0.5;
    return {cell.column + kHalf, grid_.height() - cell.row - kHalf};
  }

  /// Chooses the entry if it is possible. Returns false if the work of reading is spent.
  bool offer(const Entry& entry) {
    if (work_.met_after(work_of_entry())) return false;
    if (!fits(entry.start) || !fits(entry.goal)) {
      ++in_walls_;
    } else if (std::any_of(chosen_.begin(), chosen_.end(), [&](const Entry& other) {
                 return overlap(other.start, entry.start) || overlap(other.goal, entry.goal);
               })) {
      ++overlapping_;
    } else {
      chosen_.push_back(entry);
    }
    return true;
  }

 private:
  /// The cells and the earlier entries that are looked at, at most.
  std::size_t work_of_entry() const {
    const double cells = std::min(4.0 * fleet_.radius * fleet_.radius, grid_.width() * grid_.height());
    return 1 + 2 * (static_cast<std::size_t>(cells) + chosen_.size());
  }

  bool fits(core::Cell cell) const {
    return core::obstacle_distance(grid_, centre(cell), fleet_.radius) >= fleet_.radius - kSlack;
  }

  bool overlap(core::Cell one, core::Cell other) const {
    return (centre(one) - centre(other)).norm() < 2 * (fleet_.radius - kSlack);
  }

  const ScenarioFleet& fleet_;
  const core::OccupancyGrid& grid_;
  core::Work& work_;
  std::vector<Entry> chosen_;
  std::size_t in_walls_ = 0;
  std::size_t overlapping_ = 0;
};

/// Reads entries until enough are chosen. Returns what is wrong with the first one that cannot be used.
std::optional<InputFault> choose_entries(const std::string& file, std::string_view text,
                                         EntryChooser& chooser, const core::OccupancyGrid& grid) {
  const auto columns = static_cast<std::int64_t>(grid.columns());
  const auto rows = static_cast<std::int64_t>(grid.rows());
  for (std::size_t line = 1; !text.empty() && !chooser.is_full(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (words_of(row).empty() || (line == 1 && words_of(row)[0] == "version")) continue;
    const auto entry = entry_of(row, line);
    if (!entry) {
      return input_fault(file, line,
                         "a line of a scenario has: bucket, map, width, height, start x and y, goal x and y, "
                         "optimal length.");
    }
    if (entry->columns != columns || entry->rows != rows) {
      return input_fault(file, line,
                         "the scenario is for " + api::in_quotes(entry->map) + " of " +
                             std::to_string(entry->columns) + " x " + std::to_string(entry->rows) +
                             " cells, but the map has " + std::to_string(columns) + " x " +
                             std::to_string(rows) + "; give the map that it is for.");
    }
    for (const core::Cell cell : {entry->start, entry->goal}) {
      if (grid.inside(cell)) continue;
      return input_fault(file, line,
                         "column " + std::to_string(cell.column) + ", row " + std::to_string(cell.row) +
                             " (both from 0) is outside the map.");
    }
    if (!chooser.offer(*entry)) return input_fault(file, 0, kTooLong);
  }
  return std::nullopt;
}

std::string request_of(const ScenarioMap& map, const ScenarioFleet& fleet, const EntryChooser& chooser) {
  api::JsonWriter json;
  json.begin_object().key("map").json(map.json).key("robot_defaults").begin_object();
  json.member("radius", fleet.radius).member("linear_speed", fleet.linear_speed);
  json.member("angular_speed", fleet.angular_speed).end_object().key("robots").begin_array();
  for (std::size_t robot = 0; robot < chooser.chosen().size(); ++robot) {
    const Entry& entry = chooser.chosen()[robot];
    const core::Position start = chooser.centre(entry.start);
    const core::Position goal = chooser.centre(entry.goal);
    json.begin_object().member("id", std::string_view("r" + std::to_string(robot + 1)));
    json.key("start").begin_object().member("x", start.x()).member("y", start.y()).end_object();
    json.key("goal").begin_object().member("x", goal.x()).member("y", goal.y()).end_object().end_object();
  }
  return json.end_array().end_object().take() + '\n';
}

}  // namespace

int scenario_to_request(const std::string& map_file, const std::string& scenario_file,
                        const ScenarioFleet& fleet, const std::string& output, const api::Limits& limits,
                        const Streams& streams) {
  core::Work work(core::Work::Bounds{});
  const auto map = read_map(map_file, limits, streams.in, work);
  if (!map) return refuse(map.failure(), streams);
  const auto text = read_file(scenario_file, streams.in, kMaxFile);
  if (!text) return refuse(text.failure(), streams);
  EntryChooser chooser(fleet, map->grid, work);
  if (const auto fault = choose_entries(scenario_file, *text, chooser, map->grid))
    return refuse(*fault, streams);
  const std::string skipped = std::to_string(chooser.in_walls()) +
                              " entries were skipped because a disk of this radius touches a wall, " +
                              std::to_string(chooser.overlapping()) + " because it overlaps an earlier one.";
  if (chooser.chosen().empty()) {
    return refuse(input_fault(scenario_file, 0, "no entry can be used: " + skipped), streams);
  }
  RequestFiles files{map_file, scenario_file, chooser.lines()};
  const auto note = [&](const std::string& detail) {
    files.notes.push_back(input_fault(scenario_file, 0, detail).line);
  };
  if (chooser.in_walls() + chooser.overlapping() > 0) note(skipped);
  if (!chooser.is_full()) note("only " + std::to_string(chooser.chosen().size()) + " robots could be used.");
  return write_request(request_of(*map, fleet, chooser), files, output, limits, streams);
}

}  // namespace fleetplan::server
