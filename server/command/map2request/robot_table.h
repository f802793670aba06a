#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/command/files.h"

namespace fleetplan::server {

/// A table of robots as CSV.
struct RobotTable {
  std::string file;                // its name
  std::string json;                // the member `robots` of a request
  std::vector<std::size_t> lines;  // of the file, from 1, by robot
};

/// Reads a table with a header line (docs/command_line.md has the columns): RFC 4180 without line breaks in
/// fields, with commas, semicolons or tabs. Fields that are empty are left out of the request.
api::Result<RobotTable, InputFault> read_robot_table(const std::string& file, std::istream& in);

}  // namespace fleetplan::server
