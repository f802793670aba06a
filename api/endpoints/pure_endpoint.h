#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/json/json_reader.h"
#include "api/response/reply.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The JSON answer to a body, of which it gets the root and the stop. Nothing only when it reported faults or
/// when the stop was met.
using MakeAnswer = std::function<std::optional<std::string>(const JsonReader&, core::Work&)>;

/// The reply of an endpoint whose answer depends on nothing but the body, and is made while that is read.
/// `members`: of the body's root.
Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make);

}  // namespace fleetplan::api
