#include "results/store/step_journal.hpp"

#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/say.hpp"
#include "core/base/text.hpp"
#include "core/hdf5/checksum.hpp"

namespace langer {

namespace {

// Writes values one after another as they are in memory. Lists and texts begin with their length.
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

// Reads what Packer wrote. If the bytes do not fit, `good` becomes false and the remaining values
// are empty.
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
  // The length of a list whose entries have at least `size` bytes. A length beyond the bytes that
  // are left is damage, not a reason to allocate memory.
  std::size_t length(std::size_t size) {
    std::size_t n = 0;
    get(n);
    if (n > rest_.size() / size) good = false;
    if (good) return n;
    return 0;
  }
  void copy(void* to, std::size_t n) {
    if (n > rest_.size()) good = false;
    if (!good || n == 0) return;
    std::memcpy(to, rest_.data(), n);
    rest_.remove_prefix(n);
  }
  std::string_view rest_;
};

// The first byte of a record.
enum Kind : char { task_record = 'T', run_record = 'R', step_record = 'S' };

// Calls a function with each member of a step record, in the order of the file.
void for_each_field(auto& r, auto&& field) {
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

// A step as the bytes of a record.
std::string packed(const StepRecord& record) {
  Packer p;
  p.put(static_cast<char>(step_record));
  const auto put = [&](const auto& value) {
    p.put(value);
  };
  for_each_field(record, put);
  return std::move(p.bytes);
}

// A step from the bytes of a record; nothing if they do not fit.
std::optional<StepRecord> unpacked_step(std::string_view bytes) {
  StepRecord record;
  Unpacker u(bytes);
  const auto get = [&](auto& value) {
    u.get(value);
  };
  for_each_field(record, get);
  if (u.done()) return std::optional(record);
  return std::nullopt;
}

// The run that computes the following steps: config, command, version and time.
std::string packed_run(const Identity& identity) {
  Packer p;
  p.put(static_cast<char>(run_record));
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

// What kept steps depend on. The message of a journal that is begun anew names the first
// difference.
struct Task {
  std::string code, config, arrays;
};

// The directions that a field gave, by element. Empty without a field: angles and frames are in
// the task anyway.
std::vector<std::vector<Vec3>> directions_of_field(const SolutionHeader& header) {
  std::vector<std::vector<Vec3>> fibres;
  for (int e = 0; header.directions.from_field() && e < header.mesh.n_cells(); ++e)
    fibres.emplace_back(header.directions.of(e).begin(), header.directions.of(e).end());
  return fibres;
}

// The task of a solution. The arrays of the mesh belong to it, because content ids depend on
// configs, not on code: another version of the mesher may make another mesh from the same config.
Task task_of(const SolutionHeader& header) {
  Packer arrays;
  const Mesh& mesh = header.mesh;
  arrays.put(static_cast<int>(mesh.type));
  arrays.put(mesh.X);
  arrays.put(mesh.connectivity);
  arrays.put(mesh.body);
  arrays.put(mesh.frames);
  arrays.put(mesh.node_sets);
  arrays.put(mesh.facet_sets);
  arrays.put(directions_of_field(header));
  arrays.put(header.contact_nodes);
  if (mesh.section) {
    arrays.put(static_cast<int>(mesh.section->of));
    arrays.put(mesh.section->depth);
  }
  const Identity& identity = header.identity;
  const std::string steps = text_or(identity.steps_hash, identity.config_hash);
  std::string config = identity.stage + "\n" + steps + "\n" + header.formulation;
  for (const auto& [port, id] : identity.inputs) config += "\n" + port + "=" + id;
  return {code_version(), config, fmt::format("{:016x}", checksum(arrays.bytes))};
}

std::string packed(const Task& t) {
  Packer p;
  p.put(static_cast<char>(task_record));
  p.put(t.code);
  p.put(t.config);
  p.put(t.arrays);
  return std::move(p.bytes);
}

// The reason why the steps after this record do not belong to the task; empty if they do.
std::string difference(std::string_view record, const Task& task) {
  Task kept;
  Unpacker u(record.substr(1));
  u.get(kept.code);
  u.get(kept.config);
  u.get(kept.arrays);
  if (!u.done() || kept.code != task.code) return "left by another version of langer";
  if (kept.config != task.config) return "left by a run with another config or other inputs";
  if (kept.arrays != task.arrays) return "left by a run with another mesh";
  return "";
}

void report_new_start(const std::string& file, const std::string& reason) {
  say_line("{}: {}; starting anew", file, reason);
}

}  // namespace

// The steps are replayed if the first record has the present task. Otherwise the journal is begun
// anew.
StepJournal::StepJournal(const std::string& output, const SolutionHeader& header,
                         const Accept& accept)
    : journal_(output + ".steps"), this_run_(packed_run(header.identity)) {
  const std::string part = output + ".part";
  const bool has_part = std::filesystem::exists(part);
  const Task task = task_of(header);
  const std::optional<std::string> first = journal_.next();
  bool continues = false;
  if (first) {
    // A user who removes <output>.part wants to begin anew.
    std::string reason = "is without its " + part;
    if (has_part) reason = difference(*first, task);
    continues = reason.empty();
    if (!continues) report_new_start(journal_.path(), reason);
  } else if (!journal_.at_end()) {
    report_new_start(journal_.path(), "is damaged");
  } else if (has_part) {
    report_new_start(part, "left by a version of langer that kept no checksums");
  }
  if (continues) {
    replay(accept);
  } else {
    journal_.clear();
    journal_.append(packed(task));
  }
  journal_.append(this_run_);
}

// Reads runs and steps up to the end, to the first damaged record or to the first step that is not
// accepted. Runs without steps are not listed.
void StepJournal::replay(const Accept& accept) {
  int steps = 0;
  bool discarded = false;
  while (!discarded) {
    const std::optional<std::string> record = journal_.next();
    if (!record) break;
    // The first byte is the kind of the record.
    const std::string_view content = std::string_view(*record).substr(1);
    if (record->front() == run_record) {
      earlier_.push_back(unpacked_run(content));
      continue;
    }
    const std::optional<StepRecord> step = unpacked_step(content);
    discarded = !step || earlier_.empty() || !accept(*step, earlier_.back());
    if (discarded) {
      journal_.put_back();
    } else {
      ++earlier_.back().steps;
      ++steps;
    }
  }
  if (!discarded && !journal_.at_end())
    say_line("{}: damaged, or a step was cut off; continuing after the {} steps before",
             journal_.path(), steps);
  const auto has_no_steps = [](const EarlierRun& run) {
    return run.steps == 0;
  };
  std::erase_if(earlier_, has_no_steps);
}

StepFollower::StepFollower(const std::string& output) : path_(output + ".steps") {}

// What the old file still has is read first: a solve removes its journal when it has finished.
std::vector<StepRecord> StepFollower::more(bool& anew) {
  std::vector<StepRecord> steps;
  anew = false;
  const auto read_records = [&] {
    while (const std::optional<std::string> record = journal_->next()) {
      if (record->empty() || record->front() != step_record) continue;
      if (const auto step = unpacked_step(std::string_view(*record).substr(1)))
        steps.push_back(*step);
    }
  };
  if (journal_) read_records();
  std::error_code none;
  const bool current = journal_ && !journal_->replaced();
  if (current || !std::filesystem::exists(path_, none)) return steps;
  anew = true;
  steps.clear();
  journal_ = std::make_unique<Journal>(path_, Journal::ReadOnly{});
  read_records();
  return steps;
}

void StepJournal::append(const StepRecord& record) { journal_.append(packed(record)); }

void discard_steps(const std::string& output) {
  // A file that cannot be removed is reported by the journal that finds it.
  std::error_code ignored;
  for (const char* ending : {".part", ".steps"}) std::filesystem::remove(output + ending, ignored);
}

}  // namespace langer
