// Quadratic lines through the depth of layers, for motions u(y) exp(i (k x' - w t)) along the
// direction x' of the plane:
//   (K0 + i k K1 + k^2 K2 - w^2 M) u = 0
//
// Fibres lie in the plane, so every layer is its own mirror image in it. With u = (a, i b, c) along
// x', y (depth) and z' all matrices become real. Displacements are quadratic in a line; a
// continuous linear pressure in each layer keeps the volume. The unknowns are eliminated from the
// bottom to the top; what is left is the stiffness of the surface, a (3,3) matrix:
//   - the number of negative pivots beyond those of the pressures is the number of modes below w^2
//     (Sturm; Wittrick and Williams 1971), whatever the mode looks like;
//   - where an eigenvalue s of the surface stiffness is 0, its vector is the surface motion of a
//     mode; ds/dw^2 = -u.M u and ds/dk = u.K'(k) u give Newton's step.
// Below a half-space stands a chain of equal lines without end: two equal parts are joined to one
// of twice the thickness by elimination of the node between them, twenty times. One elimination
// costs a few thousand operations a line. Attenuation takes complex moduli.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "layers/layer_state.hpp"
#include "layers/line_mesh.hpp"

namespace langer {

// Moduli of one layer in the frame x', y, z' of a direction: energy k^2 u.Q u + u'.T u' + 2 k u.S
// u'
template <class Number>
struct DirectedModuli {
  Eigen::Matrix<Number, 3, 3> Q, S, T;
  Number compressibility = 0;  // 1 / (J U'') [1/MPa]; 0: incompressible
  double density = 0;
};

// angle from x towards z in the deformed plane, in radians; frequency in rad/s for the branches
DirectedModuli<double> directed_moduli(const LayerState& state, double angle);
DirectedModuli<double> storage_moduli(const LayerState& state, double angle, double frequency);
DirectedModuli<std::complex<double>> complex_moduli(const LayerState& state, double angle,
                                                    double frequency);

enum class BottomFace { fixed, free };

template <class Number>
class LineChain {
 public:
  using Mat = Eigen::Matrix<Number, 3, 3>;
  using Vec = Eigen::Matrix<Number, 3, 1>;

  // layers from the top; surface_tension of the top face [N/mm]
  LineChain(std::vector<DirectedModuli<Number>> layers, LineMesh mesh, BottomFace bottom,
            double surface_tension = 0);

  // Eliminates all but the surface. keep: for motion().
  void eliminate(Number k, double w2, bool keep = false);
  const Mat& surface() const { return surface_; }
  int modes_below() const { return modes_below_; }  // of real moduli
  // Those of the half-space alone, held at its upper face: 0 as long as no body waves travel in it.
  int modes_of_half_space() const { return modes_of_half_space_; }

  // Forms of the whole motion u that has the surface motion v, after eliminate(keep).
  struct Forms {
    Number mass = 0;   // u.M u
    Number slope = 0;  // u.K'(k) u
  };
  Forms forms(const Vec& v) const;
  std::size_t lines() const { return mesh_.lines.size(); }

 private:
  using Local = Eigen::Matrix<Number, 11, 11>;
  using Column = Eigen::Matrix<Number, 11, 1>;
  struct Part {                              // of a line, its length and layer
    Eigen::Matrix<Number, 7, 4> eliminated;  // from (u, p) of the upper node
    Vec pressure = Vec::Zero();              // of the upper node, from its u; at the top of a layer
    bool top_of_layer = false;
  };
  using Node = Eigen::Matrix<Number, 4, 4>;  // of (u, p)
  struct HalfSpace {
    Node stiffness;  // of its upper node
    int modes = 0;
  };
  HalfSpace half_space(Number k, double w2) const;
  void add_stiffness(const DepthLine& line, Number k, double w2, Local& E) const;

  std::vector<DirectedModuli<Number>> layers_;
  LineMesh mesh_;
  bool held_ = true;
  double tension_ = 0;
  Number k_ = 0;
  Mat surface_;
  int modes_below_ = 0;
  int modes_of_half_space_ = 0;
  double w2_ = 0;
  std::vector<Part> parts_;
};

extern template class LineChain<double>;
extern template class LineChain<std::complex<double>>;

}  // namespace langer
