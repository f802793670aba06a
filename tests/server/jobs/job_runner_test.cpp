
#include "server/jobs/job_runner.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <thread>

namespace fleetplan::server {
namespace TEST_FILE {

/// Reports the thread that destroys it, which then waits until it may go on.
struct Leftover {
  std::promise<std::thread::id>& destroyed_by;
  std::shared_future<void> may_go_on;

  Leftover(std::promise<std::thread::id>& by, std::shared_future<void> go_on)
      : destroyed_by(by), may_go_on(std::move(go_on)) {}
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;
  ~Leftover() {
    destroyed_by.set_value(std::this_thread::get_id());
    may_go_on.wait();
  }
};

TEST(Disposal, FreesInAThreadOfItsOwnUnlessThatIsBusy) {
  std::promise<std::thread::id> first;
  std::promise<std::thread::id> second;
  std::promise<void> gate;
  std::promise<void> open_gate;
  open_gate.set_value();
  Disposal disposal;
  disposal.take(std::make_shared<Leftover>(first, gate.get_future().share()));
  EXPECT_NE(first.get_future().get(), std::this_thread::get_id());
  disposal.take(std::make_shared<Leftover>(second, open_gate.get_future().share()));
  EXPECT_EQ(second.get_future().get(), std::this_thread::get_id());
  gate.set_value();
}

TEST(Disposal, FreesWhatIsLeftAtItsEnd) {
  std::weak_ptr<const int> left;
  {
    Disposal disposal;
    auto object = std::make_shared<const int>(7);
    left = object;
    disposal.take(std::move(object));
  }
  EXPECT_TRUE(left.expired());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
