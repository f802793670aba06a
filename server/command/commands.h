#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "server/service.h"

namespace fleetplan::server {

/// The streams of a process.
struct Streams {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  bool shows_progress = false;  // `err` is a terminal
};

/// Exit codes of commands.
inline constexpr int kSolved = 0;     // also: valid, or what was asked for
inline constexpr int kFailed = 1;     // not by the request's fault: out of time or memory, a file, a bug
inline constexpr int kPartial = 2;    // some robots have no plan; plans are not valid
inline constexpr int kNone = 3;       // no robot has a plan
inline constexpr int kBadInput = 64;  // the request or the command line, as EX_USAGE of sysexits.h

/// Runs `fleetplan COMMAND ...`, which answers one request from a file as the service would over HTTP.
/// Returns the exit code, or nothing if the arguments name no command: then they are settings of the server.
std::optional<int> run_command(std::vector<std::string> arguments, const Service& service, Streams streams);

}  // namespace fleetplan::server
