// The tangent K of a body: values in the pattern of pattern.hpp, and how the stiffness of an
// element is added to them.
//
// K is symmetric; the lower triangle of the free rows is stored by columns. It is not cleared as a
// whole before an assembly: the first element that reaches a block of two nodes overwrites it, and
// the others add to it. Which element comes first is known from the order of the blocks.
#pragma once

#include <vector>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/assembly/element_packets.hpp"
#include "mechanics/assembly/pattern.hpp"

namespace langer {

class SparseTangent {
 public:
  // blocks: in the order in which they will be added. Refers to the body.
  SparseTangent(const BodyModel& body, const std::vector<ElementPackets::Block>& blocks);

  const Pattern& pattern() const { return pattern_; }
  const std::vector<double>& values() const { return values_; }  // (nnz) [N/mm]

  // Prepares for an assembly.
  void begin();
  // Adds the stiffness of element e from lane l.
  void add(int e, const PacketElement& element, int lane);
  // Adds to what is already there a symmetric stiffness of element e, (3 nodes, 3 nodes).
  void add(int e, const MatX& stiffness);

  // Adds values in its pattern, (nnz).
  void add(const std::vector<double>& values);

  VecX times(const VecX& v) const;  // K v of the free rows

 private:
  void find_first_elements(const std::vector<ElementPackets::Block>& blocks);
  void add_free(int e, const PacketElement& element, int lane);
  void add_tied(int e, const PacketElement& element, int lane);

  const BodyModel& body_;
  Pattern pattern_;
  std::vector<double> values_;
  std::vector<char> overwrites_;  // by element and pair of nodes, as pattern_.blocks()
  std::vector<int> cleared_;      // positions to which a scattered element comes first
};

}  // namespace langer
