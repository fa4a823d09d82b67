// The numbers of a scene that a config's `sensitivity` names, and the same scene where they are
// others.
//   matrix.yeoh.a1                      of the material at the top, in all bodies that take it (material/parameters.hpp)
//   materials.dermis.matrix.yeoh.a1     of the body's own
//   fibres[0].alpha                     angle of a family [deg]: it turns in its cells
//   contacts.sphere.friction            of an indenter
//   contacts.sphere.rigid.sphere.radius any number of its shape (scene/model/config_number.hpp)
//   contacts.sphere.adhesion.work       work, stiffness, tangential, viscosity of its bonds
//   mesh.bodies[0].thickness            of a flat layer; mesh.geometry.block.size[1] of one body
//   loads[0].pressure                   or displacement, rotation.angle, force, traction of one number
//   contacts.sphere.control.force       of an indenter
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mechanics/solve/state_tangent.hpp"
#include "scene/model/config_number.hpp"
#include "scene/model/scene.hpp"

namespace langer {

struct SceneParameter {
  std::string key;   // as in the config
  std::string name;  // dots and brackets turned to underscores: matrix_yeoh_a1, fibres_0_hgo_c1
  std::string unit;
  double value = 0;  // in the scene
};

// name of the derivative of a quantity, unit included: d_force_N_d_matrix_yeoh_a1
std::string derivative_name(const std::string& quantity, const SceneParameter& parameter);

// The scene where the number of a load is a little less, or more, by `width` in all.
struct LoadChange {
  std::shared_ptr<const Scene> less, more;
  double width = 1;
};

class SceneParameters {
 public:
  using Where = std::function<Place(const std::string&)>;
  // None without the key. Throws Failure(config) at sensitivity[i]: a number that the scene does
  // not have, or that nothing can be differentiated by.
  SceneParameters(const SolveConfig& config, const Mesh& mesh, const Scene& scene,
                  const Where& where);

  const std::vector<SceneParameter>& list() const { return list_; }
  bool turns_fibres() const;
  bool moves_mesh() const;
  bool of_laws(std::size_t i) const {
    return of_[i].contact.empty() && !of_[i].layer && !of_[i].load;
  }
  // The layer whose thickness number i is, in the mesh of the whole or of a part; else nothing.
  const std::optional<LayerThickness>& layer(std::size_t i) const { return of_[i].layer; }
  // Shapes of contact(i) around that of the scene; nothing where i is no number of a shape.
  const std::optional<ShapeChange>& shape(std::size_t i) const { return of_[i].shape; }
  // What number i changes of the bonds of contact(i); nothing where it is none of theirs.
  const std::optional<Adhesion>& bonds(std::size_t i) const { return of_[i].bonds; }
  // Scenes around this one, if number i is one of a load.
  const std::optional<LoadChange>& load(std::size_t i) const { return of_[i].load; }
  const std::string& contact(std::size_t i) const {
    return of_[i].contact;
  }  // whose friction, shape or bonds it is of; empty: a number of laws, or a thickness
  bool linear(std::size_t i) const { return of_[i].linear; }  // forces and energy are linear in it
  double step(std::size_t i) const;  // of a difference, central but where they are

  // The laws and directions of the scene, or of a part of it, where number i is larger by `by`.
  struct Laws {
    std::vector<Material> materials;
    Directions directions;
  };
  Laws varied(const Scene& scene, const Mesh& mesh, std::size_t i, double by) const;
  // Each of them by another amount: what is symmetric then is so for every set of them.
  Scene varied_unlike(const Scene& scene, const Mesh& mesh) const;

 private:
  struct Of {
    std::string contact;
    std::string key;          // of the material
    std::vector<int> bodies;  // of the mesh
    int family = -1;          // whose angle it is
    bool linear = false;
    double modulus = 0;  // where it is: the largest of its law [MPa]
    std::optional<LayerThickness> layer = {};
    std::optional<ShapeChange> shape = {};
    std::optional<LoadChange> load = {};
    std::optional<Adhesion> bonds = {};
  };
  void add_other_loads(const SolveConfig& config, const Mesh& mesh, const Scene& scene,
                       const Where& where);
  bool take_load(const std::string& key, const SolveConfig& config, const Mesh& mesh,
                 const Scene& scene, const Where& where);
  bool take_shape(const std::string& key, const SolveConfig& config, const Error& refused);
  bool take_bonds(const std::string& key, const RigidContact& contact, const Error& refused);
  bool take_thickness(const std::string& key, const SolveConfig& config, const Mesh& mesh,
                      const Scene& scene, const Error& refused);
  void take(const std::string& key, const SolveConfig& config, const Mesh& mesh, const Scene& scene,
            const Error& refused, const Where& where);

  std::vector<SceneParameter> list_;
  std::shared_ptr<const Scene>
      other_loads_;  // with all numbers of loads changed; none: no such one
  std::vector<Of> of_;
};

}  // namespace langer
