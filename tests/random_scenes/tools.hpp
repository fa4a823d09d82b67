// Indenters as STL files, to which drawn scenes refer.
#pragma once

#include <string>

namespace langer::test {

// Writes into `folder`: ellipsoid_<10 | 25 | 40>.stl, with half axes of 1, 0.6 and 0.8 mm, tilted
// about z by so many degrees; and frustum.stl, a square punch of 2 mm below and 4 mm above. The
// lowest point, or the middle of the lower face, is the origin.
void write_tools(const std::string& folder);

}  // namespace langer::test
