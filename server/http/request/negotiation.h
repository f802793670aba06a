#pragma once

// Content negotiation: Content-Type, Content-Encoding, Accept, Accept-Encoding.

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

/// Forms of the answer to POST /v1/plan.
enum class PlanForm { json, events };

/// Returns the form that an Accept field (empty: absent) prefers: application/json, also if text/event-stream
/// has the same quality; none when it allows neither. The most specific range decides about a form; q = 0
/// excludes it.
std::optional<PlanForm> plan_form(std::string_view accept);

/// Whether an Accept-Encoding field (empty: absent) allows gzip.
bool accepts_gzip(std::string_view accept_encoding);

/// Returns why a body of this Content-Type is not accepted, with the remedy; none when it is. An empty field,
/// which is absent, is not accepted: browsers send such a body, or a form, for any page without asking the
/// service.
std::optional<std::string> content_type_fault(std::string_view content_type);

enum class ContentCoding { identity, gzip, unknown };

/// Returns the coding that a Content-Encoding field (empty: absent) names.
ContentCoding content_coding(std::string_view content_encoding);

}  // namespace fleetplan::server
