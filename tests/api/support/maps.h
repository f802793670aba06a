#pragma once

// One building as every kind of map that a request may have.

#include <string>
#include <vector>

#include "tests/api/support/images.h"
#include "tests/api/support/requests.h"
#include "tests/support/base64.h"

namespace fleetplan::api {

using Picture = std::vector<std::string>;  // `.` free, `#` blocked, `?` unknown; the top row first

inline constexpr double kCell = 0.5;
inline constexpr double kLeft = -2.0;
inline constexpr double kBottom = 1.5;

inline Json rows_map(const Picture& picture) {
  return {{"rows", picture}, {"resolution", kCell}, {"origin", {{"x", kLeft}, {"y", kBottom}}}};
}

inline Json movingai_map(const Picture& picture) {
  std::string text = "type octile\nheight " + std::to_string(picture.size()) + "\nwidth " +
                     std::to_string(picture.front().size()) + "\nmap\n";
  for (const std::string& row : picture) text += row + "\n";
  Json map = rows_map({});
  map.erase("rows");
  map["movingai"] = text;
  return map;
}

inline Json occupancy_grid_map(const Picture& picture) {
  Json data = Json::array();
  for (auto row = picture.rbegin(); row != picture.rend(); ++row) {
    for (const char cell : *row) data.push_back(cell == '#' ? 100 : cell == '?' ? -1 : 0);
  }
  return {{"occupancy_grid",
           {{"header", {{"stamp", {{"sec", 17}, {"nanosec", 4}}}, {"frame_id", "map"}}},
            {"info",
             {{"map_load_time", {{"sec", 0}, {"nanosec", 0}}},
              {"resolution", kCell},
              {"width", picture.front().size()},
              {"height", picture.size()},
              {"origin",
               {{"position", {{"x", kLeft}, {"y", kBottom}, {"z", 0.0}}},
                {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", 1.0}}}}}}},
            {"data", data}}}};
}

/// The grays of a picture, as map_saver writes them.
inline Samples grays_of(const Picture& picture) {
  Samples rows;
  for (const std::string& line : picture) {
    rows.emplace_back();
    for (const char cell : line) rows.back().push_back(cell == '#' ? 0 : cell == '?' ? 205 : 254);
  }
  return rows;
}

inline Json image_map(const std::string& format, const std::string& file) {
  return {{"image",
           {{format, support::base64(file)},
            {"resolution", kCell},
            {"origin", {kLeft, kBottom, 0.0}},
            {"negate", 0},
            {"occupied_thresh", 0.65},
            {"free_thresh", 0.196}}}};
}

inline Json pgm_map(const Picture& picture) { return image_map("pgm", pgm(grays_of(picture))); }

inline Json png_map(const Picture& picture) {
  return image_map("png", png(static_cast<int>(picture.front().size()), grays_of(picture)));
}

}  // namespace fleetplan::api
