#include "scene/run/vibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "mechanics/assembly/mass.hpp"
#include "mechanics/vibration/harmonic.hpp"
#include "mechanics/vibration/modes.hpp"
#include "scene/model/scene_motion.hpp"
#include "scene/run/by_node.hpp"

namespace langer {

namespace {

[[noreturn]] void refuse(const Run::Where& where, const std::string& key, std::string found,
                         std::string expected, std::string hint = "") {
  throw Failure(Exit::config,
                Error{where(key), key, std::move(found), std::move(expected), std::move(hint)});
}

constexpr const char* whole_body = "symmetry: none solves the whole body";

// The direction in which an indenter was moved last, or is pushed.
std::optional<Vec3> last_direction(const RigidContact& contact) {
  if (contact.control) return contact.control->along;
  for (std::size_t i = contact.motion.size(); i-- > 0;) {
    Vec3 before = Vec3::Zero();
    if (i > 0) before = contact.motion[i - 1].to;
    const Vec3 moved = contact.motion[i].to - before;
    if (moved.norm() > 0) return moved.normalized();
  }
  return std::nullopt;
}

Vec3 given_direction(const std::array<double, 3>& along) {
  return Vec3(along[0], along[1], along[2]).normalized();
}

// A section knows movements along its axis, of plane strain those in its plane.
void check_section(const Mesh& mesh, const Vec3& along, const Run::Where& where) {
  if (!mesh.section) return;
  const bool axisymmetric = mesh.section->of == SectionOf::axisymmetric;
  const bool outside = along[2] != 0 || (axisymmetric && along[0] != 0);
  if (!outside) return;
  refuse(where, "harmonic.along", "found a movement that leaves the section",
         axisymmetric ? "one along its axis, [0, -1, 0]" : "one in its plane, with z = 0",
         "other movements need a block");
}

Driver indenter_driver(const HarmonicConfig& harmonic, const Run& run, const Run::Where& where) {
  const std::vector<RigidContact>& contacts = run.reduction.scene().contacts;
  const ReducedScene* part = run.reduction.part();
  if (part && part->swaps_indenters())
    refuse(where, "harmonic.indenter", "found an indenter whose mirror image would stand still",
           "a scene without symmetry", whole_body);
  Driver driver;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (harmonic.indenter && contacts[k].name != *harmonic.indenter) continue;
    driver.contact = static_cast<int>(k);
    if (harmonic.along) {
      driver.along = given_direction(*harmonic.along);
    } else if (const auto along = last_direction(contacts[k])) {
      driver.along = *along;
    } else {
      refuse(where, "harmonic.along", "missing, and the indenter does not move",
             "the direction of the oscillation", "");
    }
    break;
  }
  return driver;
}

// The nodes of the part that stand for the set. Every image of one of them has to be in the set and
// to move alike.
std::vector<int> nodes_of_part(const std::vector<int>& set, const Vec3& along, const Run& run,
                               const Run::Where& where) {
  const ReducedScene* part = run.reduction.part();
  if (!part) return set;
  const std::vector<Image>& images = part->node_images();
  std::vector<int> stands_for(images.size(), 0);
  for (const Image& image : images) ++stands_for[static_cast<std::size_t>(image.of)];
  std::vector<int> in_set(images.size(), 0);
  std::vector<int> nodes;
  for (int node : set) {
    const Image& image = images[static_cast<std::size_t>(node)];
    if (!(image.T * along - along).isZero(1e-12))
      refuse(where, "harmonic.along", "found a movement that breaks the symmetry of the scene",
             "one that keeps it", whole_body);
    if (++in_set[static_cast<std::size_t>(image.of)] == 1) nodes.push_back(image.of);
  }
  // behind a section stand nodes that a set of its own nodes may leave out
  if (run.mesh.section) return nodes;
  for (int node : nodes) {
    if (in_set[static_cast<std::size_t>(node)] != stands_for[static_cast<std::size_t>(node)])
      refuse(where, "harmonic.face", "found a set that is not its own mirror image",
             "one that keeps the symmetry of the scene", whole_body);
  }
  return nodes;
}

std::vector<Vec3> whole_shape(const Run& run, const Mode& mode) {
  if (const ReducedScene* part = run.reduction.part())
    return part->whole_movement(run.mesh, mode.shape, mode.kind);
  std::vector<Vec3> out = by_node(mode.shape);
  for (const HangingNode& h : run.mesh.hanging) {
    Vec3 mean = Vec3::Zero();
    for (int n : h.of) mean += 0.25 * out[static_cast<std::size_t>(n)];
    out[static_cast<std::size_t>(h.node)] = mean;
  }
  return out;
}

ModesRecord modes_record(const SolveConfig& config, Run& run, const std::vector<double>& density,
                         const ModesListener& listener) {
  const Modes found =
      modes_of(run.body, run.increment, density, run.reduction.symmetry_breaking_dofs(),
               config.modes->count, config.blas_threads);
  ModesRecord record;
  record.counted = found.counted;
  for (const Mode& mode : found.modes) {
    record.frequency.push_back(mode.frequency());
    record.growth.push_back(mode.growth());
    record.breaks_symmetry.push_back(mode.kind > 0 ? 1 : 0);
    record.shape.push_back(whole_shape(run, mode));
  }
  if (listener) listener(found, density, record);
  return record;
}

HarmonicRecord harmonic_record(const SolveConfig& config, Run& run,
                               const std::vector<double>& density, const Run::Where& where) {
  const Driver driver = driver_of(config, run, where);
  HarmonicRecord record;
  if (config.harmonic->face) {
    record.driver = *config.harmonic->face;
  } else {
    record.driver = run.reduction.scene().contacts[static_cast<std::size_t>(driver.contact)].name;
  }
  std::string key = "harmonic.indenter";
  if (config.harmonic->face) key = "harmonic.face";
  std::optional<Harmonic> harmonic;
  try {
    harmonic.emplace(run.body, run.increment, density, driver);
  } catch (const std::invalid_argument& problem) {
    std::string hint;
    if (run.reduction.part()) hint = whole_body;
    refuse(where, key, std::string("found ") + problem.what(),
           "what can oscillate along harmonic.along", hint);
  }
  for (double frequency : config.harmonic->frequencies.values()) {
    const Complex k = harmonic->stiffness(frequency);
    record.frequency.push_back(frequency);
    record.storage.push_back(k.real());
    record.loss.push_back(k.imag());
  }
  return record;
}

std::vector<double> checked_densities(const SolveConfig& config, const Mesh& mesh,
                                      const Run::Where& where) {
  std::vector<Error> errors;
  std::vector<double> all = densities(*config.dynamics, mesh, where, errors);
  if (!errors.empty()) throw Failure(Exit::config, errors);
  return all;
}

}  // namespace

Driver driver_of(const SolveConfig& config, const Run& run, const Run::Where& where) {
  const HarmonicConfig& harmonic = *config.harmonic;
  if (!harmonic.face) {
    const Driver driver = indenter_driver(harmonic, run, where);
    check_section(run.mesh, driver.along, where);
    return driver;
  }
  Driver driver;
  driver.along = given_direction(*harmonic.along);
  check_section(run.mesh, driver.along, where);
  const auto set = run.mesh.node_sets.find(*harmonic.face);
  if (set == run.mesh.node_sets.end() || set->second.empty()) {
    std::vector<std::string> known;
    for (const auto& [name, nodes] : run.mesh.node_sets) known.push_back(name);
    refuse(where, "harmonic.face", "found \"" + *harmonic.face + "\"",
           "a node set of the mesh: " + list_words(known),
           did_you_mean(nearest(*harmonic.face, known)));
  }
  driver.nodes = nodes_of_part(set->second, driver.along, run, where);
  return driver;
}

void check_vibration(const SolveConfig& config, const Run& run, const Run::Where& where) {
  if (!config.modes && !config.harmonic) return;
  checked_densities(config, run.mesh, where);
  if (config.harmonic) driver_of(config, run, where);
}

std::optional<VibrationRecord> vibration_of(const SolveConfig& config, Run& run,
                                            const Run::Where& where,
                                            const ModesListener& listener) {
  if (!config.modes && !config.harmonic) return std::nullopt;
  const std::vector<double> density = checked_densities(config, run.mesh, where);
  VibrationRecord record;
  try {
    if (config.modes) record.modes = modes_record(config, run, density, listener);
    if (config.harmonic) record.harmonic = harmonic_record(config, run, density, where);
  } catch (const std::invalid_argument& problem) {
    refuse(where, "modes", std::string("found ") + problem.what(),
           "a state whose contact can be frozen");
  } catch (const std::runtime_error& problem) {
    throw Failure(Exit::not_converged, Error{{}, "vibration", problem.what(), "", ""});
  }
  return record;
}

std::vector<std::string> in_words(const VibrationRecord& record, const Run& run) {
  std::vector<std::string> lines;
  if (record.modes) {
    const ModesRecord& modes = *record.modes;
    std::vector<std::string> words;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, modes.frequency.size()); ++i)
      words.push_back(fmt::format("{:.4g}", modes.frequency[i]));
    std::string line =
        fmt::format("modes: {} from {} Hz on", modes.frequency.size(), fmt::join(words, ", "));
    if (modes.counted) line += "; none is missing among them";
    if (run.mesh.section) line += "; of the section: others leave its plane";
    lines.push_back(line);
    const auto unstable = std::ranges::count_if(modes.growth, [](double g) { return g > 0; });
    if (unstable > 0)
      lines.push_back(fmt::format(
          "warning: {} of them grow instead: the state at the end of the path is unstable",
          unstable));
  }
  if (record.harmonic && !record.harmonic->frequency.empty()) {
    const HarmonicRecord& h = *record.harmonic;
    lines.push_back(fmt::format(
        "harmonic: {} from {:.4g} + {:.4g} i N/mm at {:g} Hz to {:.4g} + {:.4g} i N/mm at {:g} Hz",
        h.driver, h.storage.front(), h.loss.front(), h.frequency.front(), h.storage.back(),
        h.loss.back(), h.frequency.back()));
  }
  return lines;
}

std::vector<Summary> summary_of(const VibrationRecord& record) {
  std::vector<Summary> out;
  if (record.modes) {
    for (std::size_t i = 0; i < record.modes->frequency.size(); ++i)
      out.push_back({fmt::format("frequency_{}", i + 1), record.modes->frequency[i], "Hz"});
    for (const auto& [name, values] : record.modes->derivatives) {
      const std::string of = name.substr(std::string("d_frequency").size());
      for (std::size_t i = 0; i < values.size(); ++i)
        out.push_back({fmt::format("d_frequency_{}{}", i + 1, of), values[i], "-"});
    }
  }
  if (record.harmonic && !record.harmonic->frequency.empty()) {
    const HarmonicRecord& h = *record.harmonic;
    out.push_back({"storage_first", h.storage.front(), "N/mm"});
    out.push_back({"loss_first", h.loss.front(), "N/mm"});
    out.push_back({"storage_last", h.storage.back(), "N/mm"});
    out.push_back({"loss_last", h.loss.back(), "N/mm"});
  }
  return out;
}

std::vector<std::string> vibration_files(const SolveConfig& config) {
  std::vector<std::string> names;
  if (config.modes) names.push_back("modes.csv");
  if (config.harmonic) names.push_back("harmonic.csv");
  return names;
}

}  // namespace langer
