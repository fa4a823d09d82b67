// Sizes of a specimen that stand in the name of its file.
//
// Many laboratories write them there: S3_w10.5_t2.1_L40.csv. A pattern says where:
//   *_w{width}_t{thickness}_L{gauge_length}
// The whole name without its ending has to match. `*` is any text; what stands in braces is a
// number, with a point or the letter p for its decimals (10p5).
#pragma once

#include <map>
#include <string>

namespace langer {

// What is wrong with a pattern; empty: nothing.
std::string mistake_in_pattern(const std::string& pattern);

// The numbers of a file's name by their keys. Throws Failure(input) where the name does not match.
std::map<std::string, double> sizes_in_file_name(const std::string& path,
                                                 const std::string& pattern);

}  // namespace langer
