// `langer doctor`: which optional programs and libraries are installed on this machine, and what
// Langer cannot do without the others.
#pragma once

#include <string>
#include <vector>

namespace langer {

// One program or library.
struct Finding {
  std::string what;                    // "gnuplot"
  bool there = false, needed = false;  // needed: without it nothing runs
  // Version and place; or what does not work without it, and the command that installs it.
  std::string says;
};

// A needed program or library is missing.
inline bool is_serious(const Finding& f) { return f.needed && !f.there; }

std::vector<Finding> examine();  // runs `gnuplot --version` and similar commands
std::string doctor_text(const std::vector<Finding>& findings);

}  // namespace langer
