#include "api/endpoints/progress_reporter.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/runtime/memory_account.h"

namespace fleetplan::api {

ProgressReporter::ProgressReporter(PlanEvents& events, std::size_t robots, Clock::time_point deadline,
                                   MakeAnswer make_answer)
    : events_(events), robots_(robots), deadline_(deadline), make_answer_(std::move(make_answer)) {}

void ProgressReporter::progressed(const core::Progress& progress) { events_.progress({robots_, progress}); }

bool ProgressReporter::wants_plan() {
  const auto now = Clock::now();
  return !rejection_ && now >= next_ && now < deadline_ - kQuietEnd;
}

void ProgressReporter::show(const core::Plan& plan) {
  const auto begin = Clock::now();
  Reply reply = make_answer_(plan);
  if (reply.status == 200) {
    const core::MemoryScope not_counted(nullptr);  // other threads free the copy
    events_.incumbent(std::string(reply.body));
  } else {
    rejection_ = std::move(reply);
  }
  const auto end = Clock::now();
  next_ = end + std::max<Clock::duration>(kLeastPause, kLeastPauseFactor * (end - begin));
}

}  // namespace fleetplan::api
