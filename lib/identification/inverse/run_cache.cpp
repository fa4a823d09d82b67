#include "identification/inverse/run_cache.hpp"

#include <cstring>

namespace langer {

namespace {

// Writes and reads values as bytes. A cache is read only by the machine that wrote it.
struct Bytes {
  std::string text;
  std::size_t at = 0;

  template <class T>
  void put(const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const std::string& value) {
    put(value.size());
    text += value;
  }
  void put(const MatX& m) {
    put(m.rows());
    put(m.cols());
    text.append(reinterpret_cast<const char*>(m.data()),
                sizeof(double) * static_cast<std::size_t>(m.size()));
  }
  template <class T>
  T get() {
    T value{};
    if (at + sizeof value <= text.size()) std::memcpy(&value, text.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  std::string get_text() {
    const auto n = get<std::size_t>();
    std::string value;
    if (at <= text.size()) value = text.substr(at, n);
    at += n;
    return value;
  }
  MatX get_matrix() {
    const auto rows = get<Eigen::Index>();
    const auto columns = get<Eigen::Index>();
    MatX m(rows, columns);
    const std::size_t size = sizeof(double) * static_cast<std::size_t>(m.size());
    if (at + size <= text.size()) std::memcpy(m.data(), text.data() + at, size);
    at += size;
    return m;
  }
};

// A run and its key as one record of the journal.
std::string written(const std::string& key, const ForwardPath& path) {
  Bytes bytes;
  bytes.put(key);
  bytes.put(path.complete);
  bytes.put(path.why);
  bytes.put(MatX(Eigen::Map<const VecX>(path.t.data(), static_cast<Eigen::Index>(path.t.size()))));
  bytes.put(path.values);
  bytes.put(path.slopes.size());
  for (const MatX& slope : path.slopes) bytes.put(slope);
  return bytes.text;
}

// The inverse of written(). A record that is too short gives values of zero instead of reading
// beyond its end.
std::pair<std::string, ForwardPath> read(std::string text) {
  Bytes bytes{std::move(text)};
  std::pair<std::string, ForwardPath> found;
  found.first = bytes.get_text();
  ForwardPath& path = found.second;
  path.complete = bytes.get<bool>();
  path.why = bytes.get_text();
  const MatX t = bytes.get_matrix();
  path.t.assign(t.data(), t.data() + t.size());
  path.values = bytes.get_matrix();
  const auto slopes = bytes.get<std::size_t>();
  for (std::size_t i = 0; i < slopes; ++i) path.slopes.push_back(bytes.get_matrix());
  return found;
}

}  // namespace

// Reads the runs that an earlier process kept.
RunCache::RunCache(const std::string& journal) {
  if (journal.empty()) return;
  journal_ = std::make_unique<Journal>(journal);
  while (auto record = journal_->next()) {
    auto [key, path] = read(std::move(*record));
    paths_[key] = std::make_shared<const ForwardPath>(std::move(path));
    ++read_back_;
  }
}

std::shared_ptr<const ForwardPath> RunCache::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = paths_.find(key);
  if (found == paths_.end()) return nullptr;
  return found->second;
}

// Keeps a run in memory and appends it to the journal at once, so that a killed process loses
// nothing.
std::shared_ptr<const ForwardPath> RunCache::keep(const std::string& key, ForwardPath path) {
  const std::lock_guard lock(mutex_);
  if (journal_) journal_->append(written(key, path));
  return paths_[key] = std::make_shared<const ForwardPath>(std::move(path));
}

// A journal without runs is of no use.
RunCache::~RunCache() {
  if (journal_ && paths_.empty()) journal_->remove();
}

void RunCache::remove() {
  if (journal_) journal_->remove();
}

}  // namespace langer
