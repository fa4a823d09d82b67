#include "scene/model/scene_adhesion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/element/surface.hpp"
#include "mechanics/material/at_rest.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

namespace {

// whose nodes are all candidates; of a section those in z = 0, of facets that are no plane of it
std::vector<Facet> facets_under(const Mesh& mesh, const std::vector<int>& candidates) {
  std::vector<char> may(mesh.X.size(), 0);
  for (int node : candidates) may[static_cast<std::size_t>(node)] = 1;
  std::vector<Facet> facets = boundary(mesh);
  std::erase_if(facets, [&](const Facet& facet) {
    const std::vector<int> nodes = facet_nodes(mesh, facet);
    std::vector<int> front = nodes;
    if (mesh.section) front = in_front(mesh, nodes);
    return front.empty() || (mesh.section && front.size() == nodes.size()) ||
           !std::all_of(front.begin(), front.end(),
                        [&](int node) { return may[static_cast<std::size_t>(node)] != 0; });
  });
  return facets;
}

}  // namespace

void take_adhesion(RigidContact& rigid, const ContactConfig& contact, const Mesh& mesh,
                   const std::string& key, const std::function<Place(const std::string&)>& where,
                   std::vector<Error>& errors) {
  if (!contact.adhesion || contact.adhesion->work == 0 || rigid.nodes.empty()) return;
  VecX areas = nodal_areas(mesh, facets_under(mesh, rigid.nodes));
  if (mesh.section) {
    VecX in_plane = VecX::Zero(areas.size());
    const std::vector<Image> ties = section_ties(mesh);
    for (std::size_t i = 0; i < ties.size(); ++i)
      in_plane[ties[i].of] += cell_share(*mesh.section) * areas[static_cast<Eigen::Index>(i)];
    areas = in_plane;
  }
  if (areas.isZero(0)) {
    errors.push_back({where(key + ".adhesion"), key + ".adhesion",
                      "no facet of the body has all of its nodes among those that may touch",
                      "nodes that cover facets",
                      "bonds are of areas, not of points: name a set of a face in `on`"});
    return;
  }
  rigid.adhesion = contact.adhesion;
  for (int node : rigid.nodes) rigid.area.push_back(areas[node]);
}

void take_adhesion(SurfaceContact& surface, const ContactConfig& contact, const Mesh& mesh,
                   const std::vector<Facet>& own, const std::string& key,
                   const std::function<Place(const std::string&)>& where,
                   std::vector<Error>& errors) {
  if (!contact.adhesion || contact.adhesion->work == 0) return;
  // Beyond, a bond bears less than 2 % of its greatest stress.
  const double reach = 0.25 * surface.reach;
  const double opening = std::sqrt(contact.adhesion->work / contact.adhesion->stiffness);
  if (opening > reach) {
    const std::string at = key + ".adhesion.stiffness";
    errors.push_back(
        {where(at), at,
         fmt::format(
             "bonds that open by {:.3g} mm before they give way, on facets that look {:.3g} "
             "mm far",
             opening, surface.reach),
         fmt::format("{:.3g} MPa/mm or more", contact.adhesion->work / (reach * reach)),
         "or longer facets"});
    return;
  }
  surface.adhesion = contact.adhesion;
  const VecX areas = nodal_areas(mesh, own);
  for (int node : surface.nodes) surface.area.push_back(areas[node]);
  for (const MortarNode& node : mortar_nodes(surface, positions(mesh.X)))
    surface.area[static_cast<std::size_t>(node.candidate)] = node.area;
}

BondZone bond_zone(const Adhesion& adhesion, const std::vector<int>& candidates, const Mesh& mesh,
                   const std::vector<Material>& materials) {
  BondZone zone{std::numeric_limits<double>::infinity(), 0};
  double softest = std::numeric_limits<double>::infinity();
  for (const Material& material : materials)
    softest = std::min(softest, std::abs(shear_modulus(material)));
  zone.length = 4 * softest / adhesion.stiffness;
  for (const Facet& facet : facets_under(mesh, candidates))
    for (const auto& quad : facet_quads(mesh, facet)) {
      double side = 0;
      for (std::size_t k = 0; k < 4; ++k)
        side = std::max(side, (mesh.X[quad[k]] - mesh.X[quad[(k + 1) % 4]]).norm());
      zone.cell = std::min(zone.cell, side);
    }
  return zone;
}

}  // namespace langer
