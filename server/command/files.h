#pragma once

#include <cstddef>
#include <iosfwd>
#include <limits>
#include <string>

#include "api/json/result.h"
#include "server/command/streams.h"

namespace fleetplan::server {

/// Why input cannot be used, as a line for people: "map.yaml:3: resolution is missing; give ...".
struct InputFault {
  std::string line;
};

/// `line`: of the file, from 1; 0: the file as a whole.
InputFault input_fault(const std::string& file, std::size_t line, const std::string& detail);

/// All of a file, or of `in` for "-". A file of more than `most` bytes is not read to its end.
api::Result<std::string, InputFault> read_file(const std::string& name, std::istream& in,
                                               std::size_t most = std::numeric_limits<std::size_t>::max());

/// The name of an input file in messages.
std::string shown_name(const std::string& file);

/// Returns whether all of the text was written.
bool write_file(const std::string& name, const std::string& text);

/// Writes what a command is asked for to a file, or to the standard output if the name is empty. Returns the
/// exit code.
int write_output(const std::string& name, const std::string& text, const Streams& streams);

/// Reports why a command fails; returns the exit code.
int fail(const Streams& streams, int code, const std::string& message);

}  // namespace fleetplan::server
