// Parallel work with results in order: `compute(worker, i)` runs on several threads, `add(worker,
// i)` for i = 0, 1, 2, ... one after the other, so that sums do not depend on the number of
// threads. Waiting threads sleep. Those of OpenMP spin for milliseconds at every barrier; on a
// shared machine this took more time than the assembly itself.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace langer {

template <class Compute, class Add>
void in_order(int threads, int n, Compute compute, Add add) {
  if (threads <= 1 || n <= 1) {
    for (int i = 0; i < n; ++i) {
      compute(0, i);
      add(0, i);
    }
    return;
  }
  std::mutex mutex;
  std::condition_variable turned;
  int turn = 0;
  std::exception_ptr failure;
  const auto work = [&](int worker) {
    for (int i = worker; i < n; i += threads) {
      try {
        compute(worker, i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
      std::unique_lock lock(mutex);
      turned.wait(lock, [&] { return turn == i; });
      if (!failure) add(worker, i);
      ++turn;
      lock.unlock();
      turned.notify_all();
    }
  };
  std::vector<std::thread> others;
  for (int worker = 1; worker < threads; ++worker) others.emplace_back(work, worker);
  work(0);
  for (std::thread& t : others) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace langer
