#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "core/hdf5/seal.hpp"
#include "results/store/listing.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "results/store/solution_layout.hpp"
#include "results/store/step_journal.hpp"
#include "results/store/vtk_grid.hpp"
#include "results/store/xdmf.hpp"

namespace langer {

// The file being written and the last two records.
struct SolutionWriter::State {
  State(h5::File f, const SolutionHeader& h, std::string where)
      : file(std::move(f)), header(h), path(std::move(where)) {}
  h5::File file;
  SolutionHeader header;
  std::string path;
  int n_steps = 0;
  std::optional<StepRecord> before, last;
  std::unique_ptr<StepJournal> journal;

  // Begins the file with everything that all steps share.
  void begin();
  // Refuses a record that does not fit the mesh or the steps before.
  void check(const StepRecord& record) const;
  void append(const StepRecord& record);
  void contact(const StepRecord& record);
  // Writes <output>.xdmf (version 3) and <output>.xmf (version 2) for viewers. Nothing without
  // steps or with elements that XDMF does not know.
  void write_xdmf();
};

namespace {

constexpr std::size_t history_chunk = 128;  // steps; one chunk is enough for a usual run

// Appends rows to a dataset, which is made when its first row comes.
template <class T>
void extend(const h5::Group& group, const std::string& name, const h5::Shape& row,
            std::size_t chunk, const std::vector<T>& rows, const std::string& unit = "") {
  if (!group.has(name)) group.make_extendible<T>(name, row, chunk, unit);
  group.append<T>(name, rows);
}

// Appends one row to a history.
void add(const h5::Group& group, const std::string& name, double value, const std::string& unit) {
  extend<double>(group, name, {}, history_chunk, {value}, unit);
}
void add(const h5::Group& group, const std::string& name, const Vec3& value,
         const std::string& unit) {
  extend<double>(group, name, {3}, history_chunk, {value[0], value[1], value[2]}, unit);
}
void add(const h5::Group& group, const std::string& name, std::int64_t value,
         const h5::Shape& row = {}) {
  extend<std::int64_t>(group, name, row, history_chunk, {value});
}

// A record that a solver must never hand over.
[[noreturn]] void bug(const std::string& key, const std::string& found,
                      const std::string& expected) {
  throw Failure(Exit::bug, Error{{}, "StepRecord." + key, found, expected, ""});
}

// Refuses an array of another length than the mesh or the contact asks for.
void check_length(const std::string& key, std::size_t length, std::size_t expected) {
  if (length != expected) bug(key, fmt::format("{} entries", length), fmt::format("{}", expected));
}

bool finite(double value) { return std::isfinite(value); }
bool finite(const Vec3& value) { return value.allFinite(); }

template <class T>
void check_finite(const std::string& key, const std::vector<T>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!finite(values[i])) bug(key, fmt::format("entry {} is not finite", i), "finite numbers");
}

// The keys of a map, as a text to compare.
std::string names_of(const auto& map) {
  std::string names;
  for (const auto& [name, value] : map) names += name + " ";
  return names;
}

}  // namespace

SolutionWriter::SolutionWriter(const std::string& path, const SolutionHeader& header,
                               const StillGood& still_good) {
  // The journal needs the old <path>.part, so the new file is begun when its first step is
  // accepted.
  const auto begin = [&] {
    if (state_) return;
    state_ = std::make_unique<State>(h5::File::create(path, h5::Unfinished::keep), header, path);
    state_->begin();
    sync_folder_of(path);
  };
  const auto accept = [&](const StepRecord& step, const EarlierRun& run) {
    if (still_good && !still_good(step, run)) return false;
    begin();
    state_->append(step);
    return true;
  };
  auto journal = std::make_unique<StepJournal>(path, header, accept);
  begin();
  state_->journal = std::move(journal);
}

SolutionWriter::~SolutionWriter() = default;

std::optional<StepRecord> SolutionWriter::resumed() const { return state_->last; }
std::optional<StepRecord> SolutionWriter::before_resumed() const { return state_->before; }
int SolutionWriter::n_steps() const { return state_->n_steps; }
const std::vector<EarlierRun>& SolutionWriter::earlier() const {
  return state_->journal->earlier();
}

// Everything that does not depend on steps: identity, mesh, materials, fibre directions,
// contacts.
void SolutionWriter::State::begin() {
  const h5::Group root = file.root();
  write_identity(root, schema_of(solution_schema, header.mesh), header.identity);
  // Frames say where fibres lie: without fibres they are written only where a mesh turns them.
  const std::vector<Material> laws = header.laws();
  const bool fibres = std::any_of(laws.begin(), laws.end(),
                                  [](const Material& law) { return !law.fibres.empty(); });
  const h5::Group grid = write_grid(root, header.mesh, {2, 0}, fibres || has_frames(header.mesh));
  write_sets(root, header.mesh);
  write_section(root, header.mesh);
  write_hanging(root, header.mesh);
  root.attribute("formulation", header.formulation);
  write_listing(root.make_group("material"), header.material);
  if (!header.materials.empty()) {
    const h5::Group materials = root.make_group("materials");
    for (std::size_t b = 0; b < header.materials.size(); ++b)
      write_listing(materials.make_group(std::to_string(b)), header.materials[b]);
  }
  // Directions that follow from angles are not stored, only those of a field.
  int families = 0;
  if (header.directions.from_field()) families = header.directions.n_families();
  for (int k = 0; k < families; ++k) {
    // The direction is zero in elements without this family.
    std::vector<Vec3> directions;
    for (int e = 0; e < header.mesh.n_cells(); ++e) {
      const auto a = header.directions.of(e);
      Vec3& direction = directions.emplace_back(Vec3::Zero());
      if (static_cast<std::size_t>(k) < a.size()) direction = a[static_cast<std::size_t>(k)];
    }
    grid.group("CellData")
        .write<double>(fmt::format("fibre_{}", k + 1), {directions.size(), 3}, flat(directions),
                       "-");
  }
  grid.make_group("PointData");
  const h5::Group steps = grid.make_group("Steps");
  steps.make_group("PointDataOffsets");
  steps.make_group("CellDataOffsets");
  steps.attribute("NSteps", std::int64_t{0});
  root.make_group("history").make_group("reactions");
  for (const auto& [name, nodes] : header.contact_nodes)
    root.make_group("contact").make_group(name).write<std::int64_t>(
        "nodes", {nodes.size()}, std::vector<std::int64_t>(nodes.begin(), nodes.end()));
  for (const auto& [name, triangles] : header.indenter_surfaces)
    write_triangles(root.group("contact").group(name).make_group("surface"), triangles);
  file.flush();
}

// Checks a record before anything is written, so that a refused record leaves no rows behind.
void SolutionWriter::State::check(const StepRecord& record) const {
  check_length("u", record.u.size(), header.mesh.X.size());
  check_length("reaction", record.reaction.size(), header.mesh.X.size());
  check_finite("u", record.u);
  check_finite("reaction", record.reaction);
  check_finite("u_ind, force_ind, t, increment or residual",
               std::vector<Vec3>{
                   record.u_ind, record.force_ind, {record.t, record.increment, record.residual}});
  for (const auto& [name, values] : record.point_fields) {
    check_length(name, values.size(), header.mesh.X.size());
    check_finite(name, values);
  }
  for (const auto& [name, values] : record.cell_fields) {
    check_length(name, values.size(),
                 static_cast<std::size_t>(header.mesh.n_cells() * solution::components_of(name)));
    check_finite(name, values);
  }
  for (const auto& [name, value] : record.scalars) {
    check_finite(name, std::vector{value});
    if (solution::among(solution::histories, name))
      bug("scalars." + name, "a name of the file's own", "another name");
  }
  // Every step must have the same fields, because datasets have one row for each step.
  const auto all_names = [](const StepRecord& r) {
    return names_of(r.point_fields) + names_of(r.cell_fields) + names_of(r.scalars);
  };
  if (last && all_names(record) != all_names(*last))
    bug("point_fields, cell_fields and scalars", all_names(record),
        all_names(*last) + "as in the steps before");
  check_length("contacts", record.contacts.size(), header.contact_nodes.size());
  for (const auto& [name, nodes] : header.contact_nodes) {
    const auto found = record.contacts.find(name);
    if (found == record.contacts.end())
      bug("contacts", "nothing for " + name, "every contact of the header");
    check_length(name + ".r", found->second.r.size(), nodes.size());
    check_length(name + ".status", found->second.status.size(), nodes.size());
    check_length(name + ".gap", found->second.gap.size(), nodes.size());
    check_finite(name + ".r", found->second.r);
    check_finite(name + ".gap", found->second.gap);
    for (int status : found->second.status)
      if (status < 0 || status > 2)
        bug(name + ".status", std::to_string(status), "0 open, 1 stick or 2 slip");
  }
}

// Appends a step to the journal, to VTKHDF and to the histories. The number of steps is written
// last, after a flush: a reader of the growing file sees complete steps only.
void SolutionWriter::State::append(const StepRecord& record) {
  check(record);
  // After this line the step is kept, whatever happens to the HDF5 file.
  if (journal) journal->append(record);
  const h5::Group root = file.root();
  const h5::Group grid = root.group("VTKHDF");
  const h5::Group history = root.group("history");
  const std::size_t n = header.mesh.X.size();
  const std::size_t e = static_cast<std::size_t>(header.mesh.n_cells());
  const h5::Group points = grid.group("PointData");
  const h5::Group cells = grid.group("CellData");
  const h5::Group steps = grid.group("Steps");
  const h5::Group point_offsets = steps.group("PointDataOffsets");
  const h5::Group cell_offsets = steps.group("CellDataOffsets");
  // Nodal fields. VTKHDF finds the rows of a step by an offset for each array.
  extend<double>(points, "u", {3}, n, flat(record.u), "mm");
  extend<double>(points, "reaction", {3}, n, flat(record.reaction), "N");
  for (const char* name : {"u", "reaction"})
    add(point_offsets, name, static_cast<std::int64_t>(n) * n_steps);
  for (const auto& [name, values] : record.point_fields) {
    extend<double>(points, name, {3}, n, flat(values), solution::unit_of(name));
    add(point_offsets, name, static_cast<std::int64_t>(n) * n_steps);
  }
  for (const auto& [name, values] : record.cell_fields) {
    const bool is_tensor = solution::components_of(name) == 9;
    if (is_tensor && n_steps == 0) cells.attribute("Tensors", name);  // VTK's active tensor
    extend<double>(cells, name, solution::row_shape<h5::Shape>(name), e, values,
                   solution::unit_of(name));
    add(cell_offsets, name, static_cast<std::int64_t>(e) * n_steps);
  }
  // All steps have the same mesh, so its offsets are always 0.
  add(steps, "Values", record.t, "-");
  for (const char* name : {"PartOffsets", "PointOffsets"}) add(steps, name, std::int64_t{0});
  add(steps, "NumberOfParts", std::int64_t{1});
  for (const char* name : {"CellOffsets", "ConnectivityIdOffsets"})
    add(steps, name, std::int64_t{0}, {1});
  for (const std::string& name : cells.datasets())
    if (solution::is_static(name)) add(cell_offsets, name, std::int64_t{0});

  // Numbers of the step, and the resultant reaction of each node set.
  add(history, "t", record.t, "-");
  add(history, "increment", record.increment, "-");
  add(history, "iterations", std::int64_t{record.iterations});
  add(history, "residual", record.residual, "-");
  for (const auto& [name, value] : record.scalars)
    add(history, name, value, solution::unit_of(name));
  for (const auto& [name, nodes] : header.mesh.node_sets) {
    Vec3 sum = Vec3::Zero();
    for (int node : nodes) sum += record.reaction[static_cast<std::size_t>(node)];
    add(history.group("reactions"), name, sum, "N");
  }
  if (!header.contact_nodes.empty()) contact(record);

  file.flush();
  steps.attribute("NSteps", std::int64_t{++n_steps});
  file.flush();
  before = std::move(last);
  last = record;
}

// Appends the arrays of each contact and the numbers of open, sticking and slipping candidates.
void SolutionWriter::State::contact(const StepRecord& record) {
  const h5::Group root = file.root();
  const h5::Group history = root.group("history");
  add(history, "u_ind", record.u_ind, "mm");
  add(history, "force_ind", record.force_ind, "N");
  std::int64_t counts[3] = {0, 0, 0};
  for (const auto& [name, nodes] : header.contact_nodes) {
    const ContactRecord& contact = record.contacts.at(name);
    const std::size_t k = nodes.size();
    for (int status : contact.status) ++counts[status];
    const h5::Group group = root.group("contact").group(name);
    extend<double>(group, "r", {k, 3}, 1, flat(contact.r), "N");
    extend<std::int64_t>(group, "status", {k}, 1, {contact.status.begin(), contact.status.end()});
    extend<double>(group, "gap", {k}, 1, contact.gap, "mm");
    // Only indenters that adhere have bonds.
    if (contact.beta.empty()) continue;
    extend<double>(group, "beta", {k}, 1, contact.beta, "-");
    extend<double>(group, "bonded_at", {k, 3}, 1, flat(contact.bonded_at), "mm");
    extend<double>(group, "adhesive", {k, 3}, 1, flat(contact.adhesive), "N");
  }
  for (int s = 0; s < 3; ++s)
    add(history, fmt::format("contact_{}", solution::status_words[static_cast<std::size_t>(s)]),
        counts[s]);
}

void SolutionWriter::State::write_xdmf() {
  if (n_steps == 0 || !without_xdmf(header.mesh).empty()) return;
  const h5::Group grid = file.root().group("VTKHDF");
  std::vector<XdmfArray> arrays;
  for (const bool of_cells : {false, true}) {
    const h5::Group group = grid.group(of_cells ? "CellData" : "PointData");
    for (const std::string& name : group.datasets()) {
      if (name == "body") continue;  // integers, in the mesh
      const h5::Shape shape = group.shape(name);
      XdmfArray array{name, 1, of_cells, of_cells && solution::is_static(name)};
      if (shape.size() > 1) array.components = static_cast<int>(shape[1]);
      arrays.push_back(array);
    }
  }
  const auto times =
      grid.group("Steps").read<double>("Values", {static_cast<std::size_t>(n_steps)}).values;
  const std::filesystem::path solution = path;
  const std::string name = solution.filename().string();
  const auto write = [&](XdmfVersion version, const char* extension) {
    std::filesystem::path text = solution;
    write_text_file(text.replace_extension(extension).string(),
                    xdmf(version, header.mesh, name, times, arrays));
  };
  write(XdmfVersion::three, ".xdmf");
  write(XdmfVersion::two, ".xmf");
}

void SolutionWriter::append(const StepRecord& record) { state_->append(record); }

void SolutionWriter::write_image_of(const std::string& which) {
  state_->file.root().group("provenance").write_text("image_of", which);
}

void SolutionWriter::write_vibration(const VibrationRecord& record) {
  langer::write_vibration(state_->file.root(), record);
}

namespace {

// Writes the runs that computed the steps, unless all had the config that is in the file.
void write_earlier(const h5::Group& provenance, const std::vector<EarlierRun>& runs,
                   const std::string& config) {
  const auto has_config = [&](const EarlierRun& run) {
    return run.config == config;
  };
  if (std::ranges::all_of(runs, has_config)) return;
  const h5::Group earlier = provenance.make_group("earlier");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const h5::Group one = earlier.make_group(std::to_string(i));
    one.attribute("steps", std::int64_t{runs[i].steps});
    one.write_text("config", runs[i].config);
    one.write_text("command", runs[i].command);
    one.write_text("code_version", runs[i].code_version);
    one.write_text("created_utc", runs[i].created_utc);
  }
}
}  // namespace

// Adds histories and numbers that the whole path decides, writes the XDMF text and gives the file
// its final name. The journal is removed last.
void SolutionWriter::finish(const std::optional<Cost>& cost, const std::vector<Summary>& summary,
                            const Histories& found_later) {
  const h5::Group history = state_->file.root().group("history");
  for (const auto& [name, values] : found_later) {
    check_length(name, values.size(), static_cast<std::size_t>(n_steps()));
    check_finite(name, values);
    extend<double>(history, name, {}, history_chunk, values, solution::unit_of(name));
  }
  write_cost(state_->file.root(), cost.value_or(cost_so_far()), !cost);
  if (!summary.empty()) write_summary(state_->file.root(), summary);
  write_earlier(state_->file.root().group("provenance"), earlier(), state_->header.identity.config);
  state_->write_xdmf();
  state_->file.commit();  // last: a file with its final name is complete
  state_->journal->remove();
}

}  // namespace langer
