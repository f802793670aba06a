#include "api/request/map/cell_letters.h"

#include <array>
#include <cstdint>

namespace fleetplan::api {

namespace {

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

}  // namespace

std::optional<std::size_t> first_other_letter(std::string_view row, CellLetters letters) {
  for (std::size_t at = 0; at < row.size(); ++at) {
    const std::uint8_t kind = kind_of(row[at]);
    if (kind == kOther || (kind == kSwamp && letters == CellLetters::of_rows)) return at;
  }
  return std::nullopt;
}

std::string_view character_at(std::string_view text, std::size_t offset) {
  std::size_t end = offset + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return text.substr(offset, end - offset);
}

core::OccupancyGrid draw(const std::vector<std::string_view>& rows, double resolution, core::Work& stop) {
  const int columns = static_cast<int>(rows.front().size());
  const int height = static_cast<int>(rows.size());
  core::OccupancyGrid grid(columns, height, resolution);
  for (int line = 0; line < height && !stop.met_after(rows.front().size()); ++line) {
    const std::string_view row = rows[static_cast<std::size_t>(line)];
    for (int column = 0; column < columns; ++column) {
      if (kind_of(row[static_cast<std::size_t>(column)]) == kBlocked) grid.block({column, height - 1 - line});
    }
  }
  return grid;
}

}  // namespace fleetplan::api
