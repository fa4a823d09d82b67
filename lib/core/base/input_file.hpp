// Reads an input file as a whole: a mesh, a surface, a table.
// Only a regular file is opened. A pipe without a writer would wait for ever, a device may have no
// end or act when it is opened, so both are refused before a byte is read, like a folder. A file
// that does not fit into the free memory is refused as well.
#pragma once

#include <string>

namespace langer {

// Why this path is no regular file that can be read: "there is no such file". Empty if it is one.
std::string unreadable_reason(const std::string& path);

// All bytes of the file. Throws Failure(input) with the reason above; `expected` completes the
// message: "a CSV file with a measured test".
std::string read_file(const std::string& path, const std::string& expected = "");

}  // namespace langer
