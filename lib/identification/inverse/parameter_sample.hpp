// One of the sets of parameters that a fit leaves open, by its number: the stage sample, whose
// sweep is the check of the linear band (inverse/uncertainty.hpp).
//   of a population           specimens that were not tested (population/untested_specimen.hpp)
//   with a bootstrap in material.h5   its samples, one after the other
//   without                           p + L z, C = L L^T the fit's covariance, z normal of that number's own stream, put into the bounds
// Ties follow. Numbers that are not of the law, such as the friction of a scene or the offset of a
// machine, stay in the scene's config.
#pragma once

#include <string>
#include <vector>

#include "results/store/material_file.hpp"
#include "results/store/provenance.hpp"

namespace langer {

struct ParameterSample {
  Material law;
  std::vector<Summary> values;  // parameter_<name>, those of the law
  std::string words;            // "parameters 17 of the fit: a1 = 0.012 MPa, a2 = ..."
};

// why there is no set of that number; empty: there is one
std::string reason_without_samples(const MaterialFile& file, int number);
ParameterSample sample_of(const MaterialFile& file, int number);  // from 1

}  // namespace langer
