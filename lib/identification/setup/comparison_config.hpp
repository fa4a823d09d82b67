// What a fit may ask beyond the numbers of one law: which law, which terms, how specimens differ.
//   laws: [yeoh, hgo_yeoh, goh]
//   discover: {terms: [I1, I1^2, I2, exp_fibre]}
//   specimens: {table: specimens.csv, data: "curves/{id}_{test}.csv"}
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"

namespace langer {

struct DiscoverConfig {
  std::vector<std::string> terms;
  int most = 4;
  static void fields(auto& v) {
    v(&DiscoverConfig::terms, "terms", unit::none,
      "terms of an energy that may be there, each with a modulus >= 0: I1, I1^2, I1^3, I2, I2^2, I2^3, fibre, exp_fibre, "
      "dispersed_fibre, power_fibre; none: all of them");
    v(&DiscoverConfig::most, "most", unit::none, "largest number of terms of a law",
      between(1, 10));
  }
  std::vector<Complaint> complaints() const;
};

enum class Scatter { full, diagonal };
constexpr auto names(Scatter) { return std::array{"full", "diagonal"}; }

struct SpecimenCovariate {
  std::string column;
  std::vector<std::string> on;
  static constexpr const char* short_key = "column";
  static void fields(auto& v) {
    v(&SpecimenCovariate::column, "column", unit::none,
      "of the table of specimens: numbers, such as an age, or words, such as a group", required);
    v(&SpecimenCovariate::on, "on", unit::none,
      "keys of the parameters that may depend on it; none: all that vary between specimens");
  }
};

struct SpecimensConfig {
  InputPath table;
  std::string data;
  std::string id = "id";
  std::map<std::string, std::string> where;
  std::string split;
  std::vector<SpecimenCovariate> covariates;
  Scatter scatter = Scatter::full;
  std::vector<std::string> shared;
  int people = 400;
  static void fields(auto& v) {
    v(&SpecimensConfig::table, "table", unit::none,
      "CSV with one row for each specimen: its id, covariates, and sizes where columns are called width, thickness, gauge_length, "
      "width_z, gauge_length_z or fibre_angle",
      required);
    v(&SpecimensConfig::data, "data", unit::none,
      "measured files: a path in which {id}, {test} and other columns of the table in braces stand for their texts; one file of "
      "all specimens with `where`",
      required);
    v(&SpecimensConfig::id, "id", unit::none,
      "column of the table that names the specimens; by default id, else the first column");
    v(&SpecimensConfig::where, "where", unit::none,
      "column of a measured file: text, such as {specimen: \"{id}\"}; rows with other texts belong to other specimens");
    v(&SpecimensConfig::split, "split", unit::none,
      "column of a measured file: one test for each text in it");
    v(&SpecimensConfig::covariates, "covariates", unit::none,
      "columns of the table on which the parameters may depend: their effects, and a test of each");
    v(&SpecimensConfig::scatter, "scatter", unit::none,
      "between specimens: full has correlations of all parameters, diagonal has none");
    v(&SpecimensConfig::shared, "shared", unit::none,
      "keys of parameters that are the same in all specimens");
    v(&SpecimensConfig::people, "people", unit::none,
      "specimens drawn for the bands of a new one; 0: none", between(0, 100000));
  }
  std::vector<Complaint> complaints() const;
};

}  // namespace langer
