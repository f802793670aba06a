#include "api/endpoints/plan_watch.h"

#include <algorithm>
#include <utility>

namespace fleetplan::api {

PlanWatch::PlanWatch(PlanEvents& events, std::size_t robots, Clock::time_point deadline,
                     MakeAnswer make_answer)
    : events_(events), robots_(robots), deadline_(deadline), make_answer_(std::move(make_answer)) {}

void PlanWatch::progressed(const core::Progress& progress) { events_.progress({robots_, progress}); }

bool PlanWatch::wants_plan() {
  const auto now = Clock::now();
  return !refusal_ && now >= next_ && now < deadline_ - kLastBit;
}

void PlanWatch::show(const core::Plan& plan) {
  const auto begin = Clock::now();
  Reply reply = make_answer_(plan);
  if (reply.status == 200) {
    events_.incumbent(std::move(reply.body));
  } else {
    refusal_ = std::move(reply);
  }
  const auto end = Clock::now();
  next_ = end + std::max<Clock::duration>(kPeriod, kLeastPause * (end - begin));
}

}  // namespace fleetplan::api
