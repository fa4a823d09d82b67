// A finished run as an RO-Crate 1.1 (https://w3id.org/ro/crate/1.1): what each file is, by which
// command of which program it was made from what, with SHA-256 of every file. The run's folder
// becomes the crate:
//   ro-crate-metadata.json   the description, JSON-LD
//   inputs.d/upN/            copies of the files that configs name outside of the folder, N folders above it
//   reproduce                makes all results again, in a new folder, from what lies in the crate alone, and compares
#pragma once

#include <string>
#include <vector>

namespace langer {

struct CrateWords {
  // empty: from the pipeline; nobody; left to whoever publishes it
  std::string title, author, license;
  // Folder of the project: files are copied from below it only. Empty: the current folder.
  std::string root = "";
};

struct CrateReport {
  std::size_t files = 0, actions = 0;
  std::vector<std::string> copied;  // places in the crate of files from outside of the folder
};

// A file is copied only if a config or a command of the run names it, a result records the same
// content of it, it lies below the root and no link leads to it. Throws Failure(input) otherwise,
// and where a step is not up to date, or an input is no longer what a result was made from
CrateReport write_crate(const std::string& folder, const CrateWords& words);

// One line; throws Failure(input) with what differs: content ids of all HDF5 files, and tables
// (CSV) byte by byte
std::string same_results(const std::string& folder, const std::string& other);

}  // namespace langer
