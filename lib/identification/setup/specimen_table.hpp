// The table of the specimens of a population, and the files that were measured of each.
//
// `specimens: {table: specimens.csv, data: "curves/{id}_{test}.csv"}` stands for a list `data` with
// an item for each file. It is written into the config before that is read, so that files,
// messages and hashes are those of any fit. An item knows its specimen by the key `specimen`.
// Refused at their line: a table of one specimen, an id twice, a specimen without a test, a file of
// nobody, a covariate that is the same for all.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/config/tree.hpp"
#include "identification/setup/comparison_config.hpp"

namespace langer {

struct SpecimenTable {
  std::vector<std::string> ids;                           // in the order of the rows
  std::map<std::string, std::vector<std::string>> texts;  // of each column, by row
  std::map<std::string, Place> heads;                     // of each column
  std::vector<Place> rows;
  std::vector<std::string> columns;  // in their order
};

// Throws Failure(input).
SpecimenTable read_specimen_table(const std::string& path, const std::string& id_column);

// A covariate as columns of numbers, one value for each specimen: the number less its mean, or for
// words one column for each word but the first, 1 where a specimen has it. Throws Failure(input)
// where it is the same for all, or has no value.
struct CovariateColumns {
  std::vector<std::string> names;  // age, site=ventral
  std::vector<std::vector<double>> values;
  double mean = 0;        // of numbers
  std::string reference;  // the word that the others are compared with
};
CovariateColumns covariate_columns(const SpecimenTable& table, const std::string& column,
                                   const Place& asked_at);

// Replaces the items of `data` of a config with `specimens` by one for each measured file. Items
// that stand there are patterns: their keys belong to the tests of their name, or to all. Nothing
// happens where the items have specimens already.
void expand_specimens(Tree& config);

}  // namespace langer
