#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/errors.h"
#include "api/request/map/parse_map.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

namespace {

/// The letters that cells are drawn with: of the rows of a request, or of MovingAI's maps, whose swamp, S, is
/// free as well.
enum class CellLetters { of_rows, of_movingai };

constexpr std::uint8_t kOther = 0;
constexpr std::uint8_t kFree = 1;
constexpr std::uint8_t kBlocked = 2;
constexpr std::uint8_t kSwamp = 3;

constexpr std::array<std::uint8_t, 256> make_kinds() {
  std::array<std::uint8_t, 256> kinds{};
  for (const char letter : std::string_view(".G")) kinds[static_cast<unsigned char>(letter)] = kFree;
  for (const char letter : std::string_view("#@OTW")) kinds[static_cast<unsigned char>(letter)] = kBlocked;
  kinds['S'] = kSwamp;
  return kinds;
}
constexpr std::array<std::uint8_t, 256> kLetterKinds = make_kinds();

std::uint8_t kind_of(char letter) { return kLetterKinds[static_cast<unsigned char>(letter)]; }

/// Returns where the first character is that is not such a letter.
std::optional<std::size_t> first_other_letter(std::string_view row, CellLetters letters) {
  for (std::size_t at = 0; at < row.size(); ++at) {
    const std::uint8_t kind = kind_of(row[at]);
    if (kind == kOther || (kind == kSwamp && letters == CellLetters::of_rows)) return at;
  }
  return std::nullopt;
}

/// Returns the character of UTF-8 that begins at the offset.
std::string_view character_at(std::string_view text, std::size_t offset) {
  std::size_t end = offset + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return text.substr(offset, end - offset);
}

/// Returns the grid of valid rows of one length, the top one first. Ends early when `work` is met.
core::OccupancyGrid draw(const std::vector<std::string_view>& rows, double resolution, core::Work& work) {
  const int columns = static_cast<int>(rows.front().size());
  const int height = static_cast<int>(rows.size());
  core::OccupancyGrid grid(columns, height, resolution);
  for (int line = 0; line < height && !work.met_after(rows.front().size()); ++line) {
    const std::string_view row = rows[static_cast<std::size_t>(line)];
    for (int column = 0; column < columns; ++column) {
      if (kind_of(row[static_cast<std::size_t>(column)]) == kBlocked) grid.block({column, height - 1 - line});
    }
  }
  return grid;
}

/// Returns the fault of a row of `columns` cells.
std::string row_fault(const JsonReader& item, std::size_t number, std::size_t columns) {
  const std::string place = "Row " + std::to_string(number) + " of the map";
  const auto row = item.string();
  if (!row) return place + " must be a string, not " + item.description() + ".";
  if (row->empty()) return place + " is empty; a row has at least one cell.";
  if (const auto bad = first_other_letter(*row, CellLetters::of_rows)) {
    return place + " has " + in_quotes(character_at(*row, *bad)) + " in column " + std::to_string(*bad) +
           " (both from 0); free cells are . and G, blocked ones #, @, O, T and W.";
  }
  return place + " (from 0) has " + std::to_string(row->size()) + " cells, but row 0 has " +
         std::to_string(columns) + "; all rows must be of the same length.";
}

/// Returns the row, if it is one of this many columns.
std::optional<std::string_view> parse_row(const JsonReader& item, std::size_t number, std::size_t columns) {
  const auto row = item.string();
  const bool usable = row && row->size() == columns && !row->empty();
  if (usable && !first_other_letter(*row, CellLetters::of_rows)) return row;
  const char* const code = !row ? fault::kWrongType : row->empty() ? fault::kEmpty : fault::kBadMapRow;
  item.fault(code, [&] { return row_fault(item, number, columns); });
  return std::nullopt;
}

/// Returns the rows, if all of them are valid and there are not too many cells.
std::optional<std::vector<std::string_view>> parse_rows(const JsonReader& member, std::int64_t max_cells) {
  const JsonReader items = member.array();
  if (!items) return std::nullopt;
  if (items.size() == 0) {
    items.fault(fault::kEmpty, "rows must contain at least one row of the map.");
    return std::nullopt;
  }
  const std::size_t columns = items.item(0).string().value_or("").size();
  if (!check_cells(items, columns, items.size(), max_cells)) return std::nullopt;
  std::vector<std::string_view> rows;
  rows.reserve(items.size());
  std::size_t number = 0;
  for (const JsonReader item : items.items()) {
    if (const auto row = parse_row(item, number++, columns)) rows.push_back(*row);
  }
  if (rows.size() != items.size()) return std::nullopt;
  return rows;
}

}  // namespace

std::optional<WorldMap> parse_rows_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const MapFrame frame = parse_map_frame(map);
  const JsonReader member = map.find("rows");
  const auto rows = parse_rows(member, max_cells);
  const JsonReader resolution = map.find("resolution");
  if (rows) {
    const auto columns = static_cast<double>(rows->front().size());
    check_extent(resolution ? resolution : member, columns, static_cast<double>(rows->size()),
                 frame.resolution);
  }
  if (!rows || map.fault_count() != before) return std::nullopt;
  return WorldMap{draw(*rows, frame.resolution, map.work()), frame.frame, {frame.frame.origin, 0}, {}};
}

namespace {

constexpr std::size_t kMaxDigits = 9;  // digits of a width or height

/// Reads the lines of a text, with any line endings.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool at_end() const { return ended_; }
  std::size_t number() const { return number_; }  // number of the line read last, from 1

  std::string_view next() {
    ++number_;
    const std::size_t end = rest_.find_first_of("\r\n");
    const std::string_view line = rest_.substr(0, end);
    ended_ = end == std::string_view::npos;
    if (!ended_) rest_.remove_prefix(end + (rest_.substr(end).starts_with("\r\n") ? 2 : 1));
    return line;
  }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
  bool ended_ = false;
};

bool is_space(char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }

/// Returns the words of a line, at most three of them.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  const char* at = line.data();
  const char* const end = at + line.size();
  while (words.size() < 3) {
    at = std::find_if_not(at, end, is_space);
    const char* const after = std::find_if(at, end, is_space);
    if (at == after) break;
    words.emplace_back(at, static_cast<std::size_t>(after - at));
    at = after;
  }
  return words;
}

/// Returns a whole number above 0, without leading zeros.
std::optional<std::uint64_t> side_of(std::string_view word) {
  const bool digits = std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || word.size() > kMaxDigits || word.front() == '0') return std::nullopt;
  return std::stoull(std::string(word));
}

struct Sizes {
  std::optional<std::uint64_t> width;
  std::optional<std::uint64_t> height;
};

std::string header_fault(std::size_t number, std::string_view line) {
  return "Line " + std::to_string(number) + " is " + in_quotes(line) +
         R"(, where the header of a MovingAI map is expected: "type octile", "height" and "width" with a whole )" +
         R"(number each, then "map".)";
}

/// Reads lines until "map".
Result<Sizes, std::string> read_header(Lines& lines) {
  Sizes sizes;
  while (!lines.at_end()) {
    const std::string_view line = lines.next();
    const auto words = words_of(line);
    if (words.size() == 1 && words[0] == "map") {
      if (sizes.width && sizes.height) return sizes;
      const std::string missing = sizes.height ? "width" : "height";
      std::string detail = "The header names no " + missing;
      detail.append(R"(: add a line ")").append(missing).append(R"( ..." before the line "map".)");
      return detail;
    }
    const auto side = words.size() == 2 ? side_of(words[1]) : std::nullopt;
    if (side && words[0] == "width") {
      sizes.width = side;
    } else if (side && words[0] == "height") {
      sizes.height = side;
    } else if (words.size() != 2 || words[0] != "type") {
      return header_fault(lines.number(), line);
    }
  }
  return std::string(R"(There is no line "map" that ends the header of a MovingAI map.)");
}

std::string row_fault(std::string_view row, std::size_t number, std::uint64_t width) {
  const std::string place = "Line " + std::to_string(number);
  if (const auto bad = first_other_letter(row, CellLetters::of_movingai)) {
    return place + " has " + in_quotes(character_at(row, *bad)) + " in column " + std::to_string(*bad + 1) +
           "; free cells are ., G and S, blocked ones @, O, T, W and #.";
  }
  return place + " has " + std::to_string(row.size()) + " cells, but the header has width " +
         std::to_string(width) + "; all rows must be of that length.";
}

std::string height_fault(std::uint64_t height, std::size_t rows) {
  return "The header has height " + std::to_string(height) + ", but " + std::to_string(rows) +
         R"( rows follow "map". Correct the height, or fetch the map again: it may be truncated.)";
}

bool is_blank(std::string_view line) { return std::all_of(line.begin(), line.end(), is_space); }

/// Reads the rows after the header. Blank lines may follow.
Result<std::vector<std::string_view>, std::string> read_rows(Lines& lines, std::uint64_t width,
                                                             std::uint64_t height, core::Work& work) {
  std::vector<std::string_view> rows;
  while (!lines.at_end() && !work.met_after(width)) {
    const std::string_view row = lines.next();
    if (rows.size() == height) {
      if (is_blank(row)) continue;
      return height_fault(height, rows.size() + 1);
    }
    if (is_blank(row)) return height_fault(height, rows.size());
    if (row.size() != width || first_other_letter(row, CellLetters::of_movingai)) {
      return row_fault(row, lines.number(), width);
    }
    rows.push_back(row);
  }
  if (rows.size() != height && !work.met()) return height_fault(height, rows.size());
  return rows;
}

}  // namespace

std::optional<WorldMap> parse_movingai_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const MapFrame frame = parse_map_frame(map);
  const JsonReader member = map.find("movingai");
  const auto text = member.string();
  if (!text) {
    member.must_be(fault::kWrongType, "a string, the text of a .map file");
    return std::nullopt;
  }
  const auto wrong = [&](const std::string& detail) {
    member.fault(fault::kBadMovingAi, detail);
    return std::nullopt;
  };
  Lines lines(*text);
  const auto sizes = read_header(lines);
  if (!sizes) return wrong(sizes.failure());
  if (!check_cells(member, *sizes->width, *sizes->height, max_cells)) return std::nullopt;
  const auto rows = read_rows(lines, *sizes->width, *sizes->height, map.work());
  if (!rows) return wrong(rows.failure());
  const JsonReader resolution = map.find("resolution");
  check_extent(resolution ? resolution : member, static_cast<double>(*sizes->width),
               static_cast<double>(*sizes->height), frame.resolution);
  if (map.fault_count() != before || map.work().met()) return std::nullopt;
  return WorldMap{draw(*rows, frame.resolution, map.work()), frame.frame, {frame.frame.origin, 0}, {}};
}

}  // namespace fleetplan::api
