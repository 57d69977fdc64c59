// SPDX-License-Identifier: MIT
#include "detail/thread_pool.hpp"

#include <exception>
#include <utility>

namespace pectinate::detail {

ThreadPool::ThreadPool(int thread_count) : failures_(thread_count) {
  for (int thread = 1; thread < thread_count; ++thread) {
    threads_.emplace_back([this, thread](std::stop_token stop) { serve(stop, thread); });
  }
}

void ThreadPool::run(std::int64_t count, const Work& work) {
  {
    const std::lock_guard lock(mutex_);
    count_ = count;
    work_ = &work;
    busy_ = static_cast<int>(threads_.size());
    ++round_;
  }
  start_.notify_all();
  do_share(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return busy_ == 0; });
  std::exception_ptr first;
  for (auto& failure : failures_) {
    const auto exception = std::exchange(failure, nullptr);  // the next run starts without any
    if (!first) first = exception;
  }
  if (first) std::rethrow_exception(first);
}

void ThreadPool::serve(std::stop_token stop, int thread) {
  std::uint64_t seen = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!start_.wait(lock, stop, [&] { return round_ != seen; })) return;
      seen = round_;
    }
    do_share(thread);
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) done_.notify_one();
  }
}

void ThreadPool::do_share(int thread) {
  try {
    for (std::int64_t index = thread; index < count_; index += thread_count()) (*work_)(index, thread);
  } catch (...) {
    failures_[thread] = std::current_exception();
  }
}

}  // namespace pectinate::detail
