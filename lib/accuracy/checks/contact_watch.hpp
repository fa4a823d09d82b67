// Whether the force of an indenter can be trusted.
//
// The contact law knows candidate nodes only. Each indenter is therefore compared with the whole
// boundary, before the path and after every increment (contact/surface_check.hpp).
//   refused  (Failure(config) at the contact's key): an indenter that starts inside the body; one
//            smaller than the cells, or deeper between their nodes than these are apart; a node
//            inside that is no candidate, by more than 1 % of the indentation depth; no reaction at
//            the end of the path though a facet is entered; an indenter that jumps through the body
//   warned   the same below these limits; a facet entered by more than 10 % of the depth at the
//            largest force; no facet that touches as a whole; an indenter that never touches
// Records are those of the whole body, of a section those of its own mesh.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mechanics/contact/surface_check.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

class ContactWatch {
 public:
  using Where = std::function<Place(const std::string&)>;
  // refers to mesh and scene; throws Failure(config) where an indenter starts inside the body
  ContactWatch(const Mesh& mesh, const Scene& scene, Where where);
  void kept(const StepRecord& step);  // by an earlier run
  // throws Failure(config); adds penetration_between_nodes, and with several indenters
  // force_<name>, to the record's scalars
  void look(StepRecord& record);
  void finish() const;  // at the end of the path; throws Failure(config)

  std::vector<std::string> warnings() const;  // of the whole path
  std::vector<Summary> summary() const;

 private:
  struct Found {                     // of one indenter
    double force = 0;                // largest [N]
    SurfaceLook at_force;            // there
    SurfaceLook::Spot node, facet;   // deepest of all steps
    double distance, t_nearest = 0;  // smallest of all steps
    Vec3 nearest;
    bool touched = false;
    Vec3 c = Vec3::Zero();  // displacement of the indenter at the last look
    bool away = true;       // which found nothing that touches
    double share() const;   // of the deepest entry between nodes in what the body is pressed in, at
                            // the largest force
  };
  void keep(std::size_t contact, const SurfaceLook& look, double t, double force);
  void refuse_jump(const RigidContact& contact, const std::vector<Vec3>& u, const Vec3& from,
                   const Vec3& to, double t) const;
  void refuse_mid_path(const RigidContact& contact, const SurfaceLook& look, double t) const;
  [[noreturn]] void refuse(const std::string& key, std::string found, std::string expected,
                           std::string hint) const;

  const Mesh& mesh_;
  const Scene& scene_;
  Where where_;
  SurfaceCheck check_;
  std::vector<Found> found_;
  bool adds_ = true;  // to records: not where the steps before have none
};

}  // namespace langer
