#pragma once

// Answers of the endpoints, and what they say of plans.

#include <gtest/gtest.h>

#include <string_view>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"
#include "tests/support/step_limit.h"

namespace fleetplan::api {

/// The context of a request that the limit ends.
inline RequestContext ended_by(support::StepLimit& limit) {
  RequestContext context;
  context.early_end = &limit;
  return context;
}

/// The answer to a request that the endpoint is expected to serve.
inline Json answer_of(Reply (*endpoint)(std::string_view, const RequestContext&), const Json& request) {
  const Reply reply = endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body << "\n" << request;
  return json_of(reply);
}

inline Json plan_of(const Json& request) { return answer_of(plan_endpoint, request); }

/// The verdict on plans: an answer to the request, which is merged into it.
inline Json verdict_of(Json request, const Json& answer) {
  request.update(answer);
  return answer_of(validate_endpoint, request);
}

/// The request of a later moment.
inline Json advanced(const Json& request, const Json& answer, double at, const Json& more = Json::object()) {
  Json body{{"request", request}, {"plans", answer["plans"]}, {"at", at}};
  body.update(more);
  return answer_of(advance_endpoint, body);
}

}  // namespace fleetplan::api
