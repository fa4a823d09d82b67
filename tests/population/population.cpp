#include "identification/population/population_fit.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.hpp"
#include "identification/inverse/parameter_sample.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "support/near.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

FitConfig config_of(Tree tree) { return read_config<FitConfig>(std::move(tree)).config; }

FitConfig synthetic(const std::string& more = "") {
  Tree tree = load_yaml(SOURCE_DIR "/configs/fit/population.yaml");
  if (!more.empty()) {
    const Tree other = parse_yaml(more, "test", SOURCE_DIR "/configs/fit");
    for (const Tree::Entry& entry : other.map) set_value(tree, entry.key, entry.value);
  }
  return config_of(tree);
}

PopulationOutcome outcome_of(const FitConfig& config) {
  return fit_population(config, [](const std::string&) { return Place{}; });
}

double value(const RecordTable& table, const std::string& row, const std::string& column) {
  RecordTable copy = table;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i] == row) return copy.column(column).values.at(i);
  return 0;
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

// Three specimens of a neo-Hookean law, one test each, in files of their own.
fs::path small_study(const std::string& name, const std::string& table) {
  const fs::path folder = fs::path(BINARY_DIR) / "test_files" / name;
  fs::remove_all(folder);
  write(folder / "specimens.csv", table);
  for (const auto& [id, a1] : {std::pair("A", 0.01), {"B", 0.012}, {"C", 0.02}}) {
    std::string curve = "strain,nominal_stress_MPa\n";
    for (int i = 0; i <= 5; ++i) {
      const double l = 1 + 0.05 * i;
      // a little noise of either sign
      const double noise = 1e-5 * ((i * 7 + static_cast<int>(a1 * 1000)) % 3 - 1);
      curve += fmt::format("{},{}\n", 0.05 * i, i == 0 ? 0 : 2 * a1 * (l - 1 / (l * l)) + noise);
    }
    write(folder / "curves" / (std::string(id) + "_tension.csv"), curve);
  }
  return folder;
}

Tree small_config(const fs::path& folder, const std::string& more = "") {
  return parse_yaml(
      "specimens: {table: specimens.csv, data: \"curves/{id}_{test}.csv\"" + more +
          "}\nlaw: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1e-6}}}\n"
          "bounds: admissible\nparameters: [{key: matrix.neo_hooke.a1}]\nstarts: 2\n",
      "fit.yaml", folder.string());
}

std::string refusal(const Tree& tree) {
  try {
    config_of(tree);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a synthetic population lies inside the intervals that are found") {
  const PopulationOutcome found = outcome_of(synthetic());
  const RecordTable& table = found.record.tables.front();
  // deviations of logarithms and of the angle, as data/synthetic_population.py has them
  const std::map<std::string, double> truth{
      {"a1", 0.012}, {"c1", 0.06}, {"c2", 1.2}, {"alpha", 35}};
  const std::map<std::string, double> cv{{"a1", std::sqrt(std::expm1(0.35 * 0.35))},
                                         {"c1", std::sqrt(std::expm1(0.45 * 0.45))},
                                         {"c2", std::sqrt(std::expm1(0.25 * 0.25))},
                                         {"alpha", 4. / 35}};
  for (const auto& [name, exact] : truth) {
    const auto shown = name;
    INFO(shown);
    CHECK(value(table, name, "lower_95") < exact);
    CHECK(value(table, name, "upper_95") > exact);
    CHECK(value(table, name, "cv_lower_95") < cv.at(name));
    CHECK(value(table, name, "cv_upper_95") > cv.at(name));
    CHECK(value(table, name, "true") == exact);
  }
  const PopulationRecord& population = *found.record.population;
  const double correlation =
      population.scatter(0, 1) / std::sqrt(population.scatter(0, 0) * population.scatter(1, 1));
  CHECK(correlation == near(0.8, 0.15));
  // the two ways that are often taken in its place are off, in the direction of the convex law
  CHECK(value(table, "c1", "average_of_fits") > 1.05 * value(table, "c1", "population_median"));
  CHECK(value(table, "a1", "fit_of_mean_curve") > 1.04 * value(table, "a1", "population_median"));

  SUBCASE("people who are drawn from it scatter as it does") {
    MaterialFile file;
    file.material = found.median;
    file.fit = found.record;
    CHECK(reason_without_samples(file, 5000).empty());
    double mean = 0;
    double square = 0;
    constexpr int n = 2000;
    for (int i = 1; i <= n; ++i) {
      const double x = std::log(sample_of(file, i).values.at(0).value);
      mean += x / n;
      square += x * x / n;
    }
    CHECK(std::exp(mean) == near(value(table, "a1", "population_median"), 0.03));
    CHECK(std::sqrt(square - mean * mean) == near(std::sqrt(population.scatter(0, 0)), 0.06));
  }
}

TEST_CASE("a number that specimens share differs between those who are drawn by its error alone") {
  const PopulationOutcome found = outcome_of(
      synthetic("specimens: {table: ../../data/synthetic_population_specimens.csv, "
                "data: ../../data/synthetic_population.csv, where: {specimen: \"{id}\"}, "
                "split: test, shared: [matrix.neo_hooke.a1], people: 20}\n"));
  MaterialFile file;
  file.material = found.median;
  file.fit = found.record;
  const double median_a1 = value(found.record.tables.front(), "a1", "population_median");
  const double error_a1 = std::sqrt(file.fit->population->median_covariance(0, 0));
  double square_away = 0;
  double least = 1;
  double largest = 0;
  for (int i = 1; i <= 20; ++i) {
    const std::vector<Summary> values = sample_of(file, i).values;
    // known as well as its median, and no better
    const double away = std::log(values.at(0).value / median_a1) / error_a1;
    CHECK(std::abs(away) < 4);
    square_away += away * away / 20;
    least = std::min(least, values.at(1).value);
    largest = std::max(largest, values.at(1).value);
  }
  // the mean of twenty squares of normal numbers
  CHECK(square_away == near(1, 0, 4 * std::sqrt(2. / 20)));
  CHECK(least > 0);
  CHECK(largest > 2 * least);
  for (const auto& [name, text] : found.files) {
    if (name != "prediction.csv") continue;
    CHECK(!contains(text, "nan"));
  }
  CHECK(std::ranges::any_of(found.lines, [](const std::string& line) {
    return contains(line, "a1  median") && contains(line, "the same in all specimens");
  }));
}

TEST_CASE("nlme of R finds the same population") {
  if (std::system("Rscript -e 'library(nlme)' > /dev/null 2>&1") != 0) {
    MESSAGE("skipped: R with nlme is not installed (apt install r-cran-nlme)");
    return;
  }
  FILE* pipe = popen("Rscript " SOURCE_DIR "/tests/population/nlme.R " SOURCE_DIR
                     "/data/synthetic_population.csv 2> /dev/null",
                     "r");
  REQUIRE(pipe);
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  REQUIRE(pclose(pipe) == 0);
  std::istringstream in(text);
  double median[4], error[4], scatter[4][4], sigma = 0, log_likelihood = 0;
  for (double& x : median) in >> x;
  for (double& x : error) in >> x;
  for (auto& row : scatter)
    for (double& x : row) in >> x;
  in >> sigma >> log_likelihood;
  REQUIRE(in);
  FitConfig config = synthetic();
  config.specimens->people = 0;
  const PopulationOutcome found = outcome_of(config);
  const PopulationRecord& population = *found.record.population;
  for (Eigen::Index i = 0; i < 4; ++i) {
    CHECK(std::abs(population.median[i] - median[i]) < 1e-3 * error[i]);
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double size = std::sqrt(scatter[i][i] * scatter[j][j]);
      CHECK(std::abs(population.scatter(i, j) - scatter[i][j]) < 0.01 * size);
    }
  }
  CHECK(population.sigma == near(sigma, 1e-4));
  CHECK(found.record.noise.minus_two_log_likelihood == near(-2 * log_likelihood, 1e-7));
}

TEST_CASE("white noise of many specimens is found to be white, or nearly so") {
  FitConfig config = synthetic();
  config.noise_model = NoiseKind::automatic;
  config.specimens->people = 0;
  config.jobs = 1;
  std::vector<std::string> said;
  const PopulationOutcome found = fit_population(
      config, [](const std::string&) { return Place{}; },
      [&](const std::string& line) { said.push_back(line); });
  CHECK(said.size() == 4);
  // noise that was white is found to be so, or nearly: a wider model may win by chance
  CHECK(found.record.noise.correlation < 0.2);
  CHECK(found.record.noise.share < 0.2);
}

TEST_CASE("a covariate without an effect is not found significant, and its table is written") {
  FitConfig config = synthetic();
  config.specimens->covariates.push_back({"age", {"matrix.neo_hooke.a1"}});
  config.specimens->people = 0;
  const PopulationOutcome found = outcome_of(config);
  std::string effects;
  for (const PopulationFile& file : found.files)
    if (file.name == "effects.csv") effects = file.text;
  std::istringstream in(effects);
  std::string head, row;
  std::getline(in, head);
  std::getline(in, row);
  CHECK(head == "covariate,parameter,effect,lower_95,upper_95,ratio,test,probability");
  CHECK(contains(row, "age,a1,"));
  const double probability = std::atof(row.substr(row.rfind(',') + 1).c_str());
  CHECK(probability > 0.01);
  CHECK(probability < 1);
}

TEST_CASE("files of specimens are found by the pattern of their names") {
  const fs::path folder = small_study("specimens_good", "id,age\nA,20\nB,30\nC,50\n");
  const FitConfig config = config_of(small_config(folder));
  REQUIRE(config.data.size() == 3);
  CHECK(config.data[1].specimen == "B");
  CHECK(config.data[1].name == "tension");
  const PopulationOutcome found = outcome_of(config);
  // a1 of the three is 0.010, 0.012 and 0.020 MPa: the median is their geometric mean
  CHECK(found.record.parameters[0].value == near(std::cbrt(0.01 * 0.012 * 0.02), 0.02));
}

TEST_CASE("a search without a population leaves what it reached, and the fits of the specimens") {
  const fs::path folder = small_study("specimens_without", "id,age\nA,20\nB,30\nC,50\n");
  // tension of specimens without fibres says nothing of the angle of fibres
  const FitConfig config = config_of(parse_yaml(
      "specimens: {table: specimens.csv, data: \"curves/{id}_{test}.csv\"}\n"
      "law: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1e-6}}, "
      "fibres: [{hgo: {c1: 0.02, c2: 3}, alpha: 30, kappa: 0}]}\nbounds: admissible\n"
      "parameters: [{key: matrix.neo_hooke.a1}, {key: \"fibres[0].alpha\"}]\nstarts: 2\n",
      "fit.yaml", folder.string()));
  const PopulationOutcome found = outcome_of(config);
  REQUIRE(found.no_result);
  CHECK(contains(found.no_result->found, "modes and population still change"));
  REQUIRE(found.files.size() == 2);
  CHECK(found.files[0].name == "reached.csv");
  CHECK(contains(found.files[0].text, "\na1,matrix.neo_hooke.a1,0.013"));
  CHECK(found.files[1].name == "reached_specimens.csv");
  CHECK(contains(found.files[1].text, "\nA,1,6,0.0099"));
}

TEST_CASE("a median that the tests do not know, or outside its bounds, is no result") {
  const fs::path folder = small_study("specimens_unknown", "id,age\nA,20\nB,30\nC,50\n");
  const auto outcome = [&](const std::string& specimens, const std::string& law,
                           const std::string& rest) {
    return outcome_of(config_of(parse_yaml(
        "specimens: {table: specimens.csv, data: \"curves/{id}_{test}.csv\"" + specimens +
            "}\nlaw: {matrix: {neo_hooke: {a1: 0.02}}, volume: {quadratic: {d: 1e-6}}" + law +
            "}\n" + rest + "starts: 2\n",
        "fit.yaml", folder.string())));
  };
  // tension of specimens without fibres says nothing of the angle of fibres
  const auto of_angle = [&](const std::string& start, const std::string& noise) {
    return outcome(", shared: [matrix.neo_hooke.a1]",
                   ", fibres: [{hgo: {c1: 0.02, c2: 3}, alpha: " + start + ", kappa: 0}]",
                   "bounds: admissible\nnoise: " + noise +
                       "\nparameters: [{key: matrix.neo_hooke.a1}, {key: \"fibres[0].alpha\"}]\n");
  };

  SUBCASE("a search that ends far from every specimen") {
    const PopulationOutcome found = of_angle("30", "autoregressive");
    REQUIRE(found.no_result);
    CHECK(contains(found.no_result->found, "the tests do not know the median of"));
    CHECK(found.files[0].name == "reached.csv");
  }
  SUBCASE("an angle that the stress does not depend on") {
    const PopulationOutcome found = of_angle("0", "white");
    REQUIRE(found.no_result);
    CHECK(contains(found.no_result->found,
                   "the tests do not know the median of alpha: its interval is wider than all"));
  }
  SUBCASE("bounds below the modulus of all specimens") {
    const PopulationOutcome found = outcome(
        "", "",
        "bounds: admissible\n"
        "parameters: [{key: matrix.neo_hooke.a1, lower: 0.001, upper: 0.009, start: 0.005}]\n");
    REQUIRE(found.no_result);
    INFO(found.no_result->found);
    CHECK(contains(found.no_result->found,
                   "the median of a1, 0.01339, is outside its bounds 0.001 to 0.009"));
  }
}

TEST_CASE("what is wrong with a table of specimens is named at its line") {
  const auto refused = [](const std::string& table, const std::string& more = "") {
    return refusal(small_config(small_study("specimens_bad", table), more));
  };
  CHECK(contains(refused("id,age\nA,20\n"), "specimens.csv:2:1: specimens.table: 1 specimen"));
  CHECK(contains(refused("id,age\nA,20\nB,30\nC,40\nD,50\n"),
                 "specimens.csv:5:1: specimens: specimen D without a test"));
  CHECK(
      contains(refused("id,age\nA,20\nB,30\n"), "curves/C_tension.csv: C is not in specimens.csv"));
  CHECK(contains(refused("id,age\nA,20\nB,30\nB,40\n"),
                 "specimens.csv:4:1: specimen B a second time"));
  CHECK(contains(refused("id,age\nA,20\nB,20\nC,20\n", ", covariates: [age]"),
                 "specimens.csv:1:4: age: 20 for every specimen"));
  CHECK(contains(refused("id,age\nA,20\nB,\nC,30\n", ", covariates: [age]"),
                 "specimens.csv:3:1: age: specimen B without a value"));
  CHECK(contains(refused("id,age\nA,20\nB,30\nC,40\n", ", covariates: [aeg]"),
                 "no column is called aeg"));
  CHECK(contains(refused("id,age\nA,20\nB,30\nC,40\n", ", shared: [matrix.neo_hooke.a2]"),
                 "specimens.shared[0]: found \"matrix.neo_hooke.a2\""));
}

TEST_CASE("mouse skin of two ages and two sites has a population") {
  const std::string file = SOURCE_DIR "/../shared/data/murine_skin_biaxial.csv";
  const std::string other = SOURCE_DIR "/../../shared/data/murine_skin_biaxial.csv";
  const std::string data = fs::exists(file) ? file : other;
  if (!fs::exists(data)) {
    MESSAGE("skipped: no ../shared/data/murine_skin_biaxial.csv");
    return;
  }
  // the table of the specimens, from the columns of the data
  std::ifstream in(data);
  std::map<std::string, std::string> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#') || line.starts_with("subject")) continue;
    std::istringstream cells(line);
    std::string subject, sample, age, site;
    std::getline(cells, subject, ',');
    std::getline(cells, sample, ',');
    std::getline(cells, age, ',');
    std::getline(cells, site, ',');
    rows[subject + "-" + sample] = subject + "," + sample + "," + age + "," + site;
  }
  std::string table = "id,subject,sample,age,site\n";
  for (const auto& [id, row] : rows) table += id + "," + row + "\n";
  const fs::path folder = fs::path(BINARY_DIR) / "test_files" / "mouse_skin";
  write(folder / "specimens.csv", table);
  const FitConfig config = config_of(parse_yaml(
      "data: [{kind: biaxial, columns: {strain_x: stretch_x, strain_z: stretch_y, stress_x: "
      "cauchy_stress_x_MPa, stress_z: cauchy_stress_y_MPa}, strain: stretch, stress: cauchy}]\n"
      "specimens:\n  table: specimens.csv\n  data: \"" +
          fs::absolute(data).string() +
          "\"\n  where: {subject: \"{subject}\", sample: \"{sample}\"}\n  split: protocol\n"
          "  covariates: [age, site]\n  people: 0\n"
          "law: {matrix: {neo_hooke: {a1: 0.001}}, fibres: [{hgo: {c1: 0.02, c2: 3}, alpha: 0, "
          "kappa: 0.3}], volume: {quadratic: {d: 1e-6}}}\nbounds: admissible\nnoise: white\n"
          "parameters: [{key: \"fibres[0].hgo.c1\"}, {key: \"fibres[0].hgo.c2\"}]\nstarts: 4\n",
      "fit.yaml", folder.string()));
  const PopulationOutcome found = outcome_of(config);
  const RecordTable& result = found.record.tables.front();
  CHECK(rows.size() > 20);
  for (const char* name : {"c1", "c2"}) {
    CHECK(value(result, name, "lower_95") > 0);
    CHECK(value(result, name, "between_specimen_cv") > 0.1);
    CHECK(value(result, name, "between_specimen_cv") < 5);
  }
  std::string effects;
  for (const PopulationFile& one : found.files)
    if (one.name == "effects.csv") effects = one.text;
  for (const char* name : {"age=young,c1", "age=young,c2", "site=ventral,c1", "site=ventral,c2"})
    CHECK(contains(effects, name));
}
