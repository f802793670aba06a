#include "server/jobs/disposal.h"

#include <utility>

namespace fleetplan::server {

Disposal::Disposal() : thread_([this] { work(); }) {}

Disposal::~Disposal() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Disposal::take(std::shared_ptr<const void> object) {
  {
    const std::lock_guard lock(mutex_);
    if (!object_ && !busy_) object_.swap(object);
  }
  changed_.notify_one();
}

void Disposal::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || object_; });
    if (!object_) return;
    auto object = std::exchange(object_, nullptr);
    busy_ = true;
    lock.unlock();
    object.reset();
    lock.lock();
    busy_ = false;
  }
}

}  // namespace fleetplan::server
