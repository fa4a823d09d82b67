#include "scene/model/scene_symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/base/text.hpp"
#include "mechanics/element/solid.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/mirror_image.hpp"
#include "mechanics/mesh/section.hpp"
#include "scene/model/bond_records.hpp"
#include "scene/model/scene_image.hpp"
#include "scene/model/scene_motion.hpp"
#include "scene/model/scene_section.hpp"

namespace langer {

namespace {

// A symmetry by its name and by the signs that it gives to x, y and z about the centre.
struct Operation {
  const char* name;
  Vec3 signs;
};
const Operation mirror_x{"mirror x", {-1, 1, 1}}, mirror_y{"mirror y", {1, -1, 1}},
    mirror_z{"mirror z", {1, 1, -1}}, half_turn{"half turn about y", {-1, 1, -1}};

// The groups that are tried for a choice, each by its generators: the first that the scene has is
// used, so larger groups come first.
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
      return {{mirror_x, mirror_z, mirror_y},
              {mirror_x, mirror_z},
              {half_turn, mirror_y},
              {mirror_x, mirror_y},
              {mirror_z, mirror_y},
              {half_turn},
              {mirror_x},
              {mirror_z},
              {mirror_y}};
  }
  return {};
}

}  // namespace

namespace {

// a symmetry of mesh and scene
struct Generator {
  Operation operation;
  Symmetry mesh;
  std::vector<int> contact;  // image of each
};

// Why surfaces that touch each other are solved as a whole; empty: a mirror plane divides them.
// Facets across a plane or an axis would touch images of others.
std::string undivided(const Symmetry& g, const Scene& scene) {
  if (scene.motion) return "surfaces that touch in motion";
  if (g.signs.prod() > 0) return "surfaces that touch at the axis";
  for (std::size_t e = 0; e < g.cell.size(); ++e) {
    if (g.cell[e] == static_cast<int>(e))
      return "the surfaces that touch: cells cross the plane, which an even number of divisions avoids";
  }
  return "";
}

// by name, each looked for once
class Found {
 public:
  Found(const Mesh& mesh, const Scene& scene, const Scene* varied, const Vec3& centre)
      : mesh_(mesh), scene_(scene), varied_(varied), centre_(centre) {}
  const Generator* operator()(const Operation& op) {
    const auto known = known_.find(op.name);
    if (known != known_.end()) {
      if (known->second) return &*known->second;
      return nullptr;
    }
    std::optional<Generator>& found = known_[op.name];
    if (op.signs == mirror_y.signs && !held_alike_above_and_below()) return nullptr;
    auto g = find_symmetry(mesh_, op.signs, centre_);
    const auto image_in = [&](const Scene& scene) {
      return image_of({g->signs.asDiagonal(), g->centre, g->node, g->cell}, mesh_, scene, scene);
    };
    SceneImage image = g ? image_in(scene_) : SceneImage{"the mesh", {}};
    if (image.broken.empty() && !scene_.surfaces.empty()) image.broken = undivided(*g, scene_);
    if (image.broken.empty() && scene_.motion && !keeps_motion(op.signs, *scene_.motion))
      image.broken = "gravity, or the velocity or spin at the beginning";
    if (image.broken.empty() && varied_)
      if (const SceneImage other = image_in(*varied_); !other.broken.empty())
        image.broken = other.broken + ", where the numbers of `sensitivity` are others";
    if (!image.broken.empty())
      append(breaks_, "; ", fmt::format("{} is not its own image: {}", op.name, image.broken));
    else
      found = Generator{op, std::move(*g), std::move(image.contact)};
    if (found) return &*found;
    return nullptr;
  }
  const std::string& breaks() const { return breaks_; }

 private:
  // Most bodies lie on something. They have no mirror along y, which is seen before their nodes are
  // compared.
  bool held_alike_above_and_below() const {
    int more_above = 0;
    for (const Prescribed& p : scene_.dofs.prescribed) {
      const double height = mesh_.X[static_cast<std::size_t>(p.dof / 3)][1] - centre_[1];
      if (height > 0) ++more_above;
      if (height < 0) --more_above;
    }
    return more_above == 0;
  }

  const Mesh& mesh_;
  const Scene& scene_;
  const Scene* varied_;
  const Vec3 centre_;
  std::map<std::string, std::optional<Generator>> known_;
  std::string breaks_;
};

// The movement of the place half way between the ends of a body that is pulled at one of them, by
// axis. Nothing where there is none, or where something else says where the body is in space:
// indenters, inertia, sets that turn.
std::vector<Prescribed> half_way(const Scene& scene) {
  std::vector<Prescribed> all;
  const bool free = scene.contacts.empty() && scene.surfaces.empty() && !scene.motion;
  const bool by_volume = std::ranges::any_of(
      scene.loads, [](const SurfaceLoad& load) { return load.volume.has_value(); });
  if (!free || by_volume) return all;
  for (int axis = 0; axis < 3; ++axis) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    const Prescribed* moved = nullptr;
    for (const Prescribed& p : scene.dofs.prescribed) {
      if (p.turn) return {};
      if (p.dof % 3 != axis) continue;
      lowest = std::min(lowest, p.value);
      highest = std::max(highest, p.value);
      if (p.value == 0) continue;
      if (moved && !same_factor(moved->factor, p.factor)) return {};
      moved = &p;
    }
    if (!moved) continue;
    const double middle = 0.5 * (lowest + highest);
    if (std::abs(middle) > 1e-12 * (highest - lowest)) all.push_back({axis, middle, moved->factor});
  }
  return all;
}

// The scene as it is seen from a place that moves.
Scene seen_from(const std::vector<Prescribed>& translation, const Scene& scene) {
  Scene seen = scene;
  for (Prescribed& p : seen.dofs.prescribed)
    for (const Prescribed& place : translation) {
      if (p.dof % 3 != place.dof) continue;
      p.value -= place.value;
      p.factor = place.factor;
    }
  return seen;
}

// images of the contacts by all products of the generators, in the order of group_of
std::vector<std::vector<int>> contact_group(const std::vector<const Generator*>& generators,
                                            std::size_t n_contacts) {
  std::vector<std::vector<int>> group(1, std::vector<int>(n_contacts));
  std::iota(group[0].begin(), group[0].end(), 0);
  for (const Generator* g : generators)
    for (std::size_t i = 0, n = group.size(); i < n; ++i) {
      std::vector<int> product = group[i];
      for (int& contact : product) contact = g->contact[contact];
      group.push_back(std::move(product));
    }
  return group;
}

// where a number is in an ascending list that has it
std::size_t place_of(int number, const std::vector<int>& ascending) {
  return static_cast<std::size_t>(std::ranges::lower_bound(ascending, number) - ascending.begin());
}

}  // namespace

std::optional<ReducedScene> ReducedScene::find(
    SymmetryChoice wanted, const Mesh& mesh, const Scene& scene,
    const std::function<Place(const std::string&)>& where, const Scene* varied, Seen seen) {
  if (mesh.section) return of_section(mesh, scene);
  if (wanted == SymmetryChoice::none) return std::nullopt;
  const Vec3 centre = bounding_box(mesh.X).middle();
  Found found(mesh, scene, varied, centre);
  // Derivatives by a displacement would need those of the place.
  std::vector<Prescribed> translation;
  if (!varied && seen == Seen::from_half_way) translation = half_way(scene);
  std::optional<Scene> moving;  // a copy, where there is something to see
  std::optional<Found> found_moving;
  if (!translation.empty())
    found_moving.emplace(mesh, moving.emplace(seen_from(translation, scene)), nullptr, centre);
  for (const auto& operations : operations(wanted)) {
    const auto all_of = [&](Found& found) {
      std::vector<const Generator*> generators;
      for (const Operation& op : operations)
        if (const Generator* g = found(op)) generators.push_back(g);
      return generators;
    };
    std::vector<const Generator*> generators = all_of(found);
    const bool at_rest = generators.size() == operations.size();
    if (!at_rest && found_moving) generators = all_of(*found_moving);
    if (generators.size() < operations.size()) continue;
    ReducedScene r;
    if (!at_rest) r.translation_ = translation;
    std::vector<Symmetry> of_mesh;
    for (const Generator* g : generators) {
      of_mesh.push_back(g->mesh);
      append(r.words_, " and ", std::string(g->operation.name));
      r.generators_.push_back(g->mesh.signs);
      r.centre_ = g->mesh.centre;
      for (int k = 0; k < 3; ++k)
        if (g->mesh.signs[k] < 0) r.kept_directions_[k] = 0;
    }
    r.take_part(mesh, at_rest ? scene : *moving, of_mesh,
                contact_group(generators, scene.contacts.size()));
    std::string place = fmt::format("{:g}, {:g}", centre[0], centre[2]);
    if (operations.back().signs == mirror_y.signs)
      place = fmt::format("{:g}, {:g}, {:g}", centre[0], centre[1], centre[2]);
    r.words_ += fmt::format(" through ({}): {} of {} cells", place, r.quotient_.cell.size(),
                            mesh.n_cells());
    return r;
  }
  if (wanted == SymmetryChoice::automatic) return std::nullopt;
  throw Failure(Exit::config,
                Error{where("symmetry"), "symmetry", found.breaks(), "a scene with this symmetry",
                      "symmetry: auto takes what there is"});
}

// The part of the scene that is solved: one element and one node of each set of images, with the
// supports, loads and contacts that act there.
void ReducedScene::take_part(const Mesh& mesh, const Scene& scene,
                             const std::vector<Symmetry>& generators,
                             const std::vector<std::vector<int>>& contacts) {
  quotient_ = quotient(mesh, generators);
  breaking_ties_ = symmetry_breaking_ties(mesh, generators, quotient_);
  scene_.formulation = scene.formulation;
  scene_.materials = scene.materials;
  scene_.stops = scene.stops;
  scene_.motion = scene.motion;
  scene_.motion_step = scene.motion_step;
  scene_.motion_error = scene.motion_error;
  scene_.directions = scene.directions.of_cells(quotient_.cell);
  take_supports(scene);
  take_loads(scene);
  const std::vector<Symmetry> group = group_of(mesh, generators);
  find_turned_families(mesh, scene, group);
  for (const auto& images : contacts)
    for (std::size_t c = 0; c < images.size(); ++c)
      swaps_indenters_ = swaps_indenters_ || images[c] != static_cast<int>(c);
  // Of the pairs of an indenter and a node that are images of each other one is kept: at the node
  // that is kept, the first indenter.
  take_contacts(scene, [&](int contact, int node) {
    Touch kept{static_cast<int>(scene.contacts.size()), quotient_.node_image[node].of,
               Mat3::Identity(), 0};
    const int at = quotient_.node[kept.node];
    for (std::size_t h = 0; h < group.size(); ++h)
      if (group[h].node[node] == at && contacts[h][contact] < kept.contact) {
        kept.contact = contacts[h][contact];
        kept.T = group[h].signs.asDiagonal();
      }
    int in_place = 0;
    Vec3 allowed =
        Vec3::Ones();  // what leaves the pair in place and changes a sign forbids that direction
    for (std::size_t h = 0; h < group.size(); ++h)
      if (group[h].node[at] == at && contacts[h][kept.contact] == kept.contact) {
        ++in_place;
        for (int k = 0; k < 3; ++k)
          if (group[h].signs[k] < 0) allowed[k] = 0;
      }
    kept.T = kept.T * allowed.asDiagonal();
    kept.share = static_cast<double>(group.size()) / in_place;
    return kept;
  });
  take_surfaces(scene);
}

// Surfaces that touch each other: the facets of kept cells. No cell crosses a plane, so these are
// the facets all of whose nodes are kept.
void ReducedScene::take_surfaces(const Scene& scene) {
  surfaces_ = scene.surfaces;
  std::map<int, int> kept;  // node of the whole -> of the part
  for (std::size_t i = 0; i < quotient_.node.size(); ++i)
    kept[quotient_.node[i]] = static_cast<int>(i);
  const auto kept_facets = [&](const std::vector<QuadNodes>& side) {
    std::vector<QuadNodes> out;
    for (QuadNodes facet : side) {
      if (!std::ranges::all_of(facet, [&](int node) { return kept.contains(node); })) continue;
      for (int& node : facet) node = kept.at(node);
      out.push_back(facet);
    }
    return out;
  };
  const auto kept_nodes = [&](const std::vector<int>& nodes) {
    std::vector<int> out;
    for (int node : nodes)
      if (kept.contains(node)) out.push_back(kept.at(node));
    std::ranges::sort(out);
    return out;
  };
  for (const SurfaceContact& whole : surfaces_) {
    SurfaceContact& part = scene_.surfaces.emplace_back(whole);
    part.own = kept_facets(whole.own);
    part.other = kept_facets(whole.other);
    part.nodes = kept_nodes(whole.nodes);
    part.all_nodes = kept_nodes(whole.all_nodes);
    part.images = quotient_.cell_share.front();
    part.area.clear();
    part.mirrors.clear();
    for (int node : part.nodes) {
      const auto n = static_cast<std::size_t>(node);
      const auto at = place_of(quotient_.node[n], whole.nodes);
      std::array<bool, 3> across{};
      if (!whole.mirrors.empty()) across = whole.mirrors[at];
      for (int k = 0; k < 3; ++k)
        if (quotient_.tie[n].T(k, k) == 0) across[static_cast<std::size_t>(k)] = true;
      part.mirrors.push_back(across);
      if (whole.adhesion) part.area.push_back(quotient_.node_share[n] * whole.area[at]);
    }
  }
}

// A support holds the node that is kept. Directions in which symmetry allows no movement need no
// support.
void ReducedScene::take_supports(const Scene& scene) {
  const Quotient& q = quotient_;
  std::vector<Prescribed> prescribed;
  for (const Prescribed& p : scene.dofs.prescribed) {
    const Image& image = q.node_image[p.dof / 3];
    if (q.node[image.of] != p.dof / 3) continue;
    const int dof = 3 * image.of + p.dof % 3;
    held_.push_back(dof);
    if (image.T(p.dof % 3, p.dof % 3) == 0) continue;
    prescribed.push_back(p);
    prescribed.back().dof = dof;
  }
  scene_.dofs = number_dofs(q.mesh.n_nodes(), std::move(prescribed), q.tie, q.mesh.hanging).dofs;
}

// Movements that change their sign in the image, one numbering for each kind. The stability of the
// whole body needs them: a body may buckle into a shape that is not symmetric.
std::vector<Dofs> ReducedScene::symmetry_breaking_dofs() const {
  std::vector<Prescribed> held;
  for (int dof : held_) held.push_back({dof, 0});
  std::vector<Dofs> kinds;
  for (const std::vector<Image>& ties : breaking_ties_) {
    kinds.push_back(number_dofs(quotient_.mesh.n_nodes(), held, ties, quotient_.mesh.hanging).dofs);
  }
  return kinds;
}

std::vector<Vec3> ReducedScene::whole_movement(const Mesh& whole, const VecX& u, int kind) const {
  std::vector<Vec3> out;
  out.reserve(whole.X.size());
  for (std::size_t i = 0; i < whole.X.size(); ++i) {
    const Image& image = quotient_.node_image[i];
    const Vec3 kept = u.segment<3>(3 * static_cast<Eigen::Index>(image.of));
    if (kind == 0 || generators_.empty()) {
      out.push_back(image.T * kept);
      continue;
    }
    // Which generators take the kept node to this one: those that change the side it is on.
    const Vec3 from = quotient_.mesh.X[static_cast<std::size_t>(image.of)] - centre_;
    const Vec3 to = whole.X[i] - centre_;
    Vec3 signs = Vec3::Ones();
    double sign = 1;
    for (std::size_t g = 0; g < generators_.size(); ++g) {
      const Vec3 other = generators_[g];
      int axis = 0;
      double farthest = 0;
      for (int k = 0; k < 3; ++k) {
        if (other[k] > 0 || std::abs(from[k]) <= farthest) continue;
        axis = k;
        farthest = std::abs(from[k]);
      }
      if (from[axis] * to[axis] >= 0) continue;
      signs = signs.cwiseProduct(other);
      if ((kind >> g & 1) != 0) sign = -sign;
    }
    out.push_back(sign * signs.cwiseProduct(kept));
  }
  for (const HangingNode& h : whole.hanging) {
    Vec3 mean = Vec3::Zero();
    for (int n : h.of) mean += 0.25 * out[static_cast<std::size_t>(n)];
    out[static_cast<std::size_t>(h.node)] = mean;
  }
  return out;
}

// facets of kept cells: a cell's share counts theirs
void ReducedScene::take_loads(const Scene& scene) {
  std::map<int, int> kept;
  for (std::size_t e = 0; e < quotient_.cell.size(); ++e)
    kept[quotient_.cell[e]] = static_cast<int>(e);
  for (const SurfaceLoad& whole : scene.loads) {
    SurfaceLoad part = whole;
    part.facets.clear();
    for (const Facet& facet : whole.facets)
      if (const auto at = kept.find(facet.cell); at != kept.end())
        part.facets.push_back({at->second, facet.local});
    scene_.loads.push_back(std::move(part));
  }
}

// First the candidates that are kept, then for each candidate of the whole body the kept one whose
// image it is.
void ReducedScene::take_contacts(const Scene& scene,
                                 const std::function<Touch(int, int)>& stands_for) {
  contacts_ = scene.contacts;
  std::map<std::array<int, 2>, CandidateImage>
      index;  // by contact of the whole body and node of the part
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    const RigidContact& whole = contacts_[c];
    RigidContact part = whole;
    part.nodes.clear();
    part.area.clear();
    std::vector<double> share;
    std::vector<std::array<int, 2>> origin;
    for (int i = 0; i < static_cast<int>(whole.nodes.size()); ++i) {
      const Touch kept = stands_for(c, whole.nodes[i]);
      if (kept.contact != c || quotient_.node[kept.node] != whole.nodes[i]) continue;
      index[{c, kept.node}] = {
          static_cast<int>(scene_.contacts.size()), static_cast<int>(part.nodes.size()), {}};
      part.nodes.push_back(kept.node);
      share.push_back(kept.share);
      origin.push_back({c, i});
      if (whole.adhesion) part.area.push_back(kept.share * whole.area[i]);
    }
    if (part.nodes.empty() && !whole.nodes.empty()) continue;  // another indenter stands for it
    scene_.contacts.push_back(std::move(part));
    candidate_share_.push_back(std::move(share));
    origin_.push_back(std::move(origin));
  }
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    std::vector<CandidateImage>& images = candidate_.emplace_back();
    for (int node : contacts_[c].nodes) {
      const Touch kept = stands_for(c, node);
      images.push_back(index.at({kept.contact, kept.node}));
      images.back().T = kept.T;
    }
  }
}

// Where families change places in a mirror, the first one of a cell is another in the cell that
// stands for it.
void ReducedScene::find_turned_families(const Mesh& mesh, const Scene& scene,
                                        const std::vector<Symmetry>& group) {
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto own = scene.directions.of(e);
    const auto kept = scene_.directions.of(quotient_.cell_image[e]);
    if (own.empty()) continue;
    std::optional<Vec3> turned;
    bool same = false;
    for (const Symmetry& g : group) {
      if (g.cell[e] != quotient_.cell[quotient_.cell_image[e]]) continue;
      const Vec3 a = g.signs.cwiseProduct(own[0]);
      if (!turned) turned = a;
      same = same || std::min((a - kept[0]).norm(), (a + kept[0]).norm()) <= same_place;
    }
    if (!same && turned) turned_.push_back({e, quotient_.cell_image[e], *turned});
  }
}

// A section is a part, too: it has one element through its thickness or angle, whose nodes behind
// follow those in front.
ReducedScene ReducedScene::of_section(const Mesh& mesh, const Scene& scene) {
  ReducedScene r;
  r.words_ = section_words(mesh);
  Quotient& q = r.quotient_;
  q.mesh = mesh;
  q.tie = q.node_image = section_ties(mesh);
  q.node.resize(mesh.X.size());
  q.cell.resize(mesh.n_cells());
  std::iota(q.node.begin(), q.node.end(), 0);
  std::iota(q.cell.begin(), q.cell.end(), 0);
  q.cell_image = q.cell;
  q.cell_share.assign(q.cell.size(), langer::cell_share(*mesh.section));
  q.node_share.assign(q.node.size(), 0);
  for (int i = 0; i < n_front(mesh); ++i) q.node_share[i] = 1;
  r.scene_ = scene;
  r.scene_.contacts.clear();
  std::vector<Prescribed> prescribed;
  for (const Prescribed& p : scene.dofs.prescribed)
    if (q.tie[p.dof / 3].T(p.dof % 3, p.dof % 3) != 0) prescribed.push_back(p);
  r.scene_.dofs = number_dofs(mesh.n_nodes(), std::move(prescribed), q.tie).dofs;
  r.take_contacts(scene, [&q](int contact, int node) {
    const Image& image = q.node_image[node];
    return Touch{contact, image.of, image.T, q.node_share[image.of]};
  });
  if (mesh.section->of == SectionOf::axisymmetric) {
    r.kept_directions_ = Vec3(0, 1, 0);
  } else {
    r.kept_directions_ = Vec3(1, 1, 0);
  }
  return r;
}

// How far the place from which the part is seen has moved at t.
Vec3 ReducedScene::translation_at(double t) const {
  Vec3 moved = Vec3::Zero();
  for (const Prescribed& p : translation_) moved[p.dof] = p.at(t);
  return moved;
}

// The step of the whole body. Displacements and forces are turned to the place of the image; a
// force is divided among the images, since the part carries those of all of them.
StepRecord ReducedScene::whole(const StepRecord& reduced) const {
  StepRecord record = reduced;
  record.u.clear();
  record.reaction.clear();
  const bool section = quotient_.mesh.section.has_value();
  const Vec3 moved = translation_at(load_factor_of(reduced));
  for (const Image& image : quotient_.node_image) {
    const bool behind =
        section &&
        image.of != static_cast<int>(record.u.size());  // those in z = 0 have all of the force
    record.u.push_back(image.T * reduced.u[image.of] + moved);
    record.reaction.push_back(
        behind ? Vec3::Zero()
               : Vec3(image.T * reduced.reaction[image.of] / quotient_.node_share[image.of]));
  }
  for (auto& [name, values] : record.point_fields) {
    const std::vector<Vec3>& kept = reduced.point_fields.at(name);
    values.clear();
    for (const Image& image : quotient_.node_image) values.push_back(image.T * kept[image.of]);
  }
  for (auto& [name, values] : record.cell_fields) {
    const std::vector<double>& kept = reduced.cell_fields.at(name);
    values.clear();
    for (int cell : quotient_.cell_image) values.push_back(kept[cell]);
  }
  update_turned_families(reduced, record);
  expand_contacts(reduced, record);
  expand_surfaces(reduced, record);
  if (const auto found = record.scalars.find("weakest_cell");
      found != record.scalars.end() && found->second >= 0)
    found->second = quotient_.cell[static_cast<std::size_t>(found->second)];
  return record;
}

// Contact forces of the whole body, node by node, and their sum on each indenter.
void ReducedScene::expand_contacts(const StepRecord& reduced, StepRecord& record) const {
  record.force_ind = kept_directions_.cwiseProduct(reduced.force_ind);
  if (!contacts_.empty()) {
    const auto travel = record.scalars.find("travel_" + contacts_[0].name);
    record.u_ind = indenter_displacement(contacts_[0], load_factor_of(record),
                                         travel == record.scalars.end() ? 0 : travel->second);
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    ContactRecord& contact = record.contacts[contacts_[c].name] = {};
    for (const CandidateImage& image : candidate_[c]) {
      const ContactRecord& kept = reduced.contacts.at(scene_.contacts[image.contact].name);
      const auto of = static_cast<std::size_t>(image.of);
      append_image(kept, of, image.T, candidate_share_[image.contact][of], contact);
    }
    if (contacts_.size() < 2 && surfaces_.empty()) continue;
    Vec3 force = Vec3::Zero();
    for (const Vec3& r : contact.r) force -= r;
    for (const Vec3& pull : contact.adhesive) force -= pull;
    for (int k = 0; k < 3; ++k) {
      const std::string name = "force_" + contacts_[c].name + "_" + "xyz"[k];
      // on a section radial forces of the whole circle add up to nothing
      if (quotient_.mesh.section) {
        record.scalars[name] = kept_directions_[k] * reduced.scalars.at(name);
      } else {
        record.scalars[name] = force[k];
      }
    }
  }
}

// Adds the image of a candidate: r, status, gap, and its bond. share: how many it stands for.
void ReducedScene::append_image(const ContactRecord& kept, std::size_t of, const Mat3& T,
                                double share, ContactRecord& images) {
  images.r.push_back(T * kept.r[of] / share);
  images.status.push_back(kept.status[of]);
  images.gap.push_back(kept.gap[of]);
  if (kept.beta.empty()) return;
  images.beta.push_back(kept.beta[of]);
  images.bonded_at.push_back(T * kept.bonded_at[of]);
  images.adhesive.push_back(T * kept.adhesive[of] / share);
}

// The same for surfaces that touch each other. Forces on them are sums over all images.
void ReducedScene::expand_surfaces(const StepRecord& reduced, StepRecord& record) const {
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const std::string& name = surfaces_[s].name;
    const ContactRecord& kept = reduced.contacts.at(name);
    const std::vector<int>& candidates = scene_.surfaces[s].nodes;
    ContactRecord& contact = record.contacts[name] = {};
    for (int node : surfaces_[s].nodes) {
      const Image& image = quotient_.node_image[static_cast<std::size_t>(node)];
      append_image(kept, place_of(image.of, candidates), image.T,
                   quotient_.node_share[static_cast<std::size_t>(image.of)], contact);
    }
    Vec3 force = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      double& component = record.scalars.at("force_" + name + "_" + "xyz"[k]);
      component *= kept_directions_[k];
      force[k] = component;
    }
    const auto size = record.scalars.find("force_" + name);
    if (size != record.scalars.end()) size->second = force.norm();
  }
}

// The element that is kept has its families in another order than its image: the mean of I4_bar is
// computed again with the direction that the first family of the image has.
void ReducedScene::update_turned_families(const StepRecord& reduced, StepRecord& record) const {
  const auto I4_bar = record.cell_fields.find("I4_bar");
  if (I4_bar == record.cell_fields.end()) return;
  const Mesh& mesh = quotient_.mesh;
  for (const TurnedFamily& family : turned_) {
    const auto nodes = mesh.cell(family.of);
    ElementNodes u(nodes.size(), 3);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Image& tie = quotient_.tie[nodes[a]];
      u.row(static_cast<Eigen::Index>(a)) = (tie.T * reduced.u[tie.of]).transpose();
    }
    const auto states = gauss_states(
        scene_.formulation, scene_.materials[mesh.body.empty() ? 0 : mesh.body[family.of]],
        element_geometry(element_nodes(mesh, family.of)), scene_.directions.of(family.of), u);
    I4_bar->second[family.cell] = mean_I4_bar(states, family.a);
  }
}

// The state of the part from a recorded step, with which a stopped run continues.
BodyState ReducedScene::reduced(const StepRecord& whole) const {
  BodyState state;
  state.t = whole.t;
  const Vec3 moved = translation_at(load_factor_of(whole));
  state.u = VecX::Zero(3 * static_cast<Eigen::Index>(quotient_.node.size()));
  for (std::size_t i = 0; i < quotient_.node.size(); ++i)
    if (quotient_.tie[i].of == static_cast<int>(i))
      state.u.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          whole.u[static_cast<std::size_t>(quotient_.node[i])] - moved;
  if (scene_.motion) {
    const auto kept = [&](const std::vector<Vec3>& of_whole, bool shared) {
      VecX out = VecX::Zero(state.u.size());
      for (std::size_t i = 0; i < quotient_.node.size(); ++i) {
        if (quotient_.tie[i].of != static_cast<int>(i)) continue;
        const double share = shared ? quotient_.node_share[i] : 1;
        out.segment<3>(3 * static_cast<Eigen::Index>(i)) =
            share * of_whole[static_cast<std::size_t>(quotient_.node[i])];
      }
      return out;
    };
    state.motion = recorded_motion(whole, kept);
  }
  for (std::size_t c = 0; c < origin_.size(); ++c) {
    std::vector<Vec3>& r = state.r.emplace_back();
    for (std::size_t i = 0; i < origin_[c].size(); ++i) {
      const auto& [contact, candidate] = origin_[c][i];
      r.push_back(candidate_share_[c][i] * whole.contacts.at(contacts_[contact].name).r[candidate]);
    }
    const RigidContact& contact = scene_.contacts[c];
    if (contact.control) state.travel = whole.scalars.at("travel_" + contact.name);
    if (!whole.scalars.count("adhesion_stored")) continue;
    std::vector<Bond>& bonds = state.bonds.emplace_back();
    for (const auto& [of, candidate] : origin_[c])
      if (const ContactRecord& record = whole.contacts.at(contacts_[of].name); !record.beta.empty())
        bonds.push_back(bond_of(record, static_cast<std::size_t>(candidate)));
  }
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const ContactRecord& of_whole = whole.contacts.at(surfaces_[s].name);
    std::vector<Vec3>& r = state.r.emplace_back();
    std::vector<Bond> bonds;
    for (int node : scene_.surfaces[s].nodes) {
      const auto n = static_cast<std::size_t>(node);
      const auto at = place_of(quotient_.node[n], surfaces_[s].nodes);
      r.push_back(quotient_.node_share[n] * of_whole.r[at]);
      if (!of_whole.beta.empty()) bonds.push_back(bond_of(of_whole, at));
    }
    if (whole.scalars.contains("adhesion_stored")) state.bonds.push_back(std::move(bonds));
  }
  state.in_bonds = bond_energies(whole);
  return state;
}

}  // namespace langer
