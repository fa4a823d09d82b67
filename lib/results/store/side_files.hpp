// Where the files beside a main output belong.
//
// A fit writes material.h5 and, beside it, parameters.csv, fit.csv and cards for other programs. A
// second fit in the same folder writes files of the same names. The first output keeps the plain
// names; the files of any further output yeoh.h5 go into a folder yeoh_files, so that no run
// replaces what belongs to another output.
#pragma once

#include <string>
#include <vector>

namespace langer {

struct SideFolder {
  std::string path;   // "" is the current folder
  std::string owner;  // the output that has the plain names; empty: this one has them
};

// The folder for the side files of `output`, made by `stage`; `names` are those that its config
// asks for. Throws Failure(input) where the folder cannot be made, or where a name belongs to a
// link, a device or a file that this run reads: before the work begins, not after it.
SideFolder side_folder(const std::string& output, const std::string& stage,
                       const std::vector<std::string>& names);

}  // namespace langer
