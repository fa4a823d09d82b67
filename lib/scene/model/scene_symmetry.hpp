// A scene that is its own image under a mirror plane or a half turn is solved on the part of the
// body that decides the rest.
//   recognised from  mesh and bodies, and what scene/model/scene_image.hpp looks at: fibres, supports and imposed displacements, indenters and
//                    their paths; all of them must agree
//   two indenters    of which one is the other's image: the part has one of them, or half of both; each has its own force in results
//   two surfaces     that touch each other, of mirror planes that no cell crosses; not in motion, and no surface that touches itself
//   up to a movement as a rigid body   of bodies without contact and not in motion: where one end is held and the other pulled, the
//                    displacements are symmetric as seen from half way between them
//   not recognised   indenters read from a file; planes and axes that are not parallel to the coordinate planes or do not pass
//                    through the middle of the body
// The reduced scene finds symmetric equilibria only: it cannot leave them where they become
// unstable, and the signs of its tangent are those for symmetric movements; symmetry_breaking_dofs
// are for the others. Results are written for the whole body. A mesh that is a section
// (mesh/section.hpp) is another such part: the nodes behind z = 0 move as those in it. Its results
// are written for its own nodes, those in z = 0 with the forces of the whole circle or slab; those
// of them along x are radial there, and only the resultant along y is a force on the indenter.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "mechanics/mesh/symmetry.hpp"
#include "mechanics/solve/increment.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

class ReducedScene {
 public:
  // Nothing where `wanted` is none, or auto and nothing is found; a section always.
  // varied: the scene with other numbers, which has to have the symmetry too, where derivatives
  // with respect to them are asked for. Throws Failure(config) where a named symmetry is not there,
  // saying what breaks it.
  enum class Seen { from_rest, from_half_way };  // the latter where the former has no symmetry
  static std::optional<ReducedScene> find(SymmetryChoice wanted, const Mesh& mesh,
                                          const Scene& scene,
                                          const std::function<Place(const std::string&)>& where,
                                          const Scene* varied = nullptr,
                                          Seen seen = Seen::from_half_way);

  const Mesh& mesh() const { return quotient_.mesh; }
  const Scene& scene() const { return scene_; }
  const std::vector<double>& cell_share() const { return quotient_.cell_share; }
  const std::string& words() const {
    return words_;
  }  // "half turn about y through (18, 18): 6160 of 12320 cells"

  StepRecord whole(const StepRecord& reduced) const;  // of the whole body
  BodyState reduced(const StepRecord& whole) const;   // to continue from
  bool swaps_indenters() const { return swaps_indenters_; }

  // Constraints of the part for movements that break the symmetry, one for each kind of them
  // (symmetry_breaking_ties in mesh/symmetry.hpp). Empty for a section, whose nodes are those of a
  // slice: it has no mesh for what leaves its plane.
  std::vector<Dofs> symmetry_breaking_dofs() const;

  // Whole nodes in terms of those of the part, for movements that keep the symmetry.
  const std::vector<Image>& node_images() const { return quotient_.node_image; }
  // A movement u (3 n) of the part at the nodes of the whole mesh. kind: 0 keeps the symmetry, k
  // is that of symmetry_breaking_dofs()[k - 1].
  std::vector<Vec3> whole_movement(const Mesh& whole, const VecX& u, int kind) const;

 private:
  // a candidate of the part as a node of one of the whole body's contacts, and what stands for a
  // candidate of the whole body
  struct Touch {
    int contact = 0, node = 0;  // of the whole body's scene, and a node of the part
    Mat3 T = Mat3::Identity();  // turns its force
    double share = 1;           // how many candidates it stands for
  };
  struct CandidateImage {
    int contact = 0, of = 0;  // of the part's scene
    Mat3 T = Mat3::Identity();
  };
  static void append_image(const ContactRecord& kept, std::size_t of, const Mat3& T, double share,
                           ContactRecord& images);
  Vec3 translation_at(double t) const;
  static ReducedScene of_section(const Mesh& mesh, const Scene& scene);
  void take_part(const Mesh& mesh, const Scene& scene, const std::vector<Symmetry>& generators,
                 const std::vector<std::vector<int>>& contacts);
  void take_supports(const Scene& scene);
  void take_loads(const Scene& scene);
  void take_contacts(const Scene& scene,
                     const std::function<Touch(int contact, int node)>& stands_for);
  void find_turned_families(const Mesh& mesh, const Scene& scene,
                            const std::vector<Symmetry>& group);
  void take_surfaces(const Scene& scene);
  void expand_contacts(const StepRecord& reduced, StepRecord& record) const;
  void expand_surfaces(const StepRecord& reduced, StepRecord& record) const;
  void update_turned_families(const StepRecord& reduced, StepRecord& record) const;

  Quotient quotient_;
  std::vector<std::vector<Image>> breaking_ties_;  // by kind of movement
  std::vector<int> held_;  // dofs of the part that supports and loads prescribe in the whole body
  Scene scene_;
  std::vector<Vec3> generators_;  // signs of each
  Vec3 centre_ = Vec3::Zero();
  std::string words_;
  std::vector<Prescribed> translation_;  // of the place from which the part is seen, by axis (dof)
  bool swaps_indenters_ = false;
  std::vector<RigidContact> contacts_;  // of the whole body
  std::vector<std::vector<CandidateImage>>
      candidate_;                                     // by contact and candidate of the whole body
  std::vector<std::vector<double>> candidate_share_;  // by those of the part, as the next
  std::vector<std::vector<std::array<int, 2>>>
      origin_;                            // itself: contact and candidate of the whole body
  std::vector<SurfaceContact> surfaces_;  // of the whole body
  Vec3 kept_directions_ = Vec3::Ones();   // 0 where the resultant of any symmetric field vanishes
  // cells of the whole body whose first family is along a where they are, turned to the cell of the
  // part
  struct TurnedFamily {
    int cell = 0, of = 0;
    Vec3 a;
  };
  std::vector<TurnedFamily> turned_;
};

}  // namespace langer
