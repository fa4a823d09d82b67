// Changes one value in the text of a YAML file and leaves everything else as it is: comments,
// order, spaces, the way other numbers are written.
//
//   set     edit_yaml(text, "contacts.sphere.rigid.sphere.radius", "3")
//           edit_yaml(text, "loads[0].rotation", "{angle: 20}")       a whole part, in one line
//           a key or list item that is not there is added behind its siblings
//   remove  edit_yaml(text, "contacts.sphere.friction", {})
//
// The place of a value comes from the parser (line and column of each part). The new text is
// parsed again: if anything but the value has changed, the edit is refused, and the file stays.
#pragma once

#include <optional>
#include <string>

namespace langer {

// `value`: YAML in one line; none: the part is removed. Throws Failure(config), in words for the
// person who edits.
std::string edit_yaml(const std::string& text, const std::string& file, const std::string& path,
                      const std::optional<std::string>& value);

}  // namespace langer
