// Where the side files of a main output belong.
//
// A fit writes material.h5 and with it parameters.csv, fit.csv and cards for other programs. A
// second fit in the same folder writes files of the same names. The first output keeps the plain
// names; the files of any further output yeoh.h5 go into a folder yeoh_files, so that no run
// replaces what belongs to another output.
#pragma once

#include <string>
#include <vector>

namespace langer {

// The chosen folder, and the reason for it.
struct SideFolder {
  std::string path;   // "" is the current folder
  std::string owner;  // the output that has the plain names; empty: this one has them
};

// The folder for the side files of `output`, made by `stage`. `names` are the side files that its
// config asks for. Throws Failure(input) before the computation begins, not after it: if the
// folder cannot be made, or if a name belongs to a link, a device or a file that this run reads.
SideFolder side_folder(const std::string& output, const std::string& stage,
                       const std::vector<std::string>& names);

}  // namespace langer
