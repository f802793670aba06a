#pragma once

#include <vector>

#include "core/runtime/progress.h"

namespace fleetplan::support {

/// Remembers everything that a planner tells, and wants to see every plan unless told otherwise.
class Recorder : public core::Observer {
 public:
  explicit Recorder(bool wants_plans = true) : wants_plans_(wants_plans) {}

  void progressed(const core::Progress& progress) override { told.push_back(progress); }
  bool wants_plan() override { return wants_plans_; }
  void show(const core::Plan& plan) override { shown.push_back(plan); }

  std::vector<core::Progress> told;
  std::vector<core::Plan> shown;

 private:
  bool wants_plans_;
};

}  // namespace fleetplan::support
