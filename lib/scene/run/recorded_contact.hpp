// Contact as a result: what the indenters of a solution do to each node of the body.
#pragma once

#include <optional>

#include "results/post/contact_surface.hpp"
#include "scene/run/post_files.hpp"

namespace langer {

// Refers to all it is given. Slip is found by walking along the path, the first time that it is
// asked for.
class ContactStates {
 public:
  ContactStates(const SolutionReader& solution, const std::vector<RigidContact>& indenters,
                const std::vector<SurfaceContact>& touching);
  const std::map<std::string, ContactSurface>& surfaces() const { return surfaces_; }
  bool knows_slip() const { return !indenters_.empty() || !touching_.empty(); }
  // of the candidates of a contact at a row of the table of states [mm]; empty where the indenter's
  // shape, or the surface that is touched, is not known
  std::vector<double> slip(const std::string& contact, int row) const;
  // at each node of the body; record: of that row
  std::vector<ContactNode> nodes(int row, const StepRecord& record, bool with_slip) const;

 private:
  void go_to(int row) const;
  const SolutionReader& solution_;
  const std::vector<RigidContact>& indenters_;
  const std::vector<SurfaceContact>& touching_;  // deformable
  std::map<std::string, ContactSurface> surfaces_;
  mutable std::optional<EnergyPath> path_;
  mutable int row_ = 0;
};

// Point data of a snapshot: pressure, traction, status, force, gap, slip of each contact.
void add_contact_fields(std::vector<Field>& points, const ContactStates& contacts,
                        const SolutionHeader& header, const StepRecord& record, int row);

}  // namespace langer
