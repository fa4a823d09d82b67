// Starter projects (`langer new`): a pipeline and its configs with comments, a Makefile and, for
// editors, the schemas. The files of share/new are compiled into the program, so that it has them
// wherever it is installed.
#pragma once

#include <string>
#include <vector>

namespace langer {

std::vector<std::string> starter_names();  // "indentation", ...

// Writes a project into a folder that is new or empty; throws Failure otherwise. Returns the names
// of the files.
std::vector<std::string> write_starter(const std::string& scene, const std::string& folder);

}  // namespace langer
