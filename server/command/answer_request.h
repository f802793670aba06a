#pragma once

#include <string>

#include "server/command/streams.h"
#include "server/service.h"

namespace fleetplan::server {

/// A command that answers a request.
struct RequestCommand {
  Service::Endpoint endpoint;
  std::string request = "-";  // file names; "-": the standard input
  std::string output;         // empty: the standard output
  std::string svg;            // picture of the plan; empty: none
  std::string png;            // likewise
  bool quiet = false;         // shows no progress
};

/// Answers the request as the service would. Returns the exit code.
int answer_request(const RequestCommand& command, const Streams& streams);

}  // namespace fleetplan::server
