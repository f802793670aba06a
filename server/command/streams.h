#pragma once

#include <iosfwd>

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

}  // namespace fleetplan::server
