#pragma once

#include <functional>
#include <optional>

#include "api/endpoints/request_context.h"

namespace fleetplan::api {

/// A turn that a test grants or refuses.
class TestTurn final : public Turn {
 public:
  bool request(const TurnNeed& asked) override {
    need = asked;
    ++requests;
    return !refuses;
  }
  bool await() override {
    on_await();
    return comes && !need->stop.cancelled();
  }

  bool let_others() override { return on_share(); }

  bool refuses = false;
  bool comes = true;
  std::function<void()> on_await = [] {};
  std::function<bool()> on_share = [] { return true; };
  std::optional<TurnNeed> need;  // of the last request
  int requests = 0;
};

}  // namespace fleetplan::api
