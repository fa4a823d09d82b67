#include "accuracy/checks/stability_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "accuracy/checks/place_text.hpp"
#include "core/base/text.hpp"
#include "mechanics/element/point_check.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "results/post/nodal_fields.hpp"
#include "results/store/material_file.hpp"

namespace langer {

namespace {

constexpr double slack = 1 + 1e-6;   // a run to the end of the test is inside
constexpr std::size_t refined = 24;  // points looked at exactly

// How far a point is deformed, over how far the tests were that the material was fitted to: the
// largest ratio of the invariants minus their values at rest. Above 1 the point is outside.
double excess(const FittedRange& range, const Mat3& F, std::span<const Vec3> a) {
  double most = (F.squaredNorm() - 3) / std::max(range.I1_bar - 3, 1e-12);
  for (std::size_t k = 0; k < a.size() && k < range.I4_bar.size(); ++k)
    if (const double I4 = (F * a[k]).squaredNorm(); I4 > 1)
      most = std::max(most, (I4 - 1) / std::max(range.I4_bar[k] - 1, 1e-12));
  return most;
}

// a Gauss point by the smallest shear stiffness that the grid finds there
struct Low {
  double stiffness;
  int cell, point;
  Mat3 F;
};
bool lower(const Low& x, const Low& y) { return x.stiffness < y.stiffness; }

// among the lowest so far: a heap, the highest of them in front
void keep_lowest(std::vector<Low>& lowest, const Low& one) {
  if (lowest.size() == refined && !lower(one, lowest.front())) return;
  if (lowest.size() == refined) {
    std::pop_heap(lowest.begin(), lowest.end(), lower);
    lowest.pop_back();
  }
  lowest.push_back(one);
  std::push_heap(lowest.begin(), lowest.end(), lower);
}

// A change of volume that is worth a warning, whatever the bulk modulus is.
constexpr double most_volume_change = 0.02;

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

}  // namespace

// The range of the tests, which a fitted material carries. Materials that were typed have none.
StudyRecord study_from(const std::string& material_file) {
  const std::string extension = std::filesystem::path(material_file).extension();
  if (extension == ".yaml" || extension == ".yml") return {};
  const auto fit = read_material(material_file).fit;
  if (fit) return fit->study;
  return StudyRecord{};
}

// Of the symmetric and the antisymmetric movements together; -1 if a tangent is singular and no
// negative eigenvalue is known.
int StabilityReport::negative_eigenvalues() const {
  int sum = 0;
  bool singular = false;
  for (const std::optional<Signature>* part : {&signature, &breaking}) {
    if (!*part) continue;
    if ((*part)->negative < 0) {
      singular = true;
    } else {
      sum += (*part)->negative;
    }
  }
  if (singular && sum == 0) return -1;
  return sum;
}

std::string in_words(const StabilityReport& r) {
  std::string words;
  const int negative = r.negative_eigenvalues();
  if (negative > 0)
    words = fmt::format("the constrained tangent has {} negative eigenvalue{}", negative,
                        plural_s(negative));
  if (negative < 0) words = "the constrained tangent is singular";
  if (negative > 0 && r.breaking && r.breaking->negative > 0)
    words += fmt::format(" ({} in movements that break the symmetry)", r.breaking->negative);
  if (std::isnan(r.stiffness)) {
    append(words, "; ",
           fmt::format("the law has no number in cell {} at {}", r.cell, place_text(r.place)));
  } else if (r.material_unstable()) {
    append(
        words, "; ",
        fmt::format("strong ellipticity is lost in {} of the volume (minimum acoustic eigenvalue "
                    "{:.3g} MPa in cell {} at {})",
                    percent(r.lost), r.stiffness, r.cell, place_text(r.place)));
  }
  return words;
}

void StabilityWatch::resume(const StepRecord& last) {
  t_before_ = -1;  // the next step is compared with this one from its record
  // All steps of a file have the same names: those of one hexahedron that stands for the body, and
  // of the reduced body after them.
  if (last.scalars.contains("negative_eigenvalues"))
    says_which_signs_ = last.scalars.contains("signs_of_whole_body");
  if (const auto found = last.scalars.find("driving_force"); found != last.scalars.end()) {
    force_before_ = found->second;
    t_before_ = last.t;
  }
}

// The cells of the lowest points of the last step have that many points: the lowest of all are no
// stiffer than the stiffest of these.
double StabilityWatch::stiffest_of_lowest(const Assembler& body, const BodyState& state) const {
  std::vector<double> stiffness;
  PointCheck points;
  for (const int e : lowest_cells_) {
    if (e >= body.mesh().n_cells()) return INFINITY;  // of another mesh
    check_points(body.material(e), body.geometry(e), body.fibres(e),
                 body.element_displacements(state.u, e), points);
    for (const double s : points.stiffness) stiffness.push_back(std::isfinite(s) ? s : -INFINITY);
  }
  if (stiffness.size() < refined) return INFINITY;
  std::nth_element(stiffness.begin(), stiffness.begin() + refined - 1, stiffness.end());
  return stiffness[refined - 1];
}

StabilityReport StabilityWatch::look(const Assembler& body, Increment& increment, double within) {
  std::optional<Signature> signature;
  if (!signs_) signs_ = !increment.iterative();
  if (*signs_) signature = increment.signature(within);
  return look(body, increment.accepted(), increment.reactions(), !increment.contacts().empty(),
              signature);
}

StabilityReport StabilityWatch::look(const Assembler& body, const BodyState& state,
                                     const VecX& reactions, bool contacts,
                                     std::optional<Signature> signature) {
  StabilityReport report;
  report.t = state.t;
  report.signature = signature;
  if (!signs_) signs_ = signature.has_value();

  // Every Gauss point is checked on a coarse grid of directions, eight at a time. The points with
  // the smallest stiffness are then searched exactly.
  std::vector<Low> lowest;
  double volume = 0;
  PointCheck points;
  // No point stiffer than this is among the lowest.
  double enough = stiffest_of_lowest(body, state);
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const auto a = body.fibres(e);
    check_points(body.material(e), body.geometry(e), a, body.element_displacements(state.u, e),
                 points, enough);
    double cell_volume = 0;
    const int n_gauss = body.geometry(e).n_gauss();
    for (int g = 0; g < n_gauss; ++g)
      cell_volume += body.geometry(e).w[g] * points.J[g] / body.geometry(e).V;
    if (std::abs(cell_volume - 1) > report.volume_change.value) {
      report.volume_change = {std::abs(cell_volume - 1), gauss_position(body.mesh(), e, 0)};
    }
    for (int g = 0; g < n_gauss; ++g) {
      const double w = body.geometry(e).w[g];
      double s = -INFINITY;
      if (std::isfinite(points.stiffness[g])) s = points.stiffness[g];
      volume += w;
      // A point whose acoustic tensor has a negative eigenvalue has lost strong ellipticity.
      if (s < 0) report.lost += w;
      keep_lowest(lowest, {s, e, g, points.F[g]});
      if (lowest.size() == refined) enough = std::min(enough, lowest.front().stiffness);
      if (a.empty() && !study_.range) continue;
      const Mat3 F = points.F[g] / std::cbrt(points.J[g]);
      for (const Vec3& direction : a) {
        const double stretch = (F * direction).norm();
        report.fibre_min = std::min(report.fibre_min, stretch);
        report.fibre_max = std::max(report.fibre_max, stretch);
      }
      if (!study_.range) continue;
      const double far = excess(*study_.range, F, a);
      if (far > slack) report.outside += w;
      if (far > report.farthest) {
        report.farthest = far;
        report.farthest_place = gauss_position(body.mesh(), e, g);
      }
    }
  }
  report.lost /= volume;
  report.outside /= volume;
  std::sort(lowest.begin(), lowest.end(), lower);
  lowest_cells_.clear();
  for (const Low& point : lowest) lowest_cells_.insert(point.cell);
  report.stiffness = INFINITY;
  for (const Low& point : lowest) {
    const double s =
        smallest_shear_stiffness(body.material(point.cell), point.F, body.fibres(point.cell)).value;
    if (std::isfinite(s) && s >= report.stiffness) continue;
    report.stiffness = s;
    report.cell = point.cell;
    report.place = gauss_position(body.mesh(), point.cell, point.point);
    if (!std::isfinite(s)) break;
  }
  // the grid may have missed a loss that the exact look has found
  if (report.stiffness < 0 && report.lost == 0)
    report.lost = body.geometry(report.cell).w[0] / volume;

  // The force that works along the prescribed displacements. Where it falls, the same body under
  // dead loads would not be stable.
  for (const Prescribed& p : body.dofs().prescribed)
    report.driving_force += reactions[p.dof] * p.rate(state.t);
  const bool straight = std::all_of(body.dofs().prescribed.begin(), body.dofs().prescribed.end(),
                                    [](const auto& p) { return p.in_proportion(); });
  if (straight && !contacts) {  // along a straight path; a body that slides under
                                // an indenter has other reasons to resist less
    const double scale = std::max(std::abs(report.driving_force), std::abs(force_before_));
    report.falling = t_before_ >= 0 && report.driving_force < force_before_ - 1e-9 * scale;
  }
  force_before_ = report.driving_force;
  t_before_ = state.t;
  return report;
}

void StabilityWatch::add_to(StepRecord& record, const StabilityReport& r) const {
  auto& s = record.scalars;
  if (r.signature) {
    s["negative_eigenvalues"] = r.negative_eigenvalues();
    const bool reduced = reach_ != Reach::whole_body;
    const bool of_whole_body = !reduced || r.breaking;
    if (says_which_signs_.value_or(reduced)) s["signs_of_whole_body"] = of_whole_body;
  }
  s["shear_stiffness_min"] = std::isfinite(r.stiffness) ? r.stiffness : -1e300;
  s["weakest_cell"] = r.cell;
  for (int k = 0; k < 3; ++k) s[std::string("weakest_") + "xyz"[k]] = r.place[k];
  s["volume_change"] = r.volume_change.value;
  s["unstable_volume"] = r.lost;
  if (r.fibre_max > 0) {
    s["isochoric_fibre_stretch_min"] = r.fibre_min;
    s["isochoric_fibre_stretch_max"] = r.fibre_max;
  }
  if (study_.range) s["outside_fit"] = r.outside;
  s["driving_force"] = r.driving_force;
}

// Neighbouring steps of the same kind are one span of t.
void StabilityWatch::Spans::add(double t, bool here) {
  if (here && open) of.back()[1] = t;
  if (here && !open) of.push_back({t, t});
  open = here;
}

std::string StabilityWatch::Spans::text() const {
  std::string words;
  for (const auto& [from, to] : of) {
    std::string span = fmt::format("{:.4g}", from);
    if (from != to) span = fmt::format("{:.4g} to {:.4g}", from, to);
    append(words, ", ", span);
  }
  if (words.empty()) return "";
  return "t = " + words;
}

void StabilityWatch::keep(const StabilityReport& r) {
  last_ = r;
  steps_unstable_ += r.equilibrium_unstable() || r.material_unstable();
  most_negative_ = std::max(most_negative_, std::abs(r.negative_eigenvalues()));
  if (r.breaking) most_breaking_ = std::max(most_breaking_, r.breaking->negative);
  equilibrium_.add(r.t, r.equilibrium_unstable());
  material_.add(r.t, r.material_unstable());
  if (r.volume_change.value > volume_change_.value) volume_change_ = r.volume_change;
  outside_.add(r.t, r.outside > 0);
  falling_.add(r.t, r.falling);
}

std::vector<std::string> StabilityWatch::warnings() const {
  std::vector<std::string> lines;
  if (signs_ && !*signs_)
    lines.push_back(
        "whether equilibria are stable was not looked at: the tangent is solved iteratively; solver.newton.linear: direct shows it, "
        "stability: off asks for nothing");
  if (!outside_.of.empty())
    lines.push_back(fmt::format(
        "{} of the volume is deformed beyond the tests that the material was fitted to, most {:.3g} times "
        "as far near {}; first at t = {:.4g}",
        percent(last_.outside), last_.farthest, place_text(last_.farthest_place),
        outside_.of[0][0]));
  if (!equilibrium_.of.empty()) {
    std::string line = fmt::format(
        "unstable equilibria at {}: the constrained tangent has up to {} negative eigenvalue{}; a real body would "
        "leave these states",
        equilibrium_.text(), most_negative_, plural_s(most_negative_));
    if (most_breaking_ > 0) {
      line += fmt::format(
          ". {} of them are movements that break the symmetry by which the body was reduced: symmetry: none "
          "solves the whole body",
          most_breaking_);
      if (reach_ == Reach::symmetric_until_the_end)
        line += "; checked at the end only, stability: each_step finds the first such state";
    }
    lines.push_back(std::move(line));
  }
  if (!material_.of.empty() && std::isnan(last_.stiffness))
    lines.push_back(fmt::format("the law has no number at {}, at the end near {}", material_.text(),
                                place_text(last_.place)));
  else if (!material_.of.empty())
    lines.push_back(fmt::format(
        "unstable material at {}: at the end {} of the volume has lost strong ellipticity (minimum "
        "acoustic eigenvalue {:.3g} MPa near {}): the solution depends on the mesh there",
        material_.text(), percent(last_.lost), last_.stiffness, place_text(last_.place)));
  if (volume_change_.value > most_volume_change) {
    lines.push_back(fmt::format(
        "an element near {} changes its volume by {}: the stresses there come near the bulk "
        "modulus, and soft tissue keeps its volume; a larger bulk modulus (a smaller d) keeps it. "
        "If the material is nearly incompressible already, look at stiff fibres (c2) and at the "
        "strains there",
        place_text(volume_change_.place), percent(volume_change_.value)));
  }
  if (!falling_.of.empty())
    lines.push_back(fmt::format(
        "the driving force falls at {}: held by displacements these states may be stable, under the same "
        "forces as dead loads they are not",
        falling_.text()));
  return lines;
}

std::vector<std::string> StabilityWatch::notes() const {
  if (reach_ != Reach::section || !signs_.value_or(false)) return {};
  return {
      "stability was checked for movements of the section only; a section does not show how the body moves out of its "
      "plane or around its axis"};
}

std::vector<Summary> StabilityWatch::summary() const {
  std::vector<Summary> all{{"shear_stiffness_min", last_.stiffness, "MPa"},
                           {"unstable_volume", last_.lost, "-"},
                           {"steps_unstable", static_cast<double>(steps_unstable_), "-"}};
  if (signs_.value_or(true))
    all.insert(all.begin(), {"negative_eigenvalues", static_cast<double>(most_negative_), "-"});
  return all;
}

}  // namespace langer
