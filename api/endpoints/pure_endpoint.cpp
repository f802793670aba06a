#include "api/endpoints/pure_endpoint.h"

#include <chrono>
#include <utility>

#include "api/endpoints/bounded_work.h"
#include "api/request/parse_body.h"
#include "api/response/error.h"

namespace fleetplan::api {

Reply pure_endpoint(std::string_view body, const RequestContext& context,
                    std::span<const std::string_view> members, const MakeAnswer& make) {
  return bounded_work(context, [&](core::Work& work) -> Reply {
    bool is_refused = false;
    const auto await_turn = [&] {
      const auto size = static_cast<double>(body.size());
      const std::chrono::milliseconds usual(context.limits.default_budget_ms);
      const core::StopCondition stop =
          work.has_budget() ? work.before_end() : work.until(context.received_at + usual);
      const TurnNeed need{TurnNeed::Kind::conversion, stop, stop.deadline(), size, true};
      is_refused = !take_turn(context.turn, need, work);
      return !is_refused;
    };
    auto text = parse_body<std::string>(
        body, context.limits, work, members,
        [&](const JsonReader& root, core::Work& /*work*/) { return make(root, work, await_turn); });
    if (is_refused && !work.cancelled()) return too_busy(context.request_id);
    if (!text) return problem_reply(text.failure(), context.request_id);
    return {200, kJson, std::move(*text)};
  });
}

}  // namespace fleetplan::api
