// Any bytes as the file of a map: a request with it is parsed into a valid problem or properly rejected. The
// first byte selects the kind of file and what its shades mean.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "api/request/parse_request.h"
#include "tests/fuzz/refusals.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/small_limits.h"
#include "tests/fuzz/target.h"
#include "tests/support/base64.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::fuzz {

namespace TEST_FILE {

using Json = nlohmann::json;

constexpr std::size_t kSignature = 8;  // bytes of a PNG before its chunks

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

/// The file with correct check sums, without which no change of a PNG would get past them.
std::string with_check_sums(std::string file) {
  std::size_t at = kSignature;
  while (at + 12 <= file.size()) {
    std::uint64_t length = 0;
    for (std::size_t index = 0; index < 4; ++index)
      length = length << 8U | static_cast<unsigned char>(file[at + index]);
    if (at + 12 + length > file.size()) break;
    const std::uint32_t crc = crc32(std::string_view(file).substr(at + 4, length + 4));
    at += 8 + length;
    for (std::size_t index = 0; index < 4; ++index) file[at++] = static_cast<char>(crc >> (24U - 8U * index));
  }
  return file;
}

Json map_of(std::uint8_t form, const std::string& file) {
  switch (form % 4) {
    case 0:
      return {{"movingai", file}};
    case 1:
      return {{"image", {{"pgm", file}, {"resolution", 0.1}}}};  // most often not base64
    default:
      break;
  }
  const bool is_png = form % 4 == 2;
  return {{"image",
           {{is_png ? "png" : "pgm", support::base64(is_png ? with_check_sums(file) : file)},
            {"resolution", 0.1},
            {"mode", form / 4 % 3 == 0   ? "trinary"
                     : form / 4 % 3 == 1 ? "scale"
                                         : "raw"},
            {"negate", form / 12 % 2},
            {"release", form / 48 % 2 == 0 ? "jazzy" : "humble"}}},
          {"unknown", form / 24 % 2 == 0 ? "blocked" : "free"}};
}

/// The image of a map as a mask of speeds, turned.
Json zones_with(const Json& map, int quarter_turns) {
  Json mask = map["image"];
  mask["resolution"] = 0.07;
  mask["origin"] = {0.3, 0.1, 1.5708 * quarter_turns};
  if (quarter_turns % 2 == 1) mask.update({{"base", 30}, {"multiplier", 0.7}});
  return Json::array({{{"id", "z"}, {"type", "speed"}, {"mask", mask}}});
}

void try_map(std::uint8_t form, const std::string& file) {
  Json request{{"map", map_of(form, file)},
               {"robots",
                {{{"id", "a"},
                  {"radius", 0.001},
                  {"linear_speed", 1},
                  {"angular_speed", 1},
                  {"start", {{"x", 0.05}, {"y", 0.05}}}}}}};
  const int zones = form / 48;
  if (zones > 0 && request["map"].contains("image")) request["zones"] = zones_with(request["map"], zones - 1);
  const std::string body = request.dump(-1, ' ', false, Json::error_handler_t::replace);
  const api::Limits limits = small_limits();
  const auto parsed = api::parse_request(body, limits, unbounded_work());
  if (!parsed) return require_proper_refusal(body, api::problem_reply(parsed.failure(), "id"));
  const auto& grid = parsed->problem.grid();
  require(grid.columns() >= 1 && grid.rows() >= 1 && grid.cell_count() <= limits.max_cells,
          "the map is outside the limits");
  require(!grid.blocked({0, 0}), "a robot stands in a blocked cell");
}

void run(Input input) {
  if (!input.empty()) try_map(input[0], std::string(text_of(input).substr(1)));
}

const Target target("map", run);

}  // namespace TEST_FILE

}  // namespace fleetplan::fuzz
