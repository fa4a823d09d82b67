// What is installed here of all that Langer can use, and what is missing without it.
#pragma once

#include <string>
#include <vector>

namespace langer {

struct Finding {
  std::string what;                    // "gnuplot"
  bool there = false, needed = false;  // needed: without it nothing runs
  std::string
      says;  // version and place, or what is missing without it and the command that installs it
};

std::vector<Finding> examine();  // starts `gnuplot --version` and the like
std::string doctor_text(const std::vector<Finding>& findings);

}  // namespace langer
