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

/// Waits for the turn of a request whose body has been read and has no fault so far. False: the answer is not
/// to be made.
using AwaitTurn = std::function<bool()>;

/// The JSON answer to a body, of which it gets the root. Nothing only when it reported faults, when its work
/// was stopped, or when it got no turn.
using MakeAnswer =
    std::function<std::optional<std::string>(const JsonReader&, core::Work&, const AwaitTurn&)>;

/// The reply of an endpoint whose answer depends on nothing but the body, and refers to what was read of it.
/// `members`: of the body's root.
Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make);

}  // namespace fleetplan::api
