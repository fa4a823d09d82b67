// A finished run as an RO-Crate 1.1 (https://w3id.org/ro/crate/1.1), a standard for publishing
// research data with its provenance: the kind of each file, the command and the inputs that it was
// made from, and SHA-256 of every file. The run's folder becomes the crate:
//   ro-crate-metadata.json   the description, JSON-LD
//   inputs.d/upN/            copies of the files that configs name N folders above the run's
//   reproduce                makes all results again, in a new folder, from the files of the crate
//                            alone, and compares them
#pragma once

#include <string>
#include <vector>

namespace langer {

// The texts of a crate that no file of the run contains.
struct CrateWords {
  // By default the title is that of the pipeline; author and license are not stated.
  std::string title, author, license;
  // Folder of the project: files are copied from below it only. Empty: the current folder.
  std::string root = "";
};

// The size of a crate, for the message of langer crate.
struct CrateReport {
  std::size_t files = 0, actions = 0;
  std::vector<std::string> copied;  // places in the crate of files from outside of the folder
};

// A file is copied only if a config or a command of the run names it, a result records the same
// content of it, it is below the root and no link leads to it. Throws Failure(input) otherwise, and
// also if a step is not up to date, or if an input has changed since a result was made from it.
CrateReport write_crate(const std::string& folder, const CrateWords& words);

// Compares two folders of the same run: the content ids of all HDF5 files, and tables (CSV) byte by
// byte. Returns one line; throws Failure(input) with all differences.
std::string same_results(const std::string& folder, const std::string& other);

}  // namespace langer
