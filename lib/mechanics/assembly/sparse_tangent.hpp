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
  // Adds a 3 x 3 block of element e, of its nodes a >= b, to what is already there.
  void add_block(int e, int a, int b, const Mat3& K);

  // Adds values in its pattern, (nnz).
  void add(const std::vector<double>& values);

  VecX times(const VecX& v) const;  // K v of the free rows

 private:
  void find_first_elements(const std::vector<ElementPackets::Block>& blocks);
  void add_free(int e, const PacketElement& element, int lane);
  void add_tied(int e, const PacketElement& element, int lane);
  // Position in values() of an element's entry, row >= column; Pattern::none if it is prescribed.
  int position(int e, int row, int column) const;
  // How often an entry on the diagonal of a tied block counts: twice if both nodes move with one.
  int multiplicity(int e, int a, int b, int i, int j) const;

  const BodyModel& body_;
  Pattern pattern_;
  std::vector<double> values_;
  std::vector<char> overwrites_;  // by element and pair of nodes, as pattern_.blocks()
  std::vector<int> cleared_;      // positions to which a scattered element comes first
};

}  // namespace langer
