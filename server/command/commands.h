#pragma once

// The program without a server:
//
// - its commands, their input and output, faults of input, and exit codes,
// - requests from files of ROS, and of the MovingAI benchmarks,
// - and the probe of a running server.

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/errors.h"
#include "server/ops/settings.h"
#include "server/service/service.h"

namespace fleetplan::server {

/// The streams of a process.
struct Streams {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  bool shows_progress = false;  // `err` is a terminal
};

/// Exit codes of commands.
inline constexpr int kSolved = 0;     // also for a valid plan, or for what else was asked for
inline constexpr int kFailed = 1;     // not the request's fault: out of time or memory, a file, a bug
inline constexpr int kPartial = 2;    // some robots have no plan; plans are not valid
inline constexpr int kNone = 3;       // no robot has a plan
inline constexpr int kBadInput = 64;  // the request or the command line, as EX_USAGE of sysexits.h

/// Why input cannot be used, as a line for people: "map.yaml:3: resolution is missing; give ...".
struct InputFault {
  std::string line;
};

/// Makes a fault. `line`: the line in the file, from 1; 0: the file as a whole.
InputFault input_fault(const std::string& file, std::size_t line, const std::string& detail);

/// Prints a fault; returns the exit code.
int refuse(const InputFault& fault, const Streams& streams);

/// Reads all of a file, or of `in` for "-". A file of more than `max_bytes` is not read to its end.
api::Result<std::string, InputFault> read_file(
    const std::string& name, std::istream& in,
    std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

/// Returns the name of an input file for messages.
std::string shown_name(const std::string& file);

/// Writes the text to a file. Returns whether all of it was written.
bool write_file(const std::string& name, const std::string& text);

/// Writes the result of a command to a file, or to the standard output if the name is empty. Returns the exit
/// code.
int write_output(const std::string& name, const std::string& text, const Streams& streams);

/// Reports why a command fails; returns the exit code.
int fail(const Streams& streams, int code, const std::string& message);

/// Reads a finite number with a point, such as "-1.5e3" or "+2". None if the text is anything else.
std::optional<double> read_number(std::string_view text);

/// Runs `fleetplan COMMAND ...`, which answers one request from a file as the service would over HTTP.
/// Returns the exit code. Returns nothing if the arguments name no command: then they are settings of the
/// server. `make_service` is called only if the command needs the service.
std::optional<int> run_command(std::vector<std::string> arguments,
                               const std::function<Service()>& make_service, const Streams& streams);

/// Requests /healthz of the service that runs with these settings, perhaps in another process. It uses the
/// admin port if there is one, because this port answers even if the main port is busy. Returns the fault, if
/// there is one.
///
/// The probe is for liveness, not readiness. If a container were restarted because it drains or its queue is
/// full, it would lose its running plans.
std::optional<std::string> health_fault(const Settings& settings);

/// A map.yaml of ROS and its image.
struct RosMapFile {
  std::string yaml;                                       // name of the file
  std::string image;                                      // name of the file
  std::string json;                                       // the member `image` of a map with both
  std::map<std::string, std::size_t, std::less<>> lines;  // line in the yaml, from 1, by member
  std::vector<std::string> ignored;                       // lines for people about members without effect
};

/// Reads both files in the same way as map_server. The image is beside the yaml, unless its path is absolute.
/// Does not check whether the image can be decoded.
api::Result<RosMapFile, InputFault> read_ros_map(const std::string& yaml, std::istream& in);

/// `fleetplan map2request`: writes a request of /v1/plan for a map of ROS and a table of robots. Refuses what
/// the service would refuse, with the file and the line of each fault. Returns the exit code.
int map_to_request(const std::string& yaml, const std::string& robots, const std::string& output,
                   const api::Limits& limits, const Streams& streams);

/// The files that a request is made of.
struct RequestFiles {
  std::string map;                       // name of the file
  std::string robots;                    // name of the file
  std::vector<std::size_t> robot_lines;  // line in it, from 1, by robot
  /// Returns a fault of the map at its place. Without it, the fault is of the whole file.
  std::function<InputFault(const api::Fault&)> in_map = nullptr;
  std::vector<std::string> notes = {};  // lines for people, if the request is written
};

/// Writes a request that is made of files, with its notes and warnings. Refuses what the service would
/// refuse, with the file and the line of each fault. Returns the exit code.
int write_request(const std::string& body, const RequestFiles& files, const std::string& output,
                  const api::Limits& limits, const Streams& streams);

/// The robots that are made of the entries of a scenario.
struct ScenarioFleet {
  std::size_t count = 100;  // at most
  double radius = 0.4;      // metres
  double linear_speed = 1.0;
  double angular_speed = 3.14;
};

/// `fleetplan map2request` for a map and a scenario of the MovingAI benchmarks: each of the first entries
/// that are possible becomes a robot, at the centres of the cells; a cell is 1 m wide. An entry is skipped if
/// its disk touches a wall or overlaps an earlier one, and a note tells how many were. Refuses like
/// map_to_request. Returns the exit code.
int scenario_to_request(const std::string& map_file, const std::string& scenario_file,
                        const ScenarioFleet& fleet, const std::string& output, const api::Limits& limits,
                        const Streams& streams);

}  // namespace fleetplan::server
