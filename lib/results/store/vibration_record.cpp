#include "results/store/vibration_record.hpp"

#include <cmath>
#include <numbers>

#include "core/hdf5/h5.hpp"
#include "core/hdf5/unit_attribute.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

namespace {

std::vector<double> components_of_all(const std::vector<std::vector<Vec3>>& fields) {
  std::vector<double> values;
  for (const std::vector<Vec3>& field : fields) {
    for (const Vec3& u : field) values.insert(values.end(), u.begin(), u.end());
  }
  return values;
}

std::vector<double> read_in_unit(const h5::Group& group, const std::string& name,
                                 const h5::Shape& shape, const std::string& unit) {
  require_unit(group, name, unit);
  return group.read_finite(name, shape);
}

void write_modes(const h5::Group& group, const ModesRecord& modes) {
  const std::size_t n = modes.frequency.size();
  group.write<double>("frequency", {n}, modes.frequency, "Hz");
  group.write<double>("growth", {n}, modes.growth, "1/s");
  const std::vector<std::int64_t> breaks(modes.breaks_symmetry.begin(),
                                         modes.breaks_symmetry.end());
  group.write<std::int64_t>("breaks_symmetry", {n}, breaks, "-");
  std::size_t nodes = 0;
  if (n > 0) nodes = modes.shape.front().size();
  group.write<double>("shape", {n, nodes, 3}, components_of_all(modes.shape), "-");
}

ModesRecord read_modes(const h5::Group& group, std::size_t n_nodes) {
  ModesRecord modes;
  modes.frequency = read_in_unit(group, "frequency", {h5::any}, "Hz");
  const std::size_t n = modes.frequency.size();
  modes.growth = read_in_unit(group, "growth", {n}, "1/s");
  for (const std::int64_t breaks : group.read<std::int64_t>("breaks_symmetry", {n}).values) {
    if (breaks != 0 && breaks != 1)
      group.refuse("breaks_symmetry", std::to_string(breaks), "0 or 1");
    modes.breaks_symmetry.push_back(static_cast<int>(breaks));
  }
  const std::vector<double> shapes = read_in_unit(group, "shape", {n, n_nodes, 3}, "-");
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Vec3>& shape = modes.shape.emplace_back();
    for (std::size_t a = 0; a < n_nodes; ++a)
      shape.push_back(Eigen::Map<const Vec3>(&shapes[3 * (i * n_nodes + a)]));
  }
  return modes;
}

}  // namespace

void write_vibration(const h5::Group& root, const VibrationRecord& record) {
  if (record.modes) write_modes(root.make_group("modes"), *record.modes);
  if (record.critical) {
    const h5::Group critical = root.make_group("critical");
    critical.attribute("kind", record.critical->kind);
    critical.write<double>("t", {1}, std::vector{record.critical->t}, "-");
    critical.write<double>("shape", {record.critical->shape.size(), 3},
                           components_of_all({record.critical->shape}), "-");
  }
  if (!record.harmonic) return;
  const HarmonicRecord& harmonic = *record.harmonic;
  const h5::Group group = root.make_group("harmonic");
  const std::size_t n = harmonic.frequency.size();
  group.attribute("driver", harmonic.driver);
  group.write<double>("frequency", {n}, harmonic.frequency, "Hz");
  group.write<double>("storage", {n}, harmonic.storage, "N/mm");
  group.write<double>("loss", {n}, harmonic.loss, "N/mm");
}

VibrationRecord read_vibration(const h5::Group& root, std::size_t n_nodes) {
  VibrationRecord record;
  if (root.has("modes")) record.modes = read_modes(root.group("modes"), n_nodes);
  if (root.has("critical")) {
    const h5::Group group = root.group("critical");
    CriticalRecord& critical = record.critical.emplace();
    critical.kind = group.text_attribute("kind");
    critical.t = read_in_unit(group, "t", {1}, "-").front();
    const std::vector<double> shape = read_in_unit(group, "shape", {n_nodes, 3}, "-");
    for (std::size_t i = 0; i < n_nodes; ++i)
      critical.shape.push_back(Eigen::Map<const Vec3>(&shape[3 * i]));
  }
  if (!root.has("harmonic")) return record;
  const h5::Group group = root.group("harmonic");
  HarmonicRecord& harmonic = record.harmonic.emplace();
  harmonic.driver = group.text_attribute("driver");
  harmonic.frequency = read_in_unit(group, "frequency", {h5::any}, "Hz");
  harmonic.storage = read_in_unit(group, "storage", {harmonic.frequency.size()}, "N/mm");
  harmonic.loss = read_in_unit(group, "loss", {harmonic.frequency.size()}, "N/mm");
  return record;
}

VibrationRecord read_vibration(const std::string& path) { return SolutionReader(path).vibration(); }

std::vector<Column> columns_of(const ModesRecord& record) {
  Column mode{"mode", "-", {}};
  Column breaks{"breaks_symmetry", "-", {}};
  for (std::size_t i = 0; i < record.frequency.size(); ++i) {
    mode.values.push_back(static_cast<double>(i + 1));
    breaks.values.push_back(record.breaks_symmetry[i]);
  }
  std::vector<Column> columns{std::move(mode),
                              {"frequency", "Hz", record.frequency},
                              {"growth", "1/s", record.growth},
                              std::move(breaks)};
  for (const auto& [name, values] : record.derivatives) columns.push_back({name, "-", values});
  return columns;
}

// The names of the last columns contain their units: written by csv_name(), N/mm would be
// N_per_mm.
std::vector<Column> columns_of(const HarmonicRecord& record) {
  Column phase{"phase", "deg", {}};
  for (std::size_t i = 0; i < record.frequency.size(); ++i)
    phase.values.push_back(180 / std::numbers::pi * std::atan2(record.loss[i], record.storage[i]));
  return {{"frequency", "Hz", record.frequency},
          {"storage_N_mm", "-", record.storage},
          {"loss_N_mm", "-", record.loss},
          std::move(phase)};
}

}  // namespace langer
