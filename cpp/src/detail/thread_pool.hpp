// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pectinate::detail {

/// A few threads that wait, asleep, for loops to share.
class ThreadPool {
 public:
  /// The calling thread is one of `thread_count` >= 1.
  explicit ThreadPool(int thread_count);

  int thread_count() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls work(index, thread) for every index in [0, count), each thread a fixed share of them; returns when all are
  /// done and rethrows the first exception of the lowest thread.
  using Work = std::function<void(std::int64_t index, int thread)>;
  void run(std::int64_t count, const Work& work);

 private:
  void serve(std::stop_token stop, int thread);
  void do_share(int thread);

  std::mutex mutex_;
  std::condition_variable_any start_, done_;
  std::uint64_t round_ = 0;
  int busy_ = 0;
  std::int64_t count_ = 0;
  const Work* work_ = nullptr;
  std::vector<std::exception_ptr> failures_;
  std::vector<std::jthread> threads_;  // last: they stop before anything that they use is gone
};

}  // namespace pectinate::detail
