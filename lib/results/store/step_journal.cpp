#include "results/store/step_journal.hpp"

#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/say.hpp"
#include "core/hdf5/checksum.hpp"

namespace langer {

namespace {

// values one after another, as they lie in memory; lists and words with their length before them
class Packer {
 public:
  std::string bytes;
  void put(const auto& value) requires std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>> {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const std::string& text) {
    put(text.size());
    bytes += text;
  }
  void put(const Vec3& v) { put_all(v.data(), 3); }
  void put(const Mat3& m) { put_all(m.data(), 9); }
  void put(const Facet& f) {
    put(f.cell);
    put(f.local);
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(list.size());
    if constexpr (std::is_arithmetic_v<T>)
      bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
    else
      for (const T& one : list) put(one);
  }
  template <class T>
  void put(const std::map<std::string, T>& map) {
    put(map.size());
    for (const auto& [name, value] : map) {
      put(name);
      put(value);
    }
  }
  void put(const ContactRecord& c) {
    put(c.r);
    put(c.status);
    put(c.gap);
    put(c.beta);
    put(c.bonded_at);
    put(c.adhesive);
  }

 private:
  void put_all(const double* values, std::size_t n) {
    bytes.append(reinterpret_cast<const char*>(values), n * sizeof(double));
  }
};

// The other way; what does not fit makes `good` false and the rest empty.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}
  bool good = true;
  bool done() const { return good && rest_.empty(); }
  void get(auto& value) requires std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>> {
    copy(&value, sizeof value);
  }
  void get(std::string& text) {
    text.resize(length(1));
    copy(text.data(), text.size());
  }
  void get(Vec3& v) { copy(v.data(), 3 * sizeof(double)); }
  template <class T>
  void get(std::vector<T>& list) {
    list.resize(length(sizeof(T)));
    if constexpr (std::is_arithmetic_v<T>)
      copy(list.data(), list.size() * sizeof(T));
    else
      for (T& one : list) get(one);
  }
  template <class T>
  void get(std::map<std::string, T>& map) {
    for (std::size_t n = length(1); n > 0 && good; --n) {
      std::string name;
      get(name);
      get(map[name]);
    }
  }
  void get(ContactRecord& c) {
    get(c.r);
    get(c.status);
    get(c.gap);
    get(c.beta);
    get(c.bonded_at);
    get(c.adhesive);
  }

 private:
  std::size_t length(std::size_t of_one) {
    std::size_t n = 0;
    get(n);
    if (n > rest_.size() / of_one) good = false;
    return good ? n : 0;
  }
  void copy(void* to, std::size_t n) {
    if (n > rest_.size()) good = false;
    if (!good || n == 0) return;
    std::memcpy(to, rest_.data(), n);
    rest_.remove_prefix(n);
  }
  std::string_view rest_;
};

enum Kind : char { of_task = 'T', of_run = 'R', of_step = 'S' };

void each_field(auto& r, auto&& field) {
  field(r.t);
  field(r.increment);
  field(r.iterations);
  field(r.residual);
  field(r.u);
  field(r.reaction);
  field(r.point_fields);
  field(r.cell_fields);
  field(r.scalars);
  field(r.u_ind);
  field(r.force_ind);
  field(r.contacts);
}

std::string packed(const StepRecord& record) {
  Packer p;
  p.put(static_cast<char>(of_step));
  each_field(record, [&](const auto& value) { p.put(value); });
  return std::move(p.bytes);
}

std::optional<StepRecord> unpacked_step(std::string_view bytes) {
  StepRecord record;
  Unpacker u(bytes);
  each_field(record, [&](auto& value) { u.get(value); });
  if (u.done()) return std::optional(record);
  return std::nullopt;
}

std::string packed_run(const Identity& identity) {
  Packer p;
  p.put(static_cast<char>(of_run));
  for (const std::string& text : {identity.config, identity.command, code_version(), utc_now()})
    p.put(text);
  return std::move(p.bytes);
}

EarlierRun unpacked_run(std::string_view bytes) {
  EarlierRun r;
  Unpacker u(bytes);
  for (std::string* text : {&r.config, &r.command, &r.code_version, &r.created_utc}) u.get(*text);
  return r;
}

// what kept steps depend on, each with the word for what has changed where it is another
struct Task {
  std::string code, config, arrays;
};

// directions that a field gave, by cell; empty where angles and frames, which stand beside them,
// tell them
std::vector<std::vector<Vec3>> field_of(const SolutionHeader& header) {
  std::vector<std::vector<Vec3>> fibres;
  for (int e = 0; header.directions.from_field() && e < header.mesh.n_cells(); ++e)
    fibres.emplace_back(header.directions.of(e).begin(), header.directions.of(e).end());
  return fibres;
}

// ids know configs, not code: another version of the mesher may have made another mesh of the same
// config
Task task_of(const SolutionHeader& header) {
  Packer arrays;
  const Mesh& mesh = header.mesh;
  arrays.put(static_cast<int>(mesh.type)), arrays.put(mesh.X), arrays.put(mesh.connectivity),
      arrays.put(mesh.body), arrays.put(mesh.frames);
  arrays.put(mesh.node_sets);
  arrays.put(mesh.facet_sets);
  arrays.put(field_of(header));
  arrays.put(header.contact_nodes);
  if (mesh.section) arrays.put(static_cast<int>(mesh.section->of)), arrays.put(mesh.section->depth);
  const Identity& identity = header.identity;
  const std::string& steps =
      identity.steps_hash.empty() ? identity.config_hash : identity.steps_hash;
  std::string config = identity.stage + "\n" + steps + "\n" + header.formulation;
  for (const auto& [port, id] : identity.inputs) config += "\n" + port + "=" + id;
  return {code_version(), config, fmt::format("{:016x}", checksum(arrays.bytes))};
}

std::string packed(const Task& t) {
  Packer p;
  p.put(static_cast<char>(of_task)), p.put(t.code), p.put(t.config), p.put(t.arrays);
  return std::move(p.bytes);
}

// why the steps behind this record are not of this task; empty where they are
std::string difference(std::string_view record, const Task& is) {
  Task was;
  Unpacker u(record.substr(1));
  u.get(was.code);
  u.get(was.config);
  u.get(was.arrays);
  if (!u.done() || was.code != is.code) return "left by another version of langer";
  if (was.config != is.config) return "left by a run with another config or other inputs";
  if (was.arrays != is.arrays) return "left by a run with another mesh";
  return "";
}

}  // namespace

StepJournal::StepJournal(const std::string& output, const SolutionHeader& header, const Take& take)
    : journal_(output + ".steps"), this_run_(packed_run(header.identity)) {
  const std::string part = output + ".part";
  const bool has_part = std::filesystem::exists(part);
  const Task task = task_of(header);
  const std::optional<std::string> first = journal_.next();
  std::string why;  // nothing is kept
  if (!first) {
    if (!journal_.at_end()) {
      why = "is damaged";
    } else if (has_part) {
      why = "left by a version of langer that kept no checksums";
    } else {
      why = "";
    }
  } else if (!has_part)  // whoever removes it wants to begin anew
    why = "is without its " + part;
  else
    why = difference(*first, task);
  if (!first || !why.empty()) {
    if (!why.empty())
      say_line("{}: {}; starting anew", first || !journal_.at_end() ? journal_.path() : part, why);
    journal_.clear();
    journal_.append(packed(task));
  } else
    replay(take);
  journal_.append(this_run_);
}

void StepJournal::replay(const Take& take) {
  int steps = 0;
  bool dropped = false;
  while (const std::optional<std::string> record = dropped ? std::nullopt : journal_.next()) {
    const std::string_view content = std::string_view(*record).substr(1);
    if (record->front() == of_run) {
      earlier_.push_back(unpacked_run(content));
      continue;
    }
    const std::optional<StepRecord> step = unpacked_step(content);
    dropped = !step || earlier_.empty() || !take(*step, earlier_.back());
    if (dropped)
      journal_.put_back();
    else {
      ++earlier_.back().steps;
      ++steps;
    }
  }
  if (!dropped && !journal_.at_end())
    say_line("{}: damaged, or a step was cut off; continuing after the {} steps before",
             journal_.path(), steps);
  std::erase_if(earlier_, [](const EarlierRun& r) { return r.steps == 0; });
}

void StepJournal::append(const StepRecord& record) { journal_.append(packed(record)); }

void forget_steps(const std::string& output) {
  std::error_code what_stays_is_said;  // by the journal that finds it
  for (const char* ending : {".part", ".steps"})
    std::filesystem::remove(output + ending, what_stays_is_said);
}

}  // namespace langer
