// Lines through the depth of a stack of layers.
//
// Motions along the surface with the wavenumber k decay like exp(-s k d) with the distance d from
// the surface or interface that they belong to. Lines are therefore short next to faces and grow
// with the distance:
//   h(d) = (size / k) (1 + growth k d), at most largest / k
// What lies deeper is a half-space of lines of the last length, without end (line_chain.hpp).
// Longer lines would keep the volume too loosely, and show modes that are none.
// Where a wave is faster than the layer's own shear waves, it does not decay but oscillates; lines
// then have one size, that of the oscillation.
#pragma once

#include <vector>

namespace langer {

struct DepthLine {
  double length = 0;  // [mm]
  int layer = 0;      // from the top
};

struct LineChoice {
  double size = 0.4;     // of the first line, times k
  double growth = 0.3;   // per distance, times k
  double largest = 1.6;  // of a line, times k
  double depth = 12;     // from which a half-space is a chain of equal lines, times k
  double deep = 60;      // from which a layer counts as a half-space, times k
  int refine = 1;        // every line is divided so often
};

struct LineMesh {
  std::vector<DepthLine> lines;  // from the bottom to the top
  bool cut = false;              // what lies below was left out, and the last node is held
};

// thickness: deformed, from the top; the last may be infinite. oscillation: wavenumber through
// the depth in each layer [1/mm], 0 where motions decay. cuttable: the depth may end within a
// layer.
LineMesh line_mesh(const std::vector<double>& thickness, double k,
                   const std::vector<double>& oscillation, bool cuttable,
                   const LineChoice& choice = {});

}  // namespace langer
