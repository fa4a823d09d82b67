#include "results/store/material_file.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "core/base/text.hpp"
#include "results/store/listing.hpp"
#include "results/store/matrices.hpp"
#include "results/store/provenance.hpp"
#include "results/store/vtk_grid.hpp"

namespace langer {

namespace {

// Datasets are stored row by row, Eigen's matrices column by column.
MatX read_matrix(const h5::Group& group, const std::string& name, const h5::Shape& shape) {
  const auto array = group.read<double>(name, shape);
  using Rows = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(array.values.data(), static_cast<Eigen::Index>(array.shape[0]),
                                static_cast<Eigen::Index>(array.shape[1]));
}

// The bound of the stiffness at rest that the fit raised, and the error before and after.
void write_at_rest(const h5::Group& group, const StiffnessAtRest& s) {
  for (const auto& [name, value] : {std::pair{"fitted", s.fitted},
                                    {"allowed", s.allowed},
                                    {"least", s.least},
                                    {"taken", s.taken},
                                    {"noise", s.noise}})
    group.write_scalar(name, value, "MPa");
  group.write_scalar("error_before", s.error_before, "percent");
  group.write_scalar("error_after", s.error_after, "percent");
  group.attribute("key", s.key);
}

void check_units(const h5::Group& group,
                 std::initializer_list<std::pair<const char*, const char*>> units) {
  for (const auto& [name, unit] : units) require_unit(group, name, unit);
}

// The inverse of write_at_rest().
StiffnessAtRest read_at_rest(const h5::Group& group) {
  check_units(group, {{"fitted", "MPa"},
                      {"allowed", "MPa"},
                      {"least", "MPa"},
                      {"taken", "MPa"},
                      {"noise", "MPa"},
                      {"error_before", "percent"},
                      {"error_after", "percent"}});
  const auto value = [&](const char* name) {
    return group.read_scalar(name);
  };
  return {value("fitted"),       value("allowed"),    value("least"),
          value("taken"),        value("noise"),      group.text_attribute("key"),
          value("error_before"), value("error_after")};
}

// The noise of the tests, with the criterion of each model that was compared.
void write_noise(const h5::Group& group, const NoiseRecord& noise) {
  group.attribute("model", noise.model);
  group.write_scalar("correlation", noise.correlation, "-");
  group.write_scalar("share", noise.share, "-");
  group.write_scalar("largest_correlation", noise.limit, "-");
  group.write_scalar("minus_two_log_likelihood", noise.minus_two_log_likelihood, "-");
  for (const auto& [kind, aicc] : noise.aicc) group.write_scalar("aicc_" + kind, aicc, "-");
}

// The inverse of write_noise().
NoiseRecord read_noise(const h5::Group& group) {
  check_units(group, {{"correlation", "-"},
                      {"share", "-"},
                      {"largest_correlation", "-"},
                      {"minus_two_log_likelihood", "-"}});
  NoiseRecord noise;
  noise.model = group.text_attribute("model");
  noise.correlation = group.read_scalar("correlation");
  noise.share = group.read_scalar("share");
  noise.limit = group.read_scalar("largest_correlation");
  noise.minus_two_log_likelihood = group.read_scalar("minus_two_log_likelihood");
  for (const char* kind : {"white", "proportional", "autoregressive", "both"}) {
    const std::string name = std::string("aicc_") + kind;
    if (group.has(name)) noise.aicc.push_back({kind, group.read_scalar(name)});
  }
  return noise;
}

// One group per parameter. The attribute `order` has the order of the rows of the covariance,
// because HDF5 lists groups by name.
void write_parameters(const h5::Group& group, const std::vector<FittedParameter>& fitted) {
  const h5::Group parameters = group.make_group("parameters");
  std::string order;
  for (const FittedParameter& p : fitted) {
    const h5::Group one = parameters.make_group(p.name);
    one.write_scalar("value", p.value, p.unit);
    one.write_scalar("lower", p.lower, p.unit);
    one.write_scalar("upper", p.upper, p.unit);
    one.write_scalar("standard_error", p.standard_error, p.unit);
    one.write_scalar("interval_factor", p.factor);
    if (!std::isnan(p.low)) {
      one.write_scalar("interval_low", p.low, p.unit);
      one.write_scalar("interval_high", p.high, p.unit);
    }
    if (std::isfinite(p.truth)) one.write_scalar("truth", p.truth, p.unit);
    if (!p.key.empty()) one.attribute("key", p.key);
    append(order, " ", p.name);
  }
  parameters.attribute("order", order);
}

// One group per test with its points, measured and computed.
void write_tests(const h5::Group& root, const std::vector<FittedTest>& fitted) {
  const h5::Group tests = root.make_group("tests");
  std::string names;
  for (const FittedTest& test : fitted) {
    const h5::Group one = tests.make_group(test.name);
    one.attribute("kind", test.kind);
    one.attribute("measure", test.measure);
    one.write_scalar("fibre_angle", test.fibre_angle_deg, "deg");
    one.write_scalar("weight", test.weight);
    write_vector(one, "first", test.first, "-");
    write_vector(one, "second", test.second, "-");
    write_vector(one, "stress_x", test.stress_x, "MPa");
    write_vector(one, "stress_z", test.stress_z, "MPa");
    write_vector(one, "model_x", test.model_x, "MPa");
    write_vector(one, "model_z", test.model_z, "MPa");
    one.write_scalar("r2", test.r2);
    one.write_scalar("mean_error", test.mean_error_percent, "percent");
    one.write_scalar("max_error", test.max_error_percent, "percent");
    append(names, " ", test.name);
  }
  tests.attribute("order", names);
}

// Curves and fields that were measured in scenes; groups are numbered from 1.
void write_curves_of_scenes(const h5::Group& root, const std::vector<FittedCurve>& fitted) {
  if (fitted.empty()) return;
  const h5::Group scenes = root.make_group("scenes");
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const FittedCurve& curve = fitted[i];
    const h5::Group one = scenes.make_group(std::to_string(i + 1));
    one.attribute("name", curve.name);
    one.attribute("quantity", curve.quantity);
    one.attribute("over", curve.x_name);
    one.write_scalar("standard_deviation", curve.standard_deviation, curve.unit);
    write_vector(one, "x", curve.x, curve.x_unit);
    write_vector(one, "measured", curve.measured, curve.unit);
    write_vector(one, "model", curve.model, curve.unit);
    if (!curve.places.empty())
      one.write<double>("place", {curve.places.size(), 3}, flat(curve.places), "mm");
    one.write_scalar("r2", curve.r2);
    one.write_scalar("mean_error", curve.mean_error_percent, "percent");
    one.write_scalar("max_error", curve.max_error_percent, "percent");
    one.write_scalar("discretisation_error", curve.discretisation_percent, "percent");
  }
}

std::vector<FittedCurve> read_curves_of_scenes(const h5::Group& root) {
  std::vector<FittedCurve> fitted;
  if (!root.has("scenes")) return fitted;
  const h5::Group scenes = root.group("scenes");
  for (int i = 1; scenes.has(std::to_string(i)); ++i) {
    const h5::Group one = scenes.group(std::to_string(i));
    FittedCurve curve;
    curve.name = one.text_attribute("name");
    curve.quantity = one.text_attribute("quantity");
    curve.unit = one.unit("measured");
    curve.x_name = one.text_attribute("over");
    curve.x_unit = one.unit("x");
    curve.standard_deviation = one.read_scalar("standard_deviation");
    curve.x = one.read_finite("x", {h5::any});
    curve.measured = one.read_finite("measured", {curve.x.size()});
    curve.model = one.read_finite("model", {curve.x.size()});
    if (one.has("place")) {
      const std::vector<double> all = one.read_finite("place", {curve.x.size(), 3});
      for (std::size_t k = 0; k < all.size(); k += 3)
        curve.places.push_back({all[k], all[k + 1], all[k + 2]});
    }
    curve.r2 = one.read_scalar("r2");
    curve.discretisation_percent = one.read_scalar("discretisation_error");
    curve.mean_error_percent = one.read_scalar("mean_error");
    curve.max_error_percent = one.read_scalar("max_error");
    fitted.push_back(std::move(curve));
  }
  return fitted;
}

// The root mean square of the difference between a measured curve and the model.
double rms_difference(const FittedCurve& c) {
  double square = 0;
  for (std::size_t i = 0; i < c.model.size(); ++i)
    square += (c.model[i] - c.measured[i]) * (c.model[i] - c.measured[i]);
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(c.model.size(), 1)));
}

// The numbers of a fit that `gather` collects.
std::vector<Summary> summary_of(const FitRecord& fit) {
  std::vector<Summary> summary;
  for (const FittedParameter& p : fit.parameters) summary.push_back({p.name, p.value, p.unit});
  if (!fit.curves.empty())
    for (const FittedParameter& p : fit.parameters)
      summary.push_back({p.name + "_standard_error", p.standard_error, p.unit});
  for (const FittedCurve& c : fit.curves)
    summary.push_back({c.name + "_rms", rms_difference(c), c.unit});
  summary.push_back({"mean_error", fit.mean_error_percent, "percent"});
  summary.push_back({"max_error", fit.max_error_percent, "percent"});
  summary.push_back({"r2", fit.r2, "-"});
  summary.push_back({"aicc", fit.aicc, "-"});
  summary.push_back({"bic", fit.bic, "-"});
  if (fit.noise.model != "white") {
    summary.push_back({"noise_correlation", fit.noise.correlation, "-"});
    summary.push_back({"noise_share", fit.noise.share, "-"});
  }
  if (std::isfinite(fit.left_out_error_percent))
    summary.push_back({"left_out_error", fit.left_out_error_percent, "percent"});
  summary.push_back({"cost", fit.cost, "-"});
  summary.push_back({"kkt_residual", fit.kkt_residual, "-"});
  return summary;
}

// Groups /fit, /curve, /tests and /scenes, the summary and the study.
void write_fit(const h5::Group& root, const FitRecord& fit) {
  const h5::Group group = root.make_group("fit");
  write_parameters(group, fit.parameters);
  write_matrix(group, "covariance", fit.covariance, "");
  write_matrix(group, "correlation", correlation(fit.covariance), "-");
  write_matrix(group, "starts", fit.starts, "");
  group.write_scalar("cost", fit.cost, "MPa^2");
  group.write_scalar("kkt_residual", fit.kkt_residual);
  group.write_scalar("mean_error", fit.mean_error_percent, "percent");
  group.write_scalar("max_error", fit.max_error_percent, "percent");
  group.write<double>("strain_range", {2}, std::vector{fit.strain_min, fit.strain_max}, "-");
  std::vector<double> residual;
  for (std::size_t i = 0; i < fit.stress.size(); ++i)
    residual.push_back(fit.model[i] - fit.stress[i]);
  write_vector(group, "residual", residual, "MPa");
  group.write_scalar("r2", fit.r2);
  group.write_scalar("aicc", fit.aicc);
  group.write_scalar("bic", fit.bic);
  group.write_scalar("residual_correlation", fit.residual_correlation, "-");
  group.write_scalar("effective_values", fit.effective_values, "-");
  write_noise(group.make_group("noise"), fit.noise);
  if (std::isfinite(fit.left_out_error_percent))
    group.write_scalar("left_out_error", fit.left_out_error_percent, "percent");
  std::string ties;
  for (const Tie& tie : fit.ties) append(ties, "; ", tie.key + " = " + tie_text(tie));
  if (!ties.empty()) group.attribute("ties", ties);
  if (fit.at_rest) write_at_rest(group.make_group("at_rest"), *fit.at_rest);

  const h5::Group curve = root.make_group("curve");
  write_vector(curve, "strain", fit.strain, "-");
  write_vector(curve, "stress", fit.stress, "MPa");
  write_vector(curve, "model", fit.model, "MPa");
  write_tests(root, fit.tests);
  write_curves_of_scenes(root, fit.curves);
  write_summary(root, summary_of(fit));
  write_study(root, fit.study);
  write_tables(root, fit.tables);
  if (fit.population) write_population(root, *fit.population);
}

// One tie of the text below; nothing if it cannot be read.
std::optional<Tie> read_tie(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t first = text.find_first_not_of(' ');
  if (equals == std::string::npos || equals == 0 || first >= equals) return std::nullopt;
  const std::size_t last = text.find_last_not_of(' ', equals - 1);
  return parse_tie(text.substr(first, last + 1 - first), text.substr(equals + 1));
}

// The ties of an attribute: "fibres[1].alpha = -fibres[0].alpha; ...".
std::vector<Tie> read_ties(const std::string& text) {
  std::vector<Tie> ties;
  std::istringstream all(text);
  for (std::string one; std::getline(all, one, ';');) {
    if (const auto tie = read_tie(one)) ties.push_back(*tie);
  }
  return ties;
}

// The inverse of write_tests() for one test. Measured and computed columns must have the length
// of the stretches.
FittedTest read_test(const h5::Group& one, const std::string& name) {
  FittedTest test;
  test.name = name;
  test.kind = one.text_attribute("kind");
  test.measure = one.text_attribute("measure");
  check_units(one, {{"fibre_angle", "deg"},
                    {"first", "-"},
                    {"second", "-"},
                    {"stress_x", "MPa"},
                    {"stress_z", "MPa"},
                    {"model_x", "MPa"},
                    {"model_z", "MPa"},
                    {"mean_error", "percent"},
                    {"max_error", "percent"}});
  test.fibre_angle_deg = one.read_scalar("fibre_angle");
  test.weight = one.read_scalar("weight");
  test.first = one.read_finite("first", {h5::any});
  test.second = one.read_finite("second", {h5::any});
  test.stress_x = one.read_finite("stress_x", {test.first.size()});
  test.stress_z = one.read_finite("stress_z", {h5::any});
  test.model_x = one.read_finite("model_x", {test.first.size()});
  test.model_z = one.read_finite("model_z", {test.stress_z.size()});
  test.r2 = one.read_scalar("r2");
  test.mean_error_percent = one.read_scalar("mean_error");
  test.max_error_percent = one.read_scalar("max_error");
  return test;
}

// One fitted parameter. Its bounds and its error must have the unit of its value.
FittedParameter read_parameter(const h5::Group& one, const std::string& name) {
  require_known_unit(one, "value");
  for (const char* other : {"lower", "upper", "standard_error"})
    require_unit(one, other, one.unit("value"));
  FittedParameter p{name,
                    one.unit("value"),
                    one.read_scalar("value"),
                    one.read_scalar("lower"),
                    one.read_scalar("upper"),
                    one.read_scalar("standard_error")};
  if (one.has("truth")) p.truth = one.read_scalar("truth");
  if (one.has("interval_factor")) p.factor = one.read_scalar("interval_factor");
  if (one.has("interval_low")) {
    p.low = one.read_scalar("interval_low");
    p.high = one.read_scalar("interval_high");
  }
  if (one.has_attribute("key")) p.key = one.text_attribute("key");
  return p;
}

// The record of a fit. Parts that older files lack keep their defaults.
FitRecord read_fit(const h5::Group& root) {
  const h5::Group group = root.group("fit");
  const h5::Group parameters = group.group("parameters");
  const h5::Group curve = root.group("curve");
  check_units(group, {{"cost", "MPa^2"},
                      {"mean_error", "percent"},
                      {"max_error", "percent"},
                      {"strain_range", "-"}});
  check_units(curve, {{"strain", "-"}, {"stress", "MPa"}, {"model", "MPa"}});
  FitRecord fit;
  std::istringstream order(parameters.text_attribute("order"));
  for (std::string name; order >> name;)
    fit.parameters.push_back(read_parameter(parameters.group(name), name));
  // The covariance has one row for each parameter.
  const std::size_t p = fit.parameters.size();
  fit.covariance = read_matrix(group, "covariance", {p, p});
  fit.starts = read_matrix(group, "starts", {h5::any, h5::any});
  fit.cost = group.read_scalar("cost");
  fit.kkt_residual = group.read_scalar("kkt_residual");
  fit.mean_error_percent = group.read_scalar("mean_error");
  fit.max_error_percent = group.read_scalar("max_error");
  const auto range = group.read_finite("strain_range", {2});
  fit.strain_min = range[0];
  fit.strain_max = range[1];
  fit.strain = curve.read_finite("strain", {h5::any});
  fit.stress = curve.read_finite("stress", {fit.strain.size()});
  fit.model = curve.read_finite("model", {fit.strain.size()});
  fit.curves = read_curves_of_scenes(root);
  if (root.has("identifiability") && root.group("identifiability").has("bootstrap"))
    fit.sets =
        read_matrix(root.group("identifiability").group("bootstrap"), "samples", {h5::any, p});
  fit.r2 = group.read_scalar("r2");
  fit.aicc = group.read_scalar("aicc");
  fit.bic = group.read_scalar("bic");
  // Tests in the order of the config.
  const h5::Group tests = root.group("tests");
  std::istringstream names(tests.text_attribute("order"));
  for (std::string name; names >> name;) {
    fit.tests.push_back(read_test(tests.group(name), name));
  }
  if (group.has("at_rest")) fit.at_rest = read_at_rest(group.group("at_rest"));
  if (group.has("residual_correlation"))
    fit.residual_correlation = group.read_scalar("residual_correlation");
  if (group.has("effective_values")) fit.effective_values = group.read_scalar("effective_values");
  if (group.has("noise")) fit.noise = read_noise(group.group("noise"));
  if (group.has("left_out_error")) fit.left_out_error_percent = group.read_scalar("left_out_error");
  if (group.has_attribute("ties")) fit.ties = read_ties(group.text_attribute("ties"));
  fit.study = read_study(root);
  fit.tables = read_tables(root);
  if (root.has("population")) fit.population = read_population(root);
  return fit;
}

}  // namespace

std::array<double, 2> interval_95(const FittedParameter& p) {
  if (!std::isnan(p.low)) return {p.low, p.high};
  const double half = p.factor * p.standard_error;
  return {p.value - half, p.value + half};
}

MatX correlation(const MatX& covariance) {
  const VecX deviation = covariance.diagonal().cwiseSqrt();
  MatX r = MatX::Constant(covariance.rows(), covariance.cols(),
                          std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    for (Eigen::Index j = 0; j < r.cols(); ++j)
      if (std::isgreater(deviation[i], 0) && std::isgreater(deviation[j], 0))
        r(i, j) = covariance(i, j) / deviation[i] / deviation[j];
  return r;
}

void write_material(const std::string& path, const Material& material,
                    const std::optional<FitRecord>& fit, const Identity& identity) {
  h5::File file = h5::File::create(path);
  write_identity(file.root(), material_schema, identity);
  write_listing(file.root().make_group("material"), material);
  if (fit) write_fit(file.root(), *fit);
  file.commit();
}

MaterialFile read_material(const std::string& path) {
  const h5::File file = h5::File::open(path);
  MaterialFile result;
  result.content_id =
      content_id(read_identity(file.root(), material_schema), material_schema.version);
  read_listing(file.root().group("material"), result.material);
  if (file.root().has("fit")) result.fit = read_fit(file.root());
  return result;
}

}  // namespace langer
