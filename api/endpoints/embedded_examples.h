#pragma once

#include <span>
#include <string_view>

#include "api/endpoints/examples.h"

namespace fleetplan::api {

/// The request files of tests/scenarios, by name; embedded at build time (embed_examples.cmake).
std::span<const Example> embedded_examples();

/// Their index.json: `[{"name", "title", "description"}]` in the order of display; empty if there is none.
std::string_view embedded_index();

}  // namespace fleetplan::api
