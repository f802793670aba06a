#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

namespace fleetplan::server {

/// Frees memory in a thread of its own, so that answers need not wait for it. Thread-safe.
class Disposal {
 public:
  Disposal();
  ~Disposal();
  Disposal(const Disposal&) = delete;
  Disposal& operator=(const Disposal&) = delete;

  /// Frees the object soon, or at once in this thread while another one is being freed: at most one is left.
  void take(std::shared_ptr<const void> object);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const void> object_;  // to be freed next
  bool busy_ = false;                   // freeing one
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fleetplan::server
