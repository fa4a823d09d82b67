#include "scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>

#include "geometry/read_surface.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

class Composer {
 public:
  Composer(const Mesh& mesh, const Find& where) : mesh_(mesh), where_(where) {}

  const std::vector<int>& nodes(const std::string& set, const std::string& key) {
    static const std::vector<int> none;
    const auto found = mesh_.node_sets.find(set);
    if (found != mesh_.node_sets.end() && !found->second.empty()) return found->second;
    std::vector<std::string> known;
    std::string list;
    for (const auto& [name, members] : mesh_.node_sets) known.push_back(name), list += (list.empty() ? "" : ", ") + name;
    const std::string near = nearest(set, known);
    errors.push_back({where_(key), key, fmt::format("found \"{}\"", set), "a node set of the mesh: " + list,
                      near.empty() ? "" : fmt::format("did you mean \"{}\"?", near)});
    return none;
  }

  std::vector<Error> errors;

 private:
  const Mesh& mesh_;
  const Find& where_;
};

}  // namespace

Scene make_scene(const SolveConfig& config, const Mesh& mesh, Material material, const Find& where) {
  Scene scene;
  Composer composer(mesh, where);
  std::vector<Prescribed> prescribed;
  std::vector<std::string> named_by(3 * static_cast<std::size_t>(mesh.n_nodes()));
  std::vector<double> value(named_by.size(), 0);
  const auto prescribe = [&](int node, int axis, double to, const std::string& key) {
    const std::size_t dof = 3 * static_cast<std::size_t>(node) + axis;
    if (!named_by[dof].empty() && value[dof] != to) {
      composer.errors.push_back(
          {where(key), key,
           fmt::format("asks for {} = {} mm at a node that {} sets to {} mm", "xyz"[axis], to, named_by[dof], value[dof]),
           "one value for each direction of a node", ""});
      return false;
    }
    named_by[dof] = key, value[dof] = to;
    prescribed.push_back({static_cast<int>(dof), to});
    return true;
  };

  for (std::size_t i = 0; i < config.supports.size(); ++i) {
    const std::string key = fmt::format("supports[{}]", i);
    for (int node : composer.nodes(config.supports[i].on, key + ".on"))
      for (Axis axis : config.supports[i].hold) prescribe(node, static_cast<int>(axis), 0, key);
  }
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const std::string key = fmt::format("loads[{}]", i);
    const Displacement& d = config.loads[i].displacement;
    bool agrees = true;
    for (int node : composer.nodes(config.loads[i].on, key + ".on"))
      for (int axis = 0; axis < 3 && agrees; ++axis)
        if (const auto& to = axis == 0 ? d.x : axis == 1 ? d.y : d.z)
          agrees = prescribe(node, axis, *to, key + ".displacement");
  }
  for (const auto& [name, contact] : config.contacts) {
    const std::string key = fmt::format("contacts.{}", name);
    RigidContact rigid{name, contact.rigid, contact.friction, composer.nodes(contact.on, key + ".on"), {}};
    if (auto* facets = std::get_if<Facets>(&rigid.shape)) {
      SurfaceFile file = read_surface(facets->file.path);
      for (Vec3& p : file.points) p = facets->scale * p + vec(facets->move);
      facets->tree = std::make_shared<TriangleTree>(Triangles{std::move(file.points), std::move(file.corners)});
    }
    for (const WaypointConfig& w : contact.motion) {
      rigid.motion.push_back({w.t, Vec3(w.to[0], w.to[1], w.to[2])});
      scene.stops.push_back(w.t);
    }
    for (int node : rigid.nodes)
      if (const double g = shape_at(rigid.shape, mesh.X[node]).gap; g < -1e-9) {
        const Vec3& X = mesh.X[node];
        composer.errors.push_back({where(key + ".rigid"), key + ".rigid",
                                   fmt::format("starts {:.3g} mm inside the body at ({:g}, {:g}, {:g})", -g, X[0], X[1], X[2]),
                                   "a start outside the body or touching it", "the indenter moves in from there by `motion`"});
        break;
      }
    scene.contacts.push_back(std::move(rigid));
  }
  if (!config.fibre_angles.empty()) {
    if (config.fibre_angles.size() != material.fibres.size())
      composer.errors.push_back({where("fibre_angles"), "fibre_angles",
                                 fmt::format("found {} angles", config.fibre_angles.size()),
                                 fmt::format("{}, one for each fibre family of the material", material.fibres.size()), ""});
    else
      for (std::size_t k = 0; k < material.fibres.size(); ++k) material.fibres[k].alpha_deg = config.fibre_angles[k];
  }
  if (!composer.errors.empty()) throw Failure(Exit::config, composer.errors);
  std::erase_if(material.fibres, [](const Fibre& f) { return f.hgo.c1 == 0; });  // c1 = 0: no fibre code runs
  scene.material = std::move(material);
  scene.dofs = number_dofs(mesh.n_nodes(), std::move(prescribed)).dofs;
  return scene;
}

}  // namespace langer
