#pragma once

#include <vector>

#include "core/model/progress.h"

namespace fleetplan::support {

/// Records the progress that a planner reports and, unless `wants_plans` is false, every plan that it shows.
class Recorder : public core::Observer {
 public:
  explicit Recorder(bool wants_plans = true) : wants_plans_(wants_plans) {}

  void progressed(const core::Progress& progress) override { reported.push_back(progress); }
  bool wants_plan() override { return wants_plans_; }
  void show(const core::Plan& plan) override { shown.push_back(plan); }

  std::vector<core::Progress> reported;
  std::vector<core::Plan> shown;

 private:
  bool wants_plans_;
};

}  // namespace fleetplan::support
