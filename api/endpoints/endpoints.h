#pragma once

// All endpoints that need the planner or its data: functions from a body to a reply, without any socket.

#include <span>
#include <string>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/plan/make_plan.h"

namespace fleetplan::api {

using core::Planner;

/// POST /v1/plan: parse -> plan -> verify -> write. Never throws for what a client sent. A plan that the
/// checker rejects becomes a 500. Reports progress to the context's events.
Reply plan_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/plan with any planner; empty: core::plan.
Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context);

/// POST /v1/validate: checks plans from any source.
Reply validate_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/simulate: executes plans many times with different disturbances. Reports progress to the
/// context's events.
Reply simulate_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/margins: finds the cheapest margins with which the plan of a request holds when it is executed.
/// Reports progress to the context's events.
Reply margins_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/advance: returns the request of a later moment, when robots have executed a part of their plans.
Reply advance_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/dependencies: returns the dependencies of any plan that POST /v1/validate accepts.
Reply dependencies_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/retime: returns when robots that execute a plan with dependencies will arrive, and which robots
/// cause delays.
Reply retime_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/matrix: returns how long a robot takes between poses, alone on the map.
Reply matrix_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/assign: gives tasks to robots and returns the request with their goals.
Reply assign_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/export/vda5050: returns a plan as orders of VDA 5050. The answer depends only on the body.
Reply vda5050_endpoint(std::string_view body, const RequestContext& context);

/// POST /v1/import/vda5050: reads what vehicles report in messages of VDA 5050. Returns it as states of
/// robots, for POST /v1/advance and the next export.
Reply import_vda5050_endpoint(std::string_view body, const RequestContext& context);

/// An example request of GET /v1/examples.
struct Example {
  std::string_view name;  // file name in tests/scenarios without .json
  std::string_view body;  // the request, JSON
};

/// Returns all examples by name: the request files of tests/scenarios, embedded at build time
/// (embed_examples.cmake).
std::span<const Example> examples();

/// Returns the index.json of tests/scenarios: `[{"name", "title", "description"}]` in the order of display;
/// empty if there is none.
std::string_view examples_index();

/// GET /v1/examples: `{"examples": [{"name", "title", "description", "robots", "columns", "rows"}]}`.
Reply examples_endpoint();

/// Returns the OpenAPI 3.1 document of the whole service: api/openapi.json, embedded at build time.
std::string_view openapi_document();

/// GET /v1/openapi.json: returns the document.
inline Reply openapi_endpoint() { return {200, kJson, std::string(openapi_document())}; }

}  // namespace fleetplan::api
