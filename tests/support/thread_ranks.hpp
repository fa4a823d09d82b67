// Ranks that are threads of this process: what bodies and matrices divided among ranks do without
// MPI.
#pragma once

#include <barrier>
#include <cstring>
#include <functional>
#include <thread>

#include "mechanics/assembly/division.hpp"

namespace langer::test {

struct Meeting {
  explicit Meeting(int n) : n(n), all(n), from(static_cast<std::size_t>(n)) {}
  int n;
  std::barrier<> all;
  std::vector<void*> from;
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  int rank() const override { return rank_; }
  int n() const override { return meeting_.n; }
  void sum(double* x, std::size_t n) const override {
    std::vector<double> total(n, 0);
    meet(x, [&](const void* of) {
      for (std::size_t i = 0; i < n; ++i) total[i] += static_cast<const double*>(of)[i];
    });
    std::copy(total.begin(), total.end(), x);
  }
  double smallest(double x) const override {
    return extreme(x, [](double a, double b) { return std::min(a, b); });
  }
  double largest(double x) const override {
    return extreme(x, [](double a, double b) { return std::max(a, b); });
  }
  void broadcast_from_root(void* x, std::size_t bytes) const override {
    std::vector<char> found(bytes);
    bool first = true;
    meet(x, [&](const void* of) {
      if (first) std::memcpy(found.data(), of, bytes);
      first = false;
    });
    std::memcpy(x, found.data(), bytes);
  }
  std::vector<int> divide(const std::vector<int>&, int, int) const override { return {}; }
  int end(int code, bool, void (*)(const char*), const std::string&) override { return code; }

 private:
  template <class Look>
  void meet(void* own, Look look) const {
    meeting_.from[static_cast<std::size_t>(rank_)] = own;
    meeting_.all.arrive_and_wait();
    for (const void* of : meeting_.from) look(of);
    meeting_.all.arrive_and_wait();
  }
  template <class Op>
  double extreme(double x, Op op) const {
    double out = x;
    meet(&x, [&](const void* of) { out = op(out, *static_cast<const double*>(of)); });
    return out;
  }
  Meeting& meeting_;
  int rank_;
};

// each rank's work, side by side
inline void on_ranks(int n, const std::function<void(const Ranks&)>& work) {
  Meeting meeting(n);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < n; ++rank)
    threads.emplace_back([&meeting, &work, rank] { work(ThreadRanks(meeting, rank)); });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace langer::test
