// Starter projects: a pipeline and its configs with comments, a Makefile and, for editors, the
// schemas. The files are those of share/new, kept in the program so that it finds them wherever it
// is installed.
#pragma once

#include <string>
#include <vector>

namespace langer {

std::vector<std::string> starter_names();  // "indentation", ...

// Writes into a folder that is new or empty; throws Failure otherwise. Returns the names of the
// files.
std::vector<std::string> write_starter(const std::string& scene, const std::string& folder);

}  // namespace langer
