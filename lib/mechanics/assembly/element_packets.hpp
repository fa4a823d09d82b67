// Elements of one material, evaluated eight at a time.
//
// A packet holds up to eight elements (Packet::lanes) in the lanes of vector instructions
// (element/packet_solid.hpp). Elements are grouped into blocks once, when the body is made.
// Materials that the packet kernel does not handle are evaluated one by one with the scalar element
// (element/solid.hpp), which is also the oracle of the tests.
#pragma once

#include <vector>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/assembly/pressure_field.hpp"
#include "mechanics/assembly/viscous_state.hpp"
#include "mechanics/element/packet_solid.hpp"

namespace langer {

enum class Kernel { packets, one_by_one };

class ElementPackets {
 public:
  // Up to eight elements of one material; a short block repeats its last element.
  struct Block {
    int cells[Packet::lanes];
    int n;
  };

  ElementPackets(const BodyModel& body, Kernel kernel);  // refers to the body

  const std::vector<Block>& blocks() const { return blocks_; }
  // To be called after the body's materials or directions have changed.
  void update_materials();
  // To be called after viscous.begin(): packs the history stresses of the increment.
  void pack_history(const ViscousState& viscous);

  // Forces, energy and dilatations of block b at displacements u, and with_tangent the stiffness.
  void evaluate(std::size_t b, const VecX& u, const PressureField& pressures,
                const ViscousState& viscous, bool with_tangent, PacketElement& out) const;
  // Smallest J at the Gauss points of all blocks, without anything else.
  double smallest_J(const VecX& u) const;

 private:
  void make_blocks();
  void pack_fibres();
  void choose_kernel();
  void load(const Block& block, const VecX& u, Packet* q) const;
  void evaluate_packet(std::size_t b, const VecX& u, const PressureField& pressures,
                       const ViscousState& viscous, bool with_tangent, PacketElement& out) const;
  void evaluate_one_by_one(const Block& block, const VecX& u, const PressureField& pressures,
                           const ViscousState& viscous, bool with_tangent,
                           PacketElement& out) const;

  const BodyModel& body_;
  Kernel requested_;
  Kernel kernel_;  // the requested one, if all materials have a packet form
  std::vector<Block> blocks_;
  std::vector<PacketGeometry> geometry_;          // by block
  std::vector<std::vector<PacketFibre>> fibres_;  // by block
  std::vector<std::vector<Packet>> history_;      // by block: H as PacketMemory needs it
};

}  // namespace langer
