#pragma once

// The content of requests and answers: its type, its coding, and what clients accept.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/runtime/stop_condition.h"
#include "server/http/request/body_reader.h"

namespace fleetplan::server {

/// Forms of the answer to POST /v1/plan.
enum class PlanForm { json, events };

/// Returns the form that an Accept field (empty: absent) prefers; none if it allows neither. At the same
/// quality, application/json is preferred to text/event-stream. The most specific range decides about a form;
/// q = 0 excludes it.
std::optional<PlanForm> plan_form(std::string_view accept);

/// Whether an Accept-Encoding field (empty: absent) allows gzip.
bool accepts_gzip(std::string_view accept_encoding);

/// Returns why a body of this Content-Type is not accepted, with the remedy; none if it is. An empty field,
/// which is absent, is not accepted: browsers send such a body, or a form, for any page without asking the
/// service.
std::optional<std::string> content_type_fault(std::string_view content_type);

enum class ContentCoding { identity, gzip, unknown };

/// Returns the coding that a Content-Encoding field (empty: absent) names.
ContentCoding content_coding(std::string_view content_encoding);

/// Returns the text as one gzip member; none if the stop condition is met.
std::optional<std::string> gzip(std::string_view text, const core::StopCondition& stop);

/// Decodes a body of gzip members (RFC 1952, 2.2), which together are one text. Every member must be complete
/// with its checksum and length, and nothing else may follow. `limit`: the most decoded bytes. `share` holds
/// both forms of the body. Ends with a fault when the stop condition is met.
std::variant<std::string, BodyFault> gunzip(std::string_view coded, std::uint64_t limit,
                                            BodyMemory::Share& share, const core::StopCondition& stop);

}  // namespace fleetplan::server
