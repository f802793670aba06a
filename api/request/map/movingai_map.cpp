#include "api/request/map/movingai_map.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/faults.h"
#include "api/json/result.h"
#include "api/request/map/cell_letters.h"

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostDigits = 9;  // of a width or height

/// The lines of a text, with any line endings.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool at_end() const { return ended_; }
  std::size_t number() const { return number_; }  // of the line that was read last, from 1

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

/// The words of a line, at most three of them.
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

/// A whole number above 0, without leading zeros.
std::optional<std::uint64_t> side_of(std::string_view word) {
  const bool digits = std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || word.size() > kMostDigits || word.front() == '0') return std::nullopt;
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

/// The rows after the header. Blank lines may follow.
Result<std::vector<std::string_view>, std::string> read_rows(Lines& lines, std::uint64_t width,
                                                             std::uint64_t height, core::Work& stop) {
  std::vector<std::string_view> rows;
  while (!lines.at_end() && !stop.met_after(width)) {
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
  if (rows.size() != height && !stop.met()) return height_fault(height, rows.size());
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
  const auto rows = read_rows(lines, *sizes->width, *sizes->height, map.stop());
  if (!rows) return wrong(rows.failure());
  const JsonReader resolution = map.find("resolution");
  check_extent(resolution ? resolution : member, static_cast<double>(*sizes->width),
               static_cast<double>(*sizes->height), frame.resolution);
  if (map.fault_count() != before || map.stop().met()) return std::nullopt;
  return WorldMap{draw(*rows, frame.resolution, map.stop()), frame.frame};
}

}  // namespace fleetplan::api
