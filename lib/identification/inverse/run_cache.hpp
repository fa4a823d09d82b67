// Forward runs that were made, by what they were made of: in memory, and in a journal beside the
// output, from which a fit that was stopped goes on. What a run is made of is its config with all
// numbers, its observations and where its increments end.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "identification/inverse/forward_run.hpp"
#include "results/store/journal.hpp"

namespace langer {

class RunCache {
 public:
  explicit RunCache(
      const std::string& journal = "");  // empty: in memory only; throws Failure(input)
  ~RunCache();                           // leaves no file without a run
  // Both from several threads at once.
  std::shared_ptr<const ForwardPath> find(const std::string& key) const;
  std::shared_ptr<const ForwardPath> keep(const std::string& key, ForwardPath path);
  std::size_t read_back() const { return read_back_; }  // of an earlier fit
  void remove();                                        // the work is done

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ForwardPath>> paths_;
  std::unique_ptr<Journal> journal_;
  std::size_t read_back_ = 0;
};

}  // namespace langer
