#include "scene/run/surface_records.hpp"

#include <algorithm>
#include <utility>

namespace langer {

void record_surfaces(const Increment& increment, StepRecord& record) {
  const auto defects = increment.surface_defects();
  const auto& averages = increment.surface_averages();
  const std::vector<double> penetrations = increment.surface_penetrations();
  const std::size_t first = increment.contacts().size();
  for (std::size_t s = 0; s < defects.size(); ++s) {
    const ContactDefect& defect = defects[s];
    // Bonds pull at the surface, too: the force is that of both.
    const Vec3 on_other = -(defect.force + increment.bonds().sum(first + s));
    const std::string& name = increment.surfaces()[s].name;
    ContactRecord& contact = record.contacts[name];
    contact.r = increment.accepted().r[first + s];
    contact.gap = defect.gap;
    for (ContactStatus status : defect.status) contact.status.push_back(static_cast<int>(status));
    for (const auto& [measure, value] : {std::pair{"penetration", defect.penetration},
                                         {"cone", defect.cone},
                                         {"complementarity", defect.complementarity}})
      record.scalars[measure] = std::max(record.scalars[measure], value);
    for (int j = 0; j < 3; ++j) record.scalars["force_" + name + "_" + "xyz"[j]] = on_other[j];
    if (increment.contacts().empty()) record.force_ind += on_other;  // else of the indenters
    record.scalars["force_" + name] = on_other.norm();
    const double images = increment.surfaces()[s].images;
    double area = 0;
    double pressure = 0;
    for (const MortarNode& node : averages[s]) {
      const Vec3& r = contact.r[static_cast<std::size_t>(node.candidate)];
      if (r.isZero(0)) continue;
      area += images * node.area;
      pressure = std::max(pressure, r.dot(node.normal) / (images * node.area));
    }
    record.scalars["contact_area_" + name] = area;
    record.scalars["pressure_max_" + name] = pressure;
    record.scalars["penetration_" + name] = penetrations[s];
  }
}

}  // namespace langer
