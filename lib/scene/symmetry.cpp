#include "scene/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mesh/section.hpp"
#include "scene/section.hpp"

namespace langer {

namespace {

constexpr double same = same_place;

struct Operation {
  const char* name;
  Vec3 signs;
  Isometry about(const Vec3& centre) const { return {signs.asDiagonal(), centre}; }
};
const Operation mirror_x{"mirror x", {-1, 1, 1}}, mirror_z{"mirror z", {1, 1, -1}}, half_turn{"half turn about y", {-1, 1, -1}};

// What of the scene is not its own image; empty where nothing.
std::string broken(const Operation& op, const Symmetry& g, const Mesh& mesh, const Scene& scene) {
  const bool fibrous = scene.families() > 0;
  for (int e = 0; e < mesh.n_cells() && fibrous; ++e) {
    const auto a = scene.directions.of(e), b = scene.directions.of(g.cell[e]);
    const std::vector<Fibre>& families = scene.materials[mesh.body.empty() ? 0 : mesh.body[e]].fibres;
    for (std::size_t k = 0; k < a.size(); ++k)
      if (const Vec3 turned = op.signs.cwiseProduct(a[k]);
          acts(families[k]) && std::min((turned - b[k]).norm(), (turned + b[k]).norm()) > same)
        return fmt::format("the fibres of cells {} and {}", e, g.cell[e]);
  }
  std::map<int, double> imposed;
  for (const Prescribed& p : scene.dofs.prescribed) imposed[p.dof] = p.value;
  for (const auto& [dof, value] : imposed) {
    const auto other = imposed.find(3 * g.node[dof / 3] + dof % 3);
    if (other == imposed.end() || std::abs(other->second - op.signs[dof % 3] * value) > same * std::abs(value))
      return fmt::format("what holds or moves node {} along {}", dof / 3, "xyz"[dof % 3]);
  }
  for (const RigidContact& contact : scene.contacts) {
    if (!unchanged_by(contact.shape, op.about(g.centre)))
      return fmt::format("the shape or place of the indenter \"{}\"", contact.name);
    for (const Waypoint& w : contact.motion)
      if (!keeps_direction(w.u_ind, op.about(g.centre))) return fmt::format("the path of the indenter \"{}\"", contact.name);
    std::vector<char> candidate(mesh.X.size(), 0);
    for (int node : contact.nodes) candidate[node] = 1;
    for (int node : contact.nodes)
      if (!candidate[g.node[node]]) return fmt::format("the nodes that may touch \"{}\"", contact.name);
  }
  return "";
}

std::vector<std::vector<Operation>> operations(SymmetryChoice wanted) {
  switch (wanted) {
    case SymmetryChoice::none:
      return {};
    case SymmetryChoice::mirror_x:
      return {{mirror_x}};
    case SymmetryChoice::mirror_z:
      return {{mirror_z}};
    case SymmetryChoice::quarter:
      return {{mirror_x, mirror_z}};
    case SymmetryChoice::half_turn:
      return {{half_turn}};
    case SymmetryChoice::automatic:
      return {{mirror_x, mirror_z}, {half_turn}, {mirror_x}, {mirror_z}};
  }
  return {};
}

}  // namespace

std::optional<ReducedScene> ReducedScene::find(SymmetryChoice wanted, const Mesh& mesh, const Scene& scene,
                                               const std::function<Place(const std::string&)>& where) {
  if (mesh.section) return of_section(mesh, scene);
  if (wanted == SymmetryChoice::none) return std::nullopt;
  Vec3 low = mesh.X[0], high = mesh.X[0];
  for (const Vec3& X : mesh.X) low = low.cwiseMin(X), high = high.cwiseMax(X);
  const Vec3 centre = 0.5 * (low + high);
  std::map<std::string, std::optional<Symmetry>> known;
  std::map<std::string, std::string> breaks;
  const auto holds = [&](const Operation& op) {
    if (const auto found = known.find(op.name); found != known.end()) return found->second.has_value();
    auto g = find_symmetry(mesh, op.signs, centre);
    std::string why = g ? broken(op, *g, mesh, scene) : "the mesh";
    if (!why.empty()) g.reset(), breaks[op.name] = why;
    return (known[op.name] = std::move(g)).has_value();
  };
  for (const auto& group : operations(wanted)) {
    if (!std::all_of(group.begin(), group.end(), holds)) continue;
    ReducedScene r;
    std::vector<Symmetry> generators;
    for (const Operation& op : group) {
      generators.push_back(*known[op.name]);
      r.words_ += (r.words_.empty() ? "" : " and ") + std::string(op.name);
      for (int k = 0; k < 3; ++k)
        if (op.signs[k] < 0) r.kept_directions_[k] = 0;
    }
    Quotient& q = r.quotient_ = quotient(mesh, generators);
    r.words_ += fmt::format(" through ({:g}, {:g}): {} of {} cells", centre[0], centre[2], q.cell.size(), mesh.n_cells());

    r.scene_.formulation = scene.formulation, r.scene_.materials = scene.materials, r.scene_.stops = scene.stops;
    r.scene_.directions = scene.directions.of_cells(q.cell);
    std::vector<Prescribed> prescribed;
    for (const Prescribed& p : scene.dofs.prescribed) {
      const Image& image = q.node_image[p.dof / 3];
      if (q.node[image.of] == p.dof / 3 && image.T(p.dof % 3, p.dof % 3) != 0)
        prescribed.push_back({3 * image.of + p.dof % 3, p.value});
    }
    r.scene_.dofs = number_dofs(q.mesh.n_nodes(), std::move(prescribed), q.tie).dofs;
    for (const RigidContact& contact : scene.contacts) r.take_contact(contact);
    return r;
  }
  if (wanted == SymmetryChoice::automatic) return std::nullopt;
  std::string why;
  for (const auto& [name, what] : breaks) why += (why.empty() ? "" : "; ") + fmt::format("{} is not its own image: {}", name, what);
  throw Failure(Exit::config,
                Error{where("symmetry"), "symmetry", why, "a scene with this symmetry", "symmetry: auto takes what there is"});
}

void ReducedScene::take_contact(const RigidContact& contact) {
  const Quotient& q = quotient_;
  RigidContact part{contact.name, contact.shape, contact.mu, {}, contact.motion};
  std::map<int, int> index;  // of a kept node among the candidates
  std::vector<Image> images;
  std::vector<double> share;
  for (int node : contact.nodes)
    if (const int kept = q.node_image[node].of; q.node[kept] == node) {
      index[kept] = static_cast<int>(part.nodes.size());
      part.nodes.push_back(kept), share.push_back(q.node_share[kept]);
    }
  for (int node : contact.nodes) images.push_back({index.at(q.node_image[node].of), q.node_image[node].T});
  scene_.contacts.push_back(std::move(part));
  candidate_.push_back(std::move(images)), candidate_share_.push_back(std::move(share));
}

ReducedScene ReducedScene::of_section(const Mesh& mesh, const Scene& scene) {
  ReducedScene r;
  r.words_ = section_words(mesh);
  Quotient& q = r.quotient_;
  q.mesh = mesh, q.tie = q.node_image = section_ties(mesh);
  q.node.resize(mesh.X.size()), q.cell.resize(mesh.n_cells());
  std::iota(q.node.begin(), q.node.end(), 0);
  std::iota(q.cell.begin(), q.cell.end(), 0);
  q.cell_image = q.cell;
  q.cell_share.assign(q.cell.size(), langer::cell_share(*mesh.section));
  q.node_share.assign(q.node.size(), 0);
  for (int i = 0; i < n_front(mesh); ++i) q.node_share[i] = 1;
  r.scene_ = scene, r.scene_.contacts.clear();
  std::vector<Prescribed> prescribed;
  for (const Prescribed& p : scene.dofs.prescribed)
    if (q.tie[p.dof / 3].T(p.dof % 3, p.dof % 3) != 0) prescribed.push_back(p);
  r.scene_.dofs = number_dofs(mesh.n_nodes(), std::move(prescribed), q.tie).dofs;
  for (const RigidContact& contact : scene.contacts) r.take_contact(contact);
  r.kept_directions_ = mesh.section->of == SectionOf::axisymmetric ? Vec3(0, 1, 0) : Vec3(1, 1, 0);
  return r;
}

StepRecord ReducedScene::whole(const StepRecord& reduced) const {
  StepRecord record = reduced;
  record.u.clear(), record.reaction.clear();
  const bool section = quotient_.mesh.section.has_value();
  for (const Image& image : quotient_.node_image) {
    const bool behind = section && image.of != static_cast<int>(record.u.size());  // those in z = 0 have all of the force
    record.u.push_back(image.T * reduced.u[image.of]);
    record.reaction.push_back(behind ? Vec3::Zero() : Vec3(image.T * reduced.reaction[image.of] / quotient_.node_share[image.of]));
  }
  for (auto& [name, values] : record.cell_fields) {
    const std::vector<double>& kept = reduced.cell_fields.at(name);
    values.clear();
    for (int cell : quotient_.cell_image) values.push_back(kept[cell]);
  }
  for (std::size_t c = 0; c < scene_.contacts.size(); ++c) {
    const ContactRecord& kept = reduced.contacts.at(scene_.contacts[c].name);
    ContactRecord& contact = record.contacts.at(scene_.contacts[c].name) = {};
    for (const Image& image : candidate_[c]) {
      contact.r.push_back(image.T * kept.r[image.of] / candidate_share_[c][image.of]);
      contact.status.push_back(kept.status[image.of]);
      contact.gap.push_back(kept.gap[image.of]);
    }
    for (int k = 0; k < 3; ++k)
      if (const auto found = record.scalars.find("force_" + scene_.contacts[c].name + "_" + "xyz"[k]);
          found != record.scalars.end())
        found->second *= kept_directions_[k];
  }
  record.force_ind = kept_directions_.cwiseProduct(reduced.force_ind);
  if (const auto found = record.scalars.find("weakest_cell"); found != record.scalars.end() && found->second >= 0)
    found->second = quotient_.cell[static_cast<std::size_t>(found->second)];
  return record;
}

BodyState ReducedScene::reduced(const StepRecord& whole) const {
  BodyState state;
  state.t = whole.t;
  state.u = VecX::Zero(3 * static_cast<Eigen::Index>(quotient_.node.size()));
  for (std::size_t i = 0; i < quotient_.node.size(); ++i)
    if (quotient_.tie[i].of == static_cast<int>(i))
      state.u.segment<3>(3 * static_cast<Eigen::Index>(i)) = whole.u[static_cast<std::size_t>(quotient_.node[i])];
  for (std::size_t c = 0; c < scene_.contacts.size(); ++c) {
    std::vector<Vec3>& r = state.r.emplace_back(scene_.contacts[c].nodes.size(), Vec3::Zero());
    const std::vector<Vec3>& of_whole = whole.contacts.at(scene_.contacts[c].name).r;
    for (std::size_t i = 0; i < candidate_[c].size(); ++i) {
      const Image& image = candidate_[c][i];
      if (image.T == quotient_.tie[scene_.contacts[c].nodes[image.of]].T) r[image.of] = candidate_share_[c][image.of] * of_whole[i];
    }
  }
  return state;
}

}  // namespace langer
