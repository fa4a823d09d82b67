// langer-sample: one sample of the parameters of a fit, drawn from its covariance, as a material.
//   langer-sample sample.yaml --material material.h5 --set number=17 -o sample/material.h5
#include "core/hdf5/seal.hpp"
#include "identification/inverse/parameter_sample.hpp"
#include "identification/inverse/sample_config.hpp"
#include "mechanics/material/at_rest.hpp"
#include "results/store/material_file.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// A sample may lack stiffness in the undeformed state (a shear modulus of 0), and is then refused:
// no body can be made of it.
std::vector<Summary> sample(const Job<SampleConfig>& job) {
  const std::string file = job.input("material");
  const MaterialFile fitted = read_material(file);
  const int number = job.config.number;
  if (const std::string reason = reason_without_samples(fitted, number); !reason.empty())
    throw Failure(Exit::config, Error{job.where("number"), "number",
                                      fmt::format("{}, and {} has {}", number, file, reason),
                                      "a sample of a fit with a covariance or a bootstrap",
                                      "study: {bootstrap: 200} in the fit's config makes 200"});
  const ParameterSample set = sample_of(fitted, number);
  if (at_rest(set.law) == AtRest::without_stiffness)
    throw Failure(Exit::input,
                  Error{{file},
                        "",
                        fmt::format("sample {}: a law with {}", number, at_rest_in_words(set.law)),
                        stiffness_at_rest_cure(set.law),
                        "a lower bound above 0 in the fit"});
  job.say("{}", set.words);
  write_material(job.output, set.law, std::nullopt, job.identity);
  return set.values;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::SampleConfig>(argc, argv, "sample", langer::sample);
}
