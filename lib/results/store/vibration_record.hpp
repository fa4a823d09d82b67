// Vibrations about the last state of a solution, as they stand in solution.h5 and in CSV.
//   /modes      frequency [Hz], growth [1/s], breaks_symmetry (0, 1), shape (modes, nodes, 3)
//   /harmonic   frequency [Hz], storage, loss [N/mm]
//   /critical   t, kind, shape (nodes, 3), of a path that has a critical point with a mode
// docs/schema.md
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/tensor/types.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace h5 {
class Group;
}

struct ModesRecord {
  std::vector<double> frequency;         // [Hz], 0 where unstable
  std::vector<double> growth;            // [1/s], 0 where stable
  std::vector<int> breaks_symmetry;      // 1: a movement that symmetry of the state does not have
  std::vector<std::vector<Vec3>> shape;  // largest movement of a node 1
  bool counted = false;                  // shown complete; not in the file
  // Derivatives of the frequencies by name, such as d_frequency_Hz_d_matrix_yeoh_a1; not in the
  // file, but in the table.
  std::vector<std::pair<std::string, std::vector<double>>> derivatives = {};
};

struct HarmonicRecord {
  std::string driver;
  std::vector<double> frequency;      // [Hz]
  std::vector<double> storage, loss;  // [N/mm]
};

// The first critical point of the path.
struct CriticalRecord {
  double t = 0;
  std::string kind;         // accuracy/checks/critical_point.hpp
  std::vector<Vec3> shape;  // its mode, largest movement of a node 1
};

struct VibrationRecord {
  std::optional<ModesRecord> modes;
  std::optional<HarmonicRecord> harmonic;
  std::optional<CriticalRecord> critical = {};
};

void write_vibration(const h5::Group& root, const VibrationRecord& record);
// What the file has; n_nodes: of its mesh.
VibrationRecord read_vibration(const h5::Group& root, std::size_t n_nodes);
// The same of a solution file by its path. Throws Failure(input).
VibrationRecord read_vibration(const std::string& path);

// mode, frequency_Hz, growth_per_s, breaks_symmetry, and the derivatives
std::vector<Column> columns_of(const ModesRecord& record);
// frequency_Hz, storage_N_mm, loss_N_mm, phase_deg
std::vector<Column> columns_of(const HarmonicRecord& record);

}  // namespace langer
