// Items of data that are scenes, and the numbers of them that a fit may find.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identification/setup/fit_config.hpp"
#include "scene/model/config_number.hpp"

namespace langer {

// Checks whether a scene has what it needs to be compared with its file.
void FitData::complain_of_homogeneous_keys(std::vector<Complaint>& all) const {
  for (const auto& [key, found] : {std::pair("strain", strain.has_value()),
                                   {"stress", stress.has_value()},
                                   {"stress_unit", stress_unit.has_value()},
                                   {"strain_unit", strain_unit.has_value()},
                                   {"width", width.has_value()},
                                   {"thickness", thickness.has_value()},
                                   {"gauge_length", gauge_length.has_value()},
                                   {"width_z", width_z.has_value()},
                                   {"gauge_length_z", gauge_length_z.has_value()},
                                   {"toe", toe.has_value()},
                                   {"strain_from", strain_from.has_value()},
                                   {"strain_to", strain_to.has_value()},
                                   {"time_from", time_from.has_value()},
                                   {"time_to", time_to.has_value()},
                                   {"compare_from", compare_from.has_value()},
                                   {"zero_at", zero_at != ZeroAt::reading},
                                   {"normalised", normalised},
                                   {"shear", shear != OffAxisShear::held},
                                   {"sign", sign.has_value()},
                                   {"strain_sign", strain_sign.has_value()},
                                   {"stress_sign", stress_sign.has_value()},
                                   {"step_at", step_at.has_value()},
                                   {"ramp", ramp.has_value()},
                                   {"ratio", ratio.has_value()},
                                   {"until", until != KeptUntil::end},
                                   {"branch", branch != KeptBranch::all},
                                   {"cycle", cycle != KeptCycle::all},
                                   {"skip_cycles", skip_cycles > 0},
                                   {"block", !block.empty()},
                                   {"name_pattern", !name_pattern.empty()},
                                   {"split", !split.empty()}})
    if (found)
      all.push_back({key, "found in a scene", "a homogeneous test, or without it",
                     "a scene does not read it"});
}

// Checks an item of kind: scene: one abscissa, forces or displacements, and where these were
// measured.
void FitData::complain_of_scene(std::vector<Complaint>& all) const {
  if (solve.path.empty())
    all.push_back({"solve", "missing", "config of langer-solve that the test is", ""});
  complain_of_wave_keys(all);
  if (weight)
    all.push_back(
        {"weight", "found in a scene", "standard_deviation, in the unit of what was measured", ""});
  complain_of_homogeneous_keys(all);
  if (!columns) {
    all.push_back({"columns", "missing", "columns of the file",
                   "columns: {u_ind: travel_mm, force: force_N}"});
    return;
  }
  const FitColumns& c = *columns;
  const auto named = [](std::initializer_list<std::pair<const char*, const std::string*>> columns) {
    std::vector<std::string> found;
    for (const auto& [key, text] : columns)
      if (!text->empty()) found.push_back(key);
    return found;
  };
  for (const std::string& key : named({{"strain_x", &c.strain_x},
                                       {"strain_z", &c.strain_z},
                                       {"stress_x", &c.stress_x},
                                       {"stress_z", &c.stress_z}}))
    all.push_back({"columns." + key, "found in a scene",
                   "u_ind, displacement, pressure, time or t, and force, reaction_x or u_x", ""});
  const std::vector<std::string> over = named({{"t", &c.t},
                                               {"time", &c.time},
                                               {"u_ind", &c.u_ind},
                                               {"displacement", &c.displacement},
                                               {"pressure", &c.pressure}});
  if (over.size() > 1)
    all.push_back({"columns." + over[1], "found together with " + over[0], "one of them", ""});
  if ((!c.displacement.empty() || !c.pressure.empty()) && moved.empty())
    all.push_back(
        {"moved", "missing", "the set whose displacement or pressure it was measured over", ""});
  const std::vector<std::string> forces = named({{"force", &c.force},
                                                 {"reaction_x", &c.reaction_x},
                                                 {"reaction_y", &c.reaction_y},
                                                 {"reaction_z", &c.reaction_z}});
  const std::vector<std::string> ways = named({{"u_x", &c.u_x}, {"u_y", &c.u_y}, {"u_z", &c.u_z}});
  if (forces.empty() && ways.empty())
    all.push_back({"columns", "nothing that was measured",
                   "force, reaction_x, reaction_y, reaction_z, u_x, u_y or u_z", ""});
  if (!forces.empty() && !ways.empty())
    all.push_back(
        {"columns." + ways[0], "found together with " + forces[0], "forces or displacements",
         "an item of data each, with a standard deviation of its own; items of one `solve` share its runs"});
  const bool at_places = !c.x.empty() || !c.y.empty() || !c.z.empty();
  if (!ways.empty() && at_places == !on.empty())
    all.push_back(
        {at_places ? "on" : "columns." + ways[0],
         at_places ? "found together with columns of places" : "a displacement of no place",
         "on: a point or set of the scene, or columns x and z", ""});
  if (std::any_of(forces.begin(), forces.end(),
                  [](const std::string& f) { return f != "force"; }) &&
      on.empty())
    all.push_back({"on", "missing", "the set whose reaction it is", ""});
  if (compliance != 0 && (c.u_ind.empty() || c.force.empty()))
    all.push_back(
        {"compliance", "found without u_ind and force", "a test of force over travel", ""});
}

bool FitConfig::has_scenes() const {
  return std::any_of(data.begin(), data.end(), [](const FitData& d) { return d.is_scene(); });
}

// Reads keys such as contacts.ball.friction and data[0].touch_offset.
std::optional<SceneNumber> scene_number(const FitConfig& config, const std::string& key) {
  if (const auto stretch = wave_number_key(config, key)) return stretch;
  if (!config.has_scenes()) return std::nullopt;
  const std::string contact = "contacts.";
  const std::string friction = ".friction";
  if (key.starts_with(contact) && key.ends_with(friction) &&
      key.size() > contact.size() + friction.size())
    return SceneNumber{SceneNumber::Of::friction,
                       key.substr(contact.size(), key.size() - contact.size() - friction.size())};
  for (std::size_t i = 0; i < config.data.size(); ++i)
    for (const auto& [word, of] : {std::pair("touch_offset", SceneNumber::Of::touch_offset),
                                   {"force_offset", SceneNumber::Of::force_offset},
                                   {"compliance", SceneNumber::Of::compliance},
                                   {"fibre_angle", SceneNumber::Of::fibre_angle}})
      if (config.data[i].is_scene() && key == fmt::format("data[{}].{}", i, word))
        return SceneNumber{of, "", i};
  for (const char* begin :
       {"contacts.", "mesh.", "materials.", "loads[", "bodies.", "fibre_field.", "fibre_angles["})
    if (key.starts_with(begin)) return SceneNumber{SceneNumber::Of::of_config, key};
  return std::nullopt;
}

namespace {

// "contacts.ball.rigid.sphere.radius" becomes "ball_radius", "mesh.bodies[1].thickness"
// "thickness_2", "materials.fat.matrix.yeoh.a1" "fat_a1".
std::string short_name(const std::string& path) {
  std::string last = path.substr(path.rfind('.') + 1);
  const auto part = [&](std::size_t begin) {
    return path.substr(begin, path.find('.', begin) - begin);
  };
  if (path.starts_with("contacts.")) return part(9) + "_" + last;
  if (path.starts_with("materials.")) return part(10) + "_" + last;
  if (path.starts_with("mesh.bodies[") && last == "thickness")
    return fmt::format("thickness_{}", std::stoi(path.substr(12)) + 1);
  if (path.starts_with("mesh.geometry.") && last == "size[1]") return "thickness";
  std::string name;
  for (const char c : path) {
    if (c == ']') continue;
    const bool separates = c == '.' || c == '[';
    name += separates ? '_' : c;
  }
  return name;
}

}  // namespace

// Value and box of a number of a scene that the config does not give are those of the scene, which
// is read later: not a number until then.
FreeParameter scene_config_parameter(const FitParameter& p) {
  const double later = std::nan("");
  FreeParameter one{
      p.key, later, later, later, false, short_name(p.key), unit_of_config_number(p.key)};
  if (p.prior && p.prior->normal) one.start = (*p.prior->normal)[0];
  if (p.prior && p.prior->lognormal) one.start = (*p.prior->lognormal)[0];
  one.start = p.start.value_or(one.start);
  one.lower = p.lower.value_or(later);
  one.upper = p.upper.value_or(later);
  return one;
}

// Checks a candidate of the study: keys of scenes only with kind: scene, and a place for what is
// measured.
std::vector<Complaint> CandidateChoice::complaints() const {
  std::vector<Complaint> all;
  if (kind == DataKind::wave) {
    all.push_back({"kind", "wave, of a candidate", "a homogeneous test or a scene", ""});
    return all;
  }
  if (kind != DataKind::scene) {
    for (const auto& [key, found] : {std::pair("solve", !solve.path.empty()),
                                     {"vary", !vary.empty()},
                                     {"places", !places.empty()},
                                     {"on", !on.empty()}})
      if (found) all.push_back({key, "found in a candidate that is no scene", "kind: scene", ""});
    return all;
  }
  if (solve.path.empty())
    all.push_back({"solve", "missing", "config of langer-solve that the test would be", ""});
  if (measured.empty())
    all.push_back({"measured", "an empty list", "force, a reaction or a displacement", ""});
  for (std::size_t i = 0; i < vary.size(); ++i)
    if (vary[i].values.empty())
      all.push_back({fmt::format("vary[{}].values", i), "an empty list", "a value at least", ""});
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const bool moves = measured[i] >= SceneQuantity::u_x;
    const std::string word = names(measured[i])[static_cast<std::size_t>(measured[i])];
    if (measured[i] != SceneQuantity::force && on.empty() && !(moves && !places.empty()))
      all.push_back({moves ? "places" : "on", "missing, with " + word + " measured",
                     moves ? "places on the top, or on: a set" : "the set that is held or moved",
                     ""});
    if (!moves && !places.empty())
      all.push_back({fmt::format("measured[{}]", i), word + " together with places",
                     "displacements, and a candidate of its own for the force", ""});
  }
  return all;
}

}  // namespace langer
