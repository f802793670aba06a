#pragma once

#include <string>
#include <string_view>

namespace fleetplan::server {

/// True for 1..128 characters of [A-Za-z0-9._-]: safe in a header, a log line and a file name.
bool is_well_formed_request_id(std::string_view id);

/// 128 random bits as 32 hexadecimal digits.
std::string make_request_id();

}  // namespace fleetplan::server
