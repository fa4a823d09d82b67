// Grid lines along one axis of a block.
//   even        n cells of equal length
//   refined     cells near one end (or around the centre) have a given edge; the others grow geometrically so that n fit
//   resampled   more or fewer cells, graded in the same way
//   through     moves lines so that demanded coordinates are hit, the lines between two of them in proportion
// Lengths in mm. Throws Failure(config) with the key where the numbers contradict each other.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/fields.hpp"

namespace langer {

// throws Failure(config) at the key of a mesh
[[noreturn]] void refuse(const std::string& key, const std::string& found,
                         const std::string& expected, const std::string& hint);

// a demanded coordinate and who demands it, for messages
struct Demand {
  double at = 0;
  std::string by;
};

// 0 ... length in n cells, the first ones `edge` long up to `within`
std::vector<double> refined(double length, int n, double edge, double within,
                            const std::string& key);

std::vector<double> even_lines(double low, double high, int n);

// mirrored about the middle, exactly where the middle is 0; `edge` is the length of the cells
// around it
std::vector<double> lines_to_centre(double low, double high, int n, double edge, double within,
                                    const std::string& key);

// One side of a place at which cells have the length `edge` up to `within` and grow from there.
struct GradedSide {
  double length = 0, within = 0, edge = 0;
  int n = 0;  // cells; 0: the place lies on this end
};
// a line through `place`, with a side below and one above it
std::vector<double> lines_around(double place, const GradedSide& below, const GradedSide& above,
                                 const std::string& key);

// the uppermost cell is `edge` long
std::vector<double> lines_to_top(double low, double high, int n, double edge,
                                 const std::string& key);

// n other cells over the same length, whose lengths change with the place as those of `lines` do,
// all by one factor
std::vector<double> resampled(const std::vector<double>& lines, int n);

// The lines of a mesh of a family (meshing/box.hpp): between the breaks as many cells as the family
// gives, graded as `lines` are. One cell without breaks stays one.
std::vector<double> in_family(const std::vector<double>& lines, std::vector<double> breaks,
                              double length, int parts);

// n[i] / factor for a factor near `wanted` by which all can be divided best; fewer than n of at
// least one. What is 0 stays 0.
std::vector<int> divided(const std::vector<int>& n, double wanted);

struct Moved {
  std::vector<double> lines;
  double furthest = 0;  // largest way of a line
};
Moved through(const std::vector<double>& lines, std::vector<Demand> demands,
              const std::string& axis, const std::string& key);

// what `act` refuses, as complaints
std::vector<Complaint> complaints_of(auto act) {
  std::vector<Complaint> found;
  try {
    act();
  } catch (const Failure& failure) {
    for (const Error& e : failure.errors()) found.push_back({e.key, e.found, e.expected, e.hint});
  }
  return found;
}

}  // namespace langer
