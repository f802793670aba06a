#pragma once

// What the client sends and takes: Content-Type, Content-Encoding, Accept, Accept-Encoding.

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// True when an Accept field (empty: absent) allows application/json. The most specific range decides, q = 0
/// excludes.
bool accepts_json(std::string_view accept);

/// True when an Accept-Encoding field (empty: absent) allows gzip.
bool accepts_gzip(std::string_view accept_encoding);

/// None when a body of this Content-Type (empty: absent) is taken; otherwise a detail that names the remedy.
std::optional<std::string> content_type_fault(std::string_view content_type);

enum class ContentCoding { identity, gzip, unknown };

/// Of a Content-Encoding field (empty: absent).
ContentCoding content_coding(std::string_view content_encoding);

}  // namespace fleetplan::server
