#include "results/post/recovery.hpp"

#include <algorithm>
#include <cmath>

#include "core/tensor/stress.hpp"

namespace langer {

namespace {

// The averages of the elements of one region at its nodes (n), weighted with their volume.
std::vector<Vec6> smoothed(const Body& body, const GaussValues& gauss, int region) {
  const Mesh& mesh = body.mesh();
  const ReferenceCell& cell = mesh.cell();
  std::vector<Vec6> sum(mesh.X.size(), Vec6::Zero());
  std::vector<double> V(mesh.X.size(), 0);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    if (body.region(e) != region) continue;
    const Eigen::Matrix<double, Eigen::Dynamic, 6> at_nodes =
        cell.at_nodes * gauss[e].leftCols<6>();
    for (int a = 0; a < cell.n_nodes; ++a) {
      const int node = mesh.cell(e)[a];
      sum[node] += body.geometry(e).V * at_nodes.row(a).transpose();
      V[node] += body.geometry(e).V;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (V[i] > 0) sum[i] /= V[i];
  return sum;
}

// The greatest difference of the von Mises stress between an element and the average, over the
// nodes of all elements at a node. The node alone is not enough: a corner may belong to one
// element only, or elements may mirror each other, and then there is no difference.
double spread_around(const Body& body, const GaussValues& gauss, const std::vector<Vec6>& smooth,
                     int region, int node) {
  const Mesh& mesh = body.mesh();
  const ReferenceCell& cell = mesh.cell();
  std::vector<char> is_near(mesh.X.size(), 0);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto nodes = mesh.cell(e);
    if (body.region(e) != region || std::ranges::find(nodes, node) == nodes.end()) continue;
    for (int n : nodes) is_near[n] = 1;
  }
  double spread = 0;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    if (body.region(e) != region) continue;
    for (int a = 0; a < cell.n_nodes; ++a) {
      const int n = mesh.cell(e)[a];
      if (!is_near[n]) continue;
      const Vec6 here = (cell.at_nodes.row(a) * gauss[e].leftCols<6>()).transpose();
      spread = std::max(spread, std::abs(von_mises(tensor(here)) - von_mises(tensor(smooth[n]))));
    }
  }
  return spread;
}

// |dev s|^2
double deviatoric_square(const Vec6& stress) {
  return std::pow(von_mises(tensor(stress)), 2) / 1.5;
}

int n_regions(const Body& body) {
  int regions = 1;
  for (int e = 0; e < body.mesh().n_cells(); ++e) regions = std::max(regions, body.region(e) + 1);
  return regions;
}

// The squares of e and U.
struct Energies {
  double error = 0;
  double whole = 0;

  double eta() const {
    if (whole > 0) return std::sqrt(error / whole);
    return 0;
  }
};

// Adds the energies of one region. The error of each element is written to of_cell unless it is
// nullptr.
void add_region(Energies& energies, const Body& body, const GaussValues& gauss,
                const std::vector<Vec6>& smooth, int region, std::vector<double>* of_cell) {
  const Mesh& mesh = body.mesh();
  const ReferenceCell& cell = mesh.cell();
  for (int e = 0; e < mesh.n_cells(); ++e) {
    if (body.region(e) != region) continue;
    const double mu = shear_modulus(body.material(e));
    const double before = energies.error;
    for (int g = 0; g < cell.n_gauss; ++g) {
      Vec6 s = Vec6::Zero();
      for (int a = 0; a < cell.n_nodes; ++a) s += cell.N[g][a] * smooth[mesh.cell(e)[a]];
      const double w = body.geometry(e).w[g] * gauss[e](g, 6) / (4 * mu);
      energies.error += w * deviatoric_square(s - gauss[e].row(g).head<6>().transpose());
      energies.whole += w * deviatoric_square(s);
    }
    if (of_cell) (*of_cell)[static_cast<std::size_t>(e)] = energies.error - before;
  }
}

}  // namespace

double recovered_energy_share(const Body& body, const std::vector<Vec3>& u) {
  const GaussValues gauss = gauss_values(body, u);
  Energies energies;
  for (int region = 0; region < n_regions(body); ++region)
    add_region(energies, body, gauss, smoothed(body, gauss, region), region, nullptr);
  return energies.eta() * energies.eta();
}

// The same energies, and in addition the parts of the elements and the spread at the greatest von
// Mises stress.
RecoveredError recovered_error(const Body& body, const std::vector<Vec3>& u) {
  const Mesh& mesh = body.mesh();
  const GaussValues gauss = gauss_values(body, u);
  RecoveredError out;
  out.of_cell.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  Energies energies;
  for (int region = 0; region < n_regions(body); ++region) {
    const std::vector<Vec6> smooth = smoothed(body, gauss, region);
    add_region(energies, body, gauss, smooth, region, &out.of_cell);
    // The node of the greatest von Mises stress so far, if this region has it.
    int worst = -1;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      if (body.region(e) != region) continue;
      for (int node : mesh.cell(e)) {
        const double here = von_mises(tensor(smooth[node]));
        if (!(here > out.von_mises_max)) continue;
        out.von_mises_max = here;
        worst = node;
      }
    }
    if (worst >= 0) out.von_mises_spread = spread_around(body, gauss, smooth, region, worst);
  }
  out.eta = energies.eta();
  for (double& part : out.of_cell) {
    if (energies.whole > 0) {
      part = part / energies.whole;
    } else {
      part = 0;
    }
  }
  return out;
}

}  // namespace langer
