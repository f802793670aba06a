#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "server/command/commands.h"

namespace fleetplan::server {

/// A map.yaml of ROS and its image.
struct RosMapFile {
  std::string yaml;                                       // name of the file
  std::string image;                                      // name of the file
  std::string json;                                       // the member `image` of a map with both
  std::map<std::string, std::size_t, std::less<>> lines;  // line in the yaml, from 1, by member
  std::vector<std::string> ignored;                       // lines for people about members without effect
};

/// Reads both files as map_server does: the image beside the yaml, unless its path is absolute. Does not look
/// at whether the image can be decoded.
api::Result<RosMapFile, InputFault> read_ros_map(const std::string& yaml, std::istream& in);

/// `fleetplan map2request`: writes a request of /v1/plan for a map of ROS and a table of robots. Refuses what
/// the service would, with the file and the line of each fault. Returns the exit code.
int map_to_request(const std::string& yaml, const std::string& robots, const std::string& output,
                   const Streams& streams);

}  // namespace fleetplan::server
