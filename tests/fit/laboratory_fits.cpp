// Fits of files as laboratories write them: the numbers that the curves were made from are found,
// whatever the headings, signs, units and times of the file.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/fit_config_io.hpp"

using namespace langer;

namespace laboratory_fits_tests {

namespace {

const std::string folder = BINARY_DIR "/tests/laboratory_fits";

void write(const std::string& name, const std::string& text) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + name) << text;
}

FitConfig config(const std::string& item, const std::string& law, const std::string& parameters) {
  const std::string yaml = "data: [{" + item + "}]\nlaw: {" + law +
                           "}\nbounds: admissible\nstarts: 5\nparameters: [" + parameters + "]\n";
  return read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder)).config;
}

VecX fitted(const FitConfig& config) {
  return fit(fit_problem(config), {config.searches(), 1, {}}).best.p;
}

std::string refusal(const FitConfig& config) {
  try {
    measured_tests(config);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "accepted";
}

bool holds(const std::string& text, const std::string& part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

const std::string neo_hooke = "matrix: {neo_hooke: {a1: 0.03}}, volume: {quadratic: {d: 1e-6}}";
const std::string a1 = "{key: matrix.neo_hooke.a1}";
const std::string a1_and_fibres =
    a1 +
    ", {key: \"fibres[0].hgo.c1\"}, {key: \"fibres[0].hgo.c2\", upper: 200}, {key: \"fibres[0].alpha\"}";

// Incompressible neo-Hookean tension: the nominal stress of an energy a1 (I1 - 3) [MPa].
double nominal_stress(double a, double stretch) {
  return 2 * a * (stretch - 1 / (stretch * stretch));
}

// A step to the stretch 1.3 at t = 0 of a solid with two branches, read at times spaced by
// logarithm.
constexpr double long_term = 0.02;
constexpr double gamma_1 = 0.5, tau_1 = 0.3;
constexpr double gamma_2 = 0.4, tau_2 = 20;

double relaxed(double seconds) {
  return nominal_stress(long_term, 1.3) *
         (1 + gamma_1 * std::exp(-seconds / tau_1) + gamma_2 * std::exp(-seconds / tau_2));
}

std::string relaxation_table(double unit, double shift) {
  std::string text = "time,stretch,nominal_stress_MPa\n";
  for (int i = 0; i <= 30; ++i) {
    const double t = 0.1 * std::pow(10, 0.1 * i);
    text += fmt::format("{:.12g},1.3,{:.12g}\n", (t + shift) / unit, relaxed(t));
  }
  return text;
}

const std::string two_branches =
    neo_hooke + ", viscous: [{tau: 0.3, gamma: 0.2}, {tau: 20, gamma: 0.2}]";
const std::string of_two_branches =
    a1 +
    ", {key: \"viscous[0].gamma\"}, {key: \"viscous[1].gamma\"}, {key: \"viscous[0].tau\"}, "
    "{key: \"viscous[1].tau\"}";
const std::string timed = "columns: {time: time, strain_x: stretch, stress_x: nominal_stress_MPa}";

// The two branches may be found in either order.
void check_branches(const VecX& p) {
  const Eigen::Index fast = p[3] < p[4] ? 0 : 1;
  const Eigen::Index slow = 1 - fast;
  CHECK(std::abs(p[0] - long_term) < 1e-6);
  CHECK(std::abs(p[1 + fast] - gamma_1) < 1e-4);
  CHECK(std::abs(p[1 + slow] - gamma_2) < 1e-4);
  CHECK(std::abs(p[3 + fast] - tau_1) < 1e-4);
  CHECK(std::abs(p[3 + slow] - tau_2) < 1e-2);
}

}  // namespace

TEST_CASE("a relaxation table without t = 0 asks when the step was, and finds its branches then") {
  write("relaxation.csv", relaxation_table(1, 0));
  const std::string item = "file: relaxation.csv, " + timed;
  const std::string asked = refusal(config(item, two_branches, of_two_branches));
  CHECK(holds(asked, "relaxation.csv:1:1: step_at: missing: the first reading, at 0.1 s"));
  check_branches(fitted(config(item + ", step_at: 0", two_branches, of_two_branches)));

  // in minutes, and where the clock was not zero
  write("minutes.csv", relaxation_table(60, 0));
  check_branches(fitted(config("file: minutes.csv, time_unit: min, step_at: 0, " + timed,
                               two_branches, of_two_branches)));
  write("later.csv", relaxation_table(1, 12.5));
  check_branches(
      fitted(config("file: later.csv, step_at: 12.5, " + timed, two_branches, of_two_branches)));

  // an elastic law does not remember the step, and a first reading at t = 0 is the step
  CHECK(refusal(config(item, neo_hooke, a1)) == "accepted");
  write("from_0.csv", relaxation_table(1, -0.1));
  CHECK(refusal(config("file: from_0.csv, " + timed, two_branches, of_two_branches)) == "accepted");
}

TEST_CASE("a ramp is followed, and has to end before the first reading") {
  // The same ramp, once in the file and once as a key: the stresses of a law agree.
  write("relaxation.csv", relaxation_table(1, 0));
  const auto by_key = [&](const std::string& keys) {
    return config("file: relaxation.csv, " + timed + ", " + keys, two_branches, of_two_branches);
  };
  const FitConfig with_ramp = by_key("step_at: -0.05, ramp: 0.1");
  Test test = measured_tests(with_ramp).at(0);
  REQUIRE(test.before.time.size() == 21);
  CHECK(std::abs(test.before.time.front() + 0.05) < 1e-12);
  CHECK(std::abs(test.before.time.back() - 0.05) < 1e-12);
  CHECK(std::abs(test.before.first[10] - 1.15) < 1e-12);
  std::vector<double> by_ramp(test.values());
  REQUIRE(model_stress(with_ramp.law, test, Dilatation::incompressible, by_ramp.data()));

  // A ramp of no duration is the step.
  Test step = measured_tests(by_key("step_at: 0, ramp: 0")).at(0);
  Test brief = measured_tests(by_key("step_at: 0, ramp: 1e-6")).at(0);
  std::vector<double> at_once(step.values());
  std::vector<double> at_last(brief.values());
  REQUIRE(model_stress(with_ramp.law, step, Dilatation::incompressible, at_once.data()));
  REQUIRE(model_stress(with_ramp.law, brief, Dilatation::incompressible, at_last.data()));
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    CHECK(std::abs(at_once[i] - at_last[i]) < 1e-6 * at_once[0]);
  }
  // A ramp about the time of the step relaxes little else: by its second order in ramp / tau.
  CHECK(std::abs(by_ramp[0] / at_once[0] - 1) < 0.01);
  CHECK(by_ramp[0] != at_once[0]);

  // without step_at it ends at the first reading
  const Test to_first = measured_tests(by_key("ramp: 0.1")).at(0);
  CHECK(std::abs(to_first.before.time.front()) < 1e-12);
  CHECK(holds(refusal(by_key("step_at: 0, ramp: 0.2")),
              "step_at: found a step that ends at 0.2 s, and a first reading at 0.1 s"));
}

TEST_CASE("a ramp and hold in minutes is the record in seconds") {
  const auto record = [](const std::string& heading, double unit) {
    std::string text = heading + ",Strain,Nominal stress (MPa)\n";
    for (int i = 0; i <= 60; ++i) {
      const double t = i < 12 ? 0.5 * i : 6 + 4.0 * (i - 12);
      const double strain = std::min(0.2, t / 30);
      const double stress = nominal_stress(0.02, 1 + strain) * (1 + 0.3 * std::exp(-t / 40));
      text += fmt::format("{:.12g},{:.12g},{:.12g}\n", t / unit, strain, stress);
    }
    return text;
  };
  const std::string law = neo_hooke + ", viscous: [{tau: 30, gamma: 0.2}]";
  const std::string parameters =
      a1 + ", {key: \"viscous[0].tau\", lower: 0.001, upper: 10000}, {key: \"viscous[0].gamma\"}";
  const auto item = [](const std::string& file, const std::string& heading) {
    return "file: " + file + ", strain: engineering, columns: {time: \"" + heading +
           "\", strain_x: Strain, stress_x: Nominal stress (MPa)}";
  };
  write("seconds.csv", record("Time (s)", 1));
  const VecX seconds = fitted(config(item("seconds.csv", "Time (s)"), law, parameters));
  CHECK(seconds[1] > 10);
  for (const auto& [heading, unit] :
       {std::pair<std::string, double>{"Time (min)", 60}, {"Time [h]", 3600}, {"t_ms", 1e-3}}) {
    const auto shown = heading;
    CAPTURE(shown);
    write("other.csv", record(heading, unit));
    const VecX other = fitted(config(item("other.csv", heading), law, parameters));
    CHECK((other - seconds).norm() < 1e-4 * seconds.norm());
  }
}

TEST_CASE("a modulus is found from every measure that a heading names") {
  struct Heading {
    std::string strain, stress;
    double (*strain_of)(double);
    double (*stress_of)(double, double);  // of the stretch and the nominal stress [MPa]
  };
  const auto same = [](double l) {
    return l;
  };
  const auto kilo = [](double, double p) {
    return 1e3 * p;
  };
  const std::vector<Heading> headings{
      {"stretch", "First Piola-Kirchhoff stress (kPa)", same, kilo},
      {"lambda", "PK1 (kPa)", same, kilo},
      {"Eng. strain [%]", "Eng. stress [MPa]", [](double l) { return 100 * (l - 1); },
       [](double, double p) {
         return p;
       }},
      {"Green strain E11", "2nd PK stress S11 (kPa)", [](double l) { return (l * l - 1) / 2; },
       [](double l, double p) {
         return 1e3 * p / l;
       }},
      {"Logarithmic strain", "Cauchy stress (psi)", [](double l) { return std::log(l); },
       [](double l, double p) {
         return p * l * 25.4 * 25.4 / 4.4482216152605;
       }},
  };
  for (const Heading& heading : headings) {
    CAPTURE(heading.stress);
    std::string text = heading.strain + ";" + heading.stress + "\n";
    for (int i = 0; i <= 12; ++i) {
      const double stretch = 1 + 0.03 * i;
      text += fmt::format("{:.12g};{:.12g}\n", heading.strain_of(stretch),
                          heading.stress_of(stretch, nominal_stress(0.02, stretch)));
    }
    write("measure.csv", text);
    const std::string item = "file: measure.csv, columns: {strain_x: \"" + heading.strain +
                             "\", stress_x: \"" + heading.stress + "\"}";
    CHECK(std::abs(fitted(config(item, neo_hooke, a1))[0] - 0.02) < 1e-8);
  }
}

TEST_CASE("a modulus is found from compression that counts positive") {
  std::string mixed = "stretch,nominal_stress_kPa\n";
  std::string positive = "strain_percent,nominal_stress_kPa\n";
  std::string pushed = "Time, s\tPosition (z), mm\tFz, gf\n";
  for (int i = 0; i <= 10; ++i) {
    const double stretch = 1 - 0.025 * i;
    const double stress = -1e3 * nominal_stress(0.01, stretch);
    mixed += fmt::format("{:.12g},{:.12g}\n", stretch, stress);
    positive += fmt::format("{:.12g},{:.12g}\n", 100 * (1 - stretch), stress);
    // pulling counts negative: the same specimen pulled, 10 mm by 2 mm by 40 mm
    const double pull = 1 + 0.025 * i;
    pushed += fmt::format("{}\t{:.12g}\t{:.12g}\n", i, -40 * (pull - 1),
                          -20 * nominal_stress(0.01, pull) / 9.80665e-3);
  }
  write("mixed.csv", mixed);
  CHECK(holds(refusal(config("file: mixed.csv", neo_hooke, a1)), "stress_sign: -1"));
  for (const std::string key : {"sign: -1", "stress_sign: -1"}) {
    CHECK(std::abs(fitted(config("file: mixed.csv, " + key, neo_hooke, a1))[0] - 0.01) < 1e-9);
  }
  write("compression.csv", positive);
  CHECK(holds(refusal(config("file: compression.csv", neo_hooke, a1)), "sign: -1"));
  CHECK(std::abs(fitted(config("file: compression.csv, sign: -1", neo_hooke, a1))[0] - 0.01) <
        1e-9);
  write("pulled.txt", pushed);
  const std::string sized = "file: pulled.txt, width: 10, thickness: 2, gauge_length: 40, sign: -1";
  CHECK(std::abs(fitted(config(sized, neo_hooke, a1))[0] - 0.01) < 1e-9);
}

TEST_CASE(
    "five numbers of GOH are found from three protocols of mouse skin, none worse than of HGO") {
  std::string data = SOURCE_DIR "/../shared/data/murine_skin_biaxial.csv";
  if (!std::filesystem::exists(data))
    data = SOURCE_DIR "/../../shared/data/murine_skin_biaxial.csv";
  if (!std::filesystem::exists(data)) {
    MESSAGE("skipped: no ../shared/data/murine_skin_biaxial.csv");
    return;
  }
  const auto found = [&](const std::string& subject, const std::string& kappa) {
    FitConfig one = config(
        "file: \"" + std::filesystem::absolute(data).string() +
            "\", kind: biaxial, columns: {strain_x: stretch_x, strain_z: stretch_y, stress_x: "
            "cauchy_stress_x_MPa, stress_z: cauchy_stress_y_MPa}, strain: stretch, stress: cauchy, "
            "where: {subject: \"" +
            subject + "\", sample: \"1\"}, split: protocol",
        "matrix: {neo_hooke: {a1: 0.01}}, fibres: [{hgo: {c1: 0.1, c2: 1}, alpha: 20, kappa: " +
            kappa + "}], volume: {quadratic: {d: 1e-6}}",
        a1_and_fibres + (kappa == "0" ? "" : ", {key: \"fibres[0].kappa\"}"));
    one.noise_model = NoiseKind::white;
    return fit(fit_problem(one), {one.searches(), 1, {}});
  };
  const FitResult goh = found("111", "0.2");
  const FitResult hgo = found("111", "0");
  REQUIRE(goh.best.converged);
  REQUIRE(hgo.best.converged);
  CHECK(goh.quality.r2 > 0.9);
  CHECK(goh.best.cost < hgo.best.cost);
  CHECK(goh.best.p[4] > 0.2);
  CHECK(goh.best.p[4] < 1. / 3);
}

}  // namespace laboratory_fits_tests
