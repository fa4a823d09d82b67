#include <fmt/format.h>

#include "core/hdf5/unit_attribute.hpp"
#include "results/store/listing.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "results/store/solution_layout.hpp"
#include "results/store/vtk_grid.hpp"

namespace langer {

// The open file and the parts that all steps share.
struct SolutionReader::State {
  h5::File file;
  SolutionHeader header;
  std::string id;
  std::size_t n_steps = 0;
};

namespace {

// Row i of a dataset of numbers.
double number_at(const h5::Group& group, const std::string& name, std::size_t i) {
  const double value = group.read_rows<double>(name, i, 1, {}).values[0];
  if (!std::isfinite(value))
    group.refuse(name, fmt::format("{} at step {}", value, i), "a finite number");
  return value;
}

// Rows of a dataset, all of whose numbers must be finite.
std::vector<double> finite_rows(const h5::Group& group, const std::string& name, std::size_t first,
                                std::size_t count, const h5::Shape& row) {
  auto values = group.read_rows<double>(name, first, count, row).values;
  for (double value : values)
    if (!std::isfinite(value))
      group.refuse(name, fmt::format("{} in row {} or after", value, first), "finite numbers");
  return values;
}

// The directions of the fibres. The file has them if a field of the config gave them; otherwise
// they follow from the angles of the materials and the frames of the elements.
Directions read_directions(const h5::Group& cells, const SolutionHeader& header) {
  const std::size_t n = static_cast<std::size_t>(header.mesh.n_cells());
  const std::vector<std::vector<double>> angles = fibre_angles(header.laws());
  if (!cells.has("fibre_1")) return make_directions(header.mesh, angles);
  std::vector<std::vector<Vec3>> fibres(n);
  for (int k = 1; cells.has(fmt::format("fibre_{}", k)); ++k) {
    const std::string name = fmt::format("fibre_{}", k);
    const std::vector<Vec3> a = vectors(cells.read_finite(name, {n, 3}));
    for (std::size_t e = 0; e < n; ++e) {
      if (a[e].isZero(0)) continue;
      if (!(std::abs(a[e].norm() - 1) < 1e-9))
        cells.refuse(name, fmt::format("length {} in cell {}", a[e].norm(), e), "unit vectors");
      fibres[e].push_back(a[e]);
    }
  }
  Directions directions(true);
  for (std::size_t e = 0; e < n; ++e) {
    std::size_t body = 0;
    if (angles.size() > 1) body = static_cast<std::size_t>(header.mesh.body[e]);
    const std::size_t families = angles[body].size();
    if (fibres[e].size() != families)
      cells.refuse("fibre_1", fmt::format("{} directions in cell {}", fibres[e].size(), e),
                   fmt::format("{}, one for each fibre family of its material", families));
    directions.append(std::move(fibres[e]));
  }
  return directions;
}

std::string unit_of_history_or_field(const std::string& name) { return solution::unit_of(name); }

std::string unit_of_nodal_field(const std::string& name) {
  if (name == "u") return "mm";
  if (name == "reaction") return "N";
  return solution::unit_of(name);
}

std::string unit_of_contact_array(const std::string& name) {
  if (name == "r" || name == "adhesive") return "N";
  if (name == "gap" || name == "bonded_at") return "mm";
  return "-";
}

// Refuses datasets of a group whose unit is not the expected one.
void check_units(const h5::Group& group, std::string (*unit)(const std::string& name)) {
  for (const std::string& name : group.datasets()) require_unit(group, name, unit(name));
}

void check_all_units(const h5::Group& root) {
  check_units(root.group("history"), unit_of_history_or_field);
  check_units(root.group("VTKHDF").group("CellData"), unit_of_history_or_field);
  check_units(root.group("VTKHDF").group("PointData"), unit_of_nodal_field);
  if (!root.has("contact")) return;
  const h5::Group contacts = root.group("contact");
  for (const std::string& name : contacts.groups())
    check_units(contacts.group(name), unit_of_contact_array);
}

// The number of steps. It must not exceed the rows of the histories.
std::size_t count_steps(const h5::Group& root) {
  const h5::Group steps = root.group("VTKHDF").group("Steps");
  const std::int64_t n = steps.integer_attribute("NSteps");
  std::int64_t rows = 0;
  if (n != 0) {
    const h5::Shape times = root.group("history").shape("t");
    if (times.empty()) root.group("history").refuse("t", "a scalar", "one time for each step");
    rows = static_cast<std::int64_t>(times[0]);
  }
  if (n < 0 || n > rows)
    steps.refuse("NSteps", fmt::format("{} steps", n), fmt::format("0 to {}", rows));
  return static_cast<std::size_t>(n);
}

}  // namespace

// Reads everything except the steps, and checks all units before the first step is read.
SolutionReader::SolutionReader(const std::string& path)
    : state_(new State{h5::File::open(path), {}, {}, 0}) {
  const h5::Group root = state_->file.root();
  SolutionHeader& header = state_->header;
  header.identity = read_identity(root, solution_schema);
  state_->id = langer::content_id(header.identity, schema_version(root));
  header.mesh = read_grid(root);
  header.formulation = root.text_attribute("formulation");
  read_listing(root.group("material"), header.material);
  if (root.has("materials"))
    for (std::size_t b = 0; b < header.mesh.bodies.size(); ++b)
      read_listing(root.group("materials").group(std::to_string(b)),
                   header.materials.emplace_back());
  header.directions = read_directions(root.group("VTKHDF").group("CellData"), header);
  if (root.has("contact")) {
    const h5::Group contacts = root.group("contact");
    for (const std::string& name : contacts.groups()) {
      auto& nodes = header.contact_nodes[name];
      for (std::int64_t node : contacts.group(name).read<std::int64_t>("nodes", {h5::any}).values) {
        if (node < 0 || node >= header.mesh.n_nodes())
          contacts.group(name).refuse("nodes", fmt::format("node {}", node), "a node of the mesh");
        nodes.push_back(static_cast<int>(node));
      }
      if (contacts.group(name).has("surface"))
        header.indenter_surfaces[name] = read_triangles(contacts.group(name).group("surface"));
    }
  }
  check_all_units(root);
  state_->n_steps = count_steps(root);
}

SolutionReader::~SolutionReader() = default;

const SolutionHeader& SolutionReader::header() const { return state_->header; }
int SolutionReader::n_steps() const { return static_cast<int>(state_->n_steps); }
std::vector<Summary> SolutionReader::summary() const { return read_summary(state_->file.root()); }
const std::string& SolutionReader::content_id() const { return state_->id; }

VibrationRecord SolutionReader::vibration() const {
  return read_vibration(state_->file.root(), state_->header.mesh.X.size());
}

// Row blocks of n nodes or e elements belong to each step, in the order of the steps.
StepRecord SolutionReader::step(int index) const {
  const std::size_t i = static_cast<std::size_t>(index);
  const std::size_t n = state_->header.mesh.X.size();
  const std::size_t e = static_cast<std::size_t>(state_->header.mesh.n_cells());
  if (index < 0 || i >= state_->n_steps)
    throw Failure(Exit::bug, Error{{},
                                   "SolutionReader::step",
                                   std::to_string(index),
                                   fmt::format("0 to {}", n_steps() - 1),
                                   ""});
  const h5::Group root = state_->file.root();
  const h5::Group history = root.group("history");
  const h5::Group grid = root.group("VTKHDF");
  StepRecord record;
  record.t = number_at(history, "t", i);
  record.increment = number_at(history, "increment", i);
  record.residual = number_at(history, "residual", i);
  record.iterations =
      static_cast<int>(history.read_rows<std::int64_t>("iterations", i, 1, {}).values[0]);
  for (const std::string& name : history.datasets())
    if (!solution::among(solution::histories, name))
      record.scalars[name] = number_at(history, name, i);

  // Fields of nodes and elements.
  const h5::Group points = grid.group("PointData");
  const h5::Group cells = grid.group("CellData");
  record.u = vectors(finite_rows(points, "u", i * n, n, {3}));
  record.reaction = vectors(finite_rows(points, "reaction", i * n, n, {3}));
  for (const std::string& name : points.datasets())
    if (name != "u" && name != "reaction")
      record.point_fields[name] = vectors(finite_rows(points, name, i * n, n, {3}));
  for (const std::string& name : cells.datasets())
    if (!solution::is_static(name)) {
      record.cell_fields[name] =
          finite_rows(cells, name, i * e, e, solution::row_shape<h5::Shape>(name));
    }

  // Contacts.
  if (state_->header.contact_nodes.empty()) return record;
  record.u_ind = vectors(finite_rows(history, "u_ind", i, 1, {3}))[0];
  record.force_ind = vectors(finite_rows(history, "force_ind", i, 1, {3}))[0];
  for (const auto& [name, nodes] : state_->header.contact_nodes) {
    const h5::Group group = root.group("contact").group(name);
    ContactRecord& contact = record.contacts[name];
    contact.r = vectors(finite_rows(group, "r", i, 1, {nodes.size(), 3}));
    contact.gap = finite_rows(group, "gap", i, 1, {nodes.size()});
    for (std::int64_t status :
         group.read_rows<std::int64_t>("status", i, 1, {nodes.size()}).values) {
      if (status < 0 || status > 2)
        group.refuse("status", std::to_string(status), "0 open, 1 stick or 2 slip");
      contact.status.push_back(static_cast<int>(status));
    }
    if (!group.has("beta")) continue;
    contact.beta = finite_rows(group, "beta", i, 1, {nodes.size()});
    contact.bonded_at = vectors(finite_rows(group, "bonded_at", i, 1, {nodes.size(), 3}));
    contact.adhesive = vectors(finite_rows(group, "adhesive", i, 1, {nodes.size(), 3}));
  }
  return record;
}

}  // namespace langer
